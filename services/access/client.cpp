#include "services/access/client.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace citymesh {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, 4> kRoles{{
    {Role::ReadOwn, "read-own"},
    {Role::Submit, "submit"},
    {Role::WriteBack, "write-back"},
    {Role::Admin, "admin"},
}};

}  // namespace

std::string_view to_string(Role role) {
  for (const auto& [known, name] : kRoles)
    if (known == role) return name;
  return "none";
}

std::optional<Role> role_from(std::string_view name) {
  for (const auto& [role, known] : kRoles)
    if (known == name) return role;
  return std::nullopt;
}

bool may_see(const Client& client, std::string_view owner) {
  if (client.role == Role::Admin) return true;
  return client.role >= Role::ReadOwn && !client.name.empty() && client.name == owner;
}

Result<void> require(const Client& client, Role needed) {
  if (client.role >= needed) return {};
  return fail(ErrorCode::PermissionDenied, fmt::format("the role of this client is {}, expected {}",
                                                       to_string(client.role), to_string(needed)));
}

}  // namespace citymesh
