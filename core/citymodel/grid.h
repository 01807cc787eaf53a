#pragma once

#include <optional>
#include <variant>

#include "core/citymodel/building.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"

namespace citymesh {

/// The nearest point of the grid; none beyond its limits, and for what is no number.
std::optional<GridPoint> to_grid(const Point3& p);

/// A geometry on the grid, equal points as one, rings without the repeated last corner; otherwise
/// as it came. A face knows whether it is an opening through its type. Errors are issues: 901
/// empty, C105 out of range.
struct Gridded {
  Shell shell{};
  double max_displacement_m = 0;  ///< by rounding
};
std::variant<Gridded, Issue> grid(const Building& building, const Geometry& geometry);

}  // namespace citymesh
