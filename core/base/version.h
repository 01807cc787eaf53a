#pragma once

#include <string_view>

namespace citymesh {

/// The version that reports and the API state, from CMake's project version.
std::string_view version();

}  // namespace citymesh
