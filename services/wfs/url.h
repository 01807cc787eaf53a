#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace citymesh::wfs {

using Parameters = std::vector<std::pair<std::string, std::string>>;

/// The address of a WFS without the parameters of a request that it may have been copied with
/// (SERVICE, VERSION, REQUEST); others stay. Errors: InvalidArgument for what is not http or https.
Result<std::string> service_url(const std::string& url);

/// Scheme, host, port and path.
std::string shown_url(const std::string& url);

std::string with_parameters(const std::string& url, const Parameters& parameters);

/// The address of the next page, with the user of `url`; none when it leads to another scheme, host
/// or port.
std::optional<std::string> next_page(const std::string& url, const std::string& link);

}  // namespace citymesh::wfs
