#include "services/callbacks/post.h"

#include <fmt/format.h>

#include "services/callbacks/address_guard.h"
#include "services/http/http.h"

namespace citymesh {

Result<int> post(const Message& message, const PostOptions& options, const std::stop_token& stop) {
  if (auto checked = check_callback_uri(message.uri, options.allow_private); !checked)
    return checked.error();
  HttpRequest request{.url = message.uri,
                      .body = message.body,
                      .headers = {{"Content-Type", "application/json"}},
                      .timeout_s = options.timeout_s,
                      .may_connect = [&options](const std::string& address) {
                        return options.allow_private || is_public_text(address).value_or(false);
                      }};
  request.headers.insert(request.headers.end(), message.headers.begin(), message.headers.end());
  // What the answer says does not matter: one that is too long has been received all the same.
  const auto answer = ask(request, stop);
  if (answer) return answer->status;
  if (answer.error().code == ErrorCode::PermissionDenied)
    return fail(ErrorCode::PermissionDenied,
                fmt::format("{} is no public address", shown_uri(message.uri)));
  return answer.error();
}

}  // namespace citymesh
