#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

/// HMAC-SHA256 in hexadecimal digits.
std::string hmac_sha256(std::string_view secret, std::string_view text);

/// The value of the header Citymesh-Signature: `t=SECONDS,v1=HMAC` over `SECONDS.BODY`, so that
/// neither the body nor the time of a message can be changed, nor an old one be sent again later.
std::string signature(std::string_view secret, std::int64_t unix_seconds, std::string_view body);

/// The secret in a file, without the line end. Errors: Unavailable when it cannot be read,
/// InvalidArgument when it is too short to be one.
Result<std::string> read_secret(const std::string& file);

}  // namespace citymesh
