#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

using Corners = std::array<GridPoint, 3>;

/// Cuts a triangle along its intersections with others, exactly, and rounds the pieces to the grid:
/// they cover it, have its orientation, and may be degenerate. Every triangle that shares the
/// crossing gets the same points. Neither `facet` nor any of `others` may be degenerate.
std::vector<Corners> cut_triangle(const Corners& facet, std::span<const Corners> others);

}  // namespace citymesh
