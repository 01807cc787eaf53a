#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

/// What a client may do; each role may do what those before it may.
enum class Role {
  None,       ///< ask what the service is
  ReadOwn,    ///< see its own jobs, their results and the metrics
  Submit,     ///< submit jobs and dismiss its own
  WriteBack,  ///< submit jobs that also write their results to the database
  Admin,      ///< see and dismiss the jobs of all
};

std::string_view to_string(Role role);
/// `read-own`, `submit`, `write-back` and `admin`.
std::optional<Role> role_from(std::string_view name);

/// Who sent a request.
struct Client {
  std::string name{};  ///< the owner of its jobs; empty: nobody in particular
  Role role = Role::None;
};

/// Whether a client may know that a job of that owner exists.
bool may_see(const Client& client, std::string_view owner);

/// Errors: PermissionDenied naming the role that is needed.
Result<void> require(const Client& client, Role needed);

}  // namespace citymesh
