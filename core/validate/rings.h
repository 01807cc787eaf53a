#pragma once

#include <optional>
#include <span>

#include "core/geometry/box_tree.h"
#include "core/geometry/point.h"
#include "core/geometry/predicates.h"
#include "core/validate/boundary.h"
#include "core/validate/findings.h"

namespace citymesh {

/// Checks 103, 101 and 102; false: the polygon has a defect and is not to be looked at further.
bool check_corners(const Boundary& boundary, const TestedPolygon& polygon, Findings& findings);

/// The box of an edge in the plane; z is 0.
GridBox box_of(const GridPoint2& a, const GridPoint2& b);

/// Two edges of a ring that have a point in common that they should not have.
struct RingCrossing {
  std::uint32_t edge = 0, other = 0;  ///< numbers of their first corners
};

/// The first crossing, touch or fold of a ring with itself (104); exact. The ring has three corners
/// at least and no two the same in a row.
std::optional<RingCrossing> find_crossing(std::span<const GridPoint2> ring);

}  // namespace citymesh
