#include <fmt/format.h>

#include "services/apps/commands.h"
#include "services/rest/openapi.h"

namespace citymesh {

int openapi_command(const std::string& server_url) {
  fmt::print("{}", openapi_json(server_url));
  return kDone;
}

}  // namespace citymesh
