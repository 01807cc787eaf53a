#pragma once

#include <string>

#include "services/rest/message.h"

namespace citymesh {

/// 204 and 304 never have a body.
bool may_have_body(int status);

/// Status line and header of an answer, up to and with the empty line. Without `Content-Length`
/// where there is no body or its end is that of the connection.
std::string head_text(const Response& response, bool keep_alive);

}  // namespace citymesh
