#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// The OpenAPI 3.0 description of the service, generated from the process and option tables.
/// `server_url` is the address that clients use.
std::string openapi_json(std::string_view server_url);

}  // namespace citymesh
