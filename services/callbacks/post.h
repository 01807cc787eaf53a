#pragma once

#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

struct Message {
  std::string uri{};
  std::string body{};  ///< JSON
  std::vector<std::pair<std::string, std::string>> headers{};
};

struct PostOptions {
  bool allow_private = false;  ///< also addresses that are not public
  double timeout_s = 10;       ///< for all of it
};

/// Sends a message by HTTP POST and returns the status of the answer, whose body is not kept.
/// Redirects are not followed and proxies not used; certificates are verified; the address that a
/// name stands for is judged at the moment when it is connected to, so that it cannot change in
/// between. Errors: Unavailable with the reason, PermissionDenied for an address that is not
/// public, Cancelled when stopped.
Result<int> post(const Message& message, const PostOptions& options, const std::stop_token& stop);

}  // namespace citymesh
