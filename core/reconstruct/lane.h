#pragma once

#include <string>

#include "core/citymodel/shell.h"

namespace citymesh {

/// "2.5d": seen from above, no two upward faces overlap. Else "3d".
std::string lane_of(const Shell& shell);

}  // namespace citymesh
