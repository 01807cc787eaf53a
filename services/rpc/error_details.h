#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// What a failed call says beside code and message, as bytes of google.rpc.Status: see
/// proto/citymesh/v1/error_details.proto. `code` is gRPC's number.
std::string error_details(int code, std::string_view reason, const std::string& message,
                          bool passes_by_itself);

}  // namespace citymesh
