#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/measure.h"
#include "core/geometry/point.h"

namespace citymesh {

struct PushedOut {
  std::vector<GridPoint> points{};
  double displacement_m = 0;  ///< of the corner that moved most
  GridPoint at{};             ///< where that corner was
};

/// Moves those corners of a closed body whose edges run inside another one onto the outside of its
/// faces: what two walls that are meant to be one have in common, by measuring errors, is a sliver,
/// too thin to be cut off. Faces beside a moved corner tilt by as much. The corners end `clearance`
/// steps in front of the faces, 2 or more, for they are rounded. None: an edge runs deeper than
/// `reach_m`, or nothing had to move; then the other one may have edges in this one. No triangle of
/// the other may be degenerate, and they face outwards.
std::optional<PushedOut> push_out(const TriangleView& body, const TriangleView& other,
                                  double reach_m, double clearance);

}  // namespace citymesh
