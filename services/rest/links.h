#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// Link relations of OGC API - Processes.
namespace rel {
inline constexpr std::string_view kConformance =
    "http://www.opengis.net/def/rel/ogc/1.0/conformance";
inline constexpr std::string_view kProcesses = "http://www.opengis.net/def/rel/ogc/1.0/processes";
inline constexpr std::string_view kJobList = "http://www.opengis.net/def/rel/ogc/1.0/job-list";
inline constexpr std::string_view kExecute = "http://www.opengis.net/def/rel/ogc/1.0/execute";
inline constexpr std::string_view kResults = "http://www.opengis.net/def/rel/ogc/1.0/results";
inline constexpr std::string_view kExceptions = "http://www.opengis.net/def/rel/ogc/1.0/exceptions";
}  // namespace rel

inline constexpr std::string_view kOpenApiMediaType =
    "application/vnd.oai.openapi+json;version=3.0";

/// A link object; `Json` is the JSON type of the caller.
template <class Json>
Json link_json(std::string_view href, std::string_view relation, std::string_view type,
               std::string_view title) {
  return {{"href", href}, {"rel", relation}, {"type", type}, {"title", title}};
}

/// Text for the wire; invalid UTF-8 is replaced, never an exception.
template <class Json>
std::string dump(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace citymesh
