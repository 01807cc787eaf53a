#pragma once

#include <string>

#include "core/geometry/point.h"

namespace citymesh {

/// "(x y z)" in metres from the origin, four decimals: how people are told where something is.
std::string place_text(const GridPoint& p);

}  // namespace citymesh
