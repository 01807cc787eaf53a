#pragma once

#include <string_view>

#include "services/rest/message.h"

namespace citymesh {

/// What the request's conditions make of the whole answer (RFC 9110, 13 and 14): 304 when the
/// client has it, 412 when it has another one, 206 with the range asked for, 416 when that lies
/// outside. Anything but a single file with an ETag is returned as it is. A list of ranges and
/// what is no range are ignored, as the standard allows.
Response conditional(const Request& request, Response whole, std::string_view accept);

}  // namespace citymesh
