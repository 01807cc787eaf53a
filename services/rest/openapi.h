#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// The OpenAPI 3.0 description of the service, generated from the process and option tables.
/// `server_url` is the address that clients use. Where these have to show who they are, `is_open`
/// knows the operations that do without.
std::string openapi_json(std::string_view server_url,
                         bool (*is_open)(std::string_view method, std::string_view path) = nullptr);

}  // namespace citymesh
