#pragma once

#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// An area on the grid: rings are not closed by a repeated corner; the exterior runs
/// counter-clockwise, holes clockwise.
struct Area {
  std::vector<GridPoint2> exterior{};
  std::vector<std::vector<GridPoint2>> holes{};
};

/// Twice the area in steps², exact.
Int128 area2(const Area& area);

// Overlay on the grid: all crossings are snap-rounded to grid points, results are valid areas with
// disjoint interiors that may touch in single points, in lexicographic order. Inputs may overlap,
// but each must be simple; degenerate ones are ignored. Errors: Internal when the overlay itself
// gives up.

/// Union of any number of areas.
Result<std::vector<Area>> unite(std::span<const Area> areas);

/// What of the union of `minuend` is not in the union of `subtrahend`.
Result<std::vector<Area>> subtract(std::span<const Area> minuend, std::span<const Area> subtrahend);

/// Fewer corners, none moved or left out by more than `tolerance_m`; topology is kept.
Result<std::vector<Area>> simplify(std::span<const Area> areas, double tolerance_m);

/// Closes gaps and takes off slivers narrower than twice `width_m` (closing, then opening, mitred
/// corners). Corners may move by about the width.
Result<std::vector<Area>> smooth(std::span<const Area> areas, double width_m);

/// The smallest convex area that holds all points (Andrew 1979); empty exterior when they lie on a
/// line.
Area convex_hull(std::vector<GridPoint2> points);

}  // namespace citymesh
