#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// The id of the trace that a request belongs to, 32 hexadecimal digits: what its header
/// `traceparent` says (W3C Trace Context), or without a valid one a new random id.
std::string trace_id_of(std::string_view traceparent);

}  // namespace citymesh
