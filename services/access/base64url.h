#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace citymesh {

// RFC 4648, section 5, without padding, as JSON Web Tokens have it.

std::string encode_base64url(std::string_view bytes);
/// Nothing for what no encoder writes: other characters, padding, or bits left over.
std::optional<std::string> decode_base64url(std::string_view text);

}  // namespace citymesh
