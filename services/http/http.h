#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// What the service asks of another one.
struct HttpRequest {
  std::string url{};                ///< http or https
  std::optional<std::string> body;  ///< POST; without one GET
  std::vector<std::pair<std::string, std::string>> headers{};
  double timeout_s = 10;  ///< for all of it
  std::size_t max_answer_bytes = 64 * 1024;
  /// Judges an address at the moment when it is connected to, so that what a name stands for cannot
  /// change in between. Empty: any will do, and a proxy that the environment names is used.
  std::function<bool(const std::string& address)> may_connect{};
};

struct HttpAnswer {
  int status = 0;
  std::string body{};
  bool is_whole = true;  ///< false: the body goes on beyond `max_answer_bytes`
};

/// Sends a request and returns the answer, whatever its status. Redirects are not followed,
/// certificates are verified. Errors: Unavailable with the reason, DeadlineExceeded after
/// `timeout_s`, PermissionDenied for an address that may not be connected to, Cancelled when
/// stopped.
Result<HttpAnswer> ask(const HttpRequest& request, const std::stop_token& stop = {});

}  // namespace citymesh
