#include <fmt/format.h>

#include <cstdio>

#include "services/access/api_keys.h"
#include "services/apps/commands.h"

namespace citymesh {

int make_key_command(const std::string& name, const std::string& role) {
  const auto known = role_from(role);
  if (!known)
    return could_not_run(
        fail(ErrorCode::InvalidArgument,
             fmt::format("role is '{}', expected read-own, submit, write-back or admin", role)));
  const auto made = make_api_key(name, *known);
  if (!made) return could_not_run(made.error());
  fmt::print(stderr, "The key, shown only now:\n  {}\n", made->key);
  fmt::print("{}\n", made->line);
  return kDone;
}

}  // namespace citymesh
