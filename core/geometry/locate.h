#pragma once

#include <span>

#include "core/geometry/box_tree.h"
#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

enum class Side : signed char { Outside = -1, On = 0, Inside = 1 };

/// Tells where places lie relative to a closed set of triangles, by parity of crossings; exact. No
/// triangle may be degenerate. Keeps what it is given by reference.
class Locator {
 public:
  Locator(std::span<const GridPoint> points, std::span<const Triangle> triangles);

  /// Coordinates of `place` count 1/`parts` of a step, up to thirds, so that middles of edges and
  /// centres of triangles are exact too.
  Side locate(const GridPoint& place, std::int64_t parts = 1) const;

 private:
  std::span<const GridPoint> points_;
  std::span<const Triangle> triangles_;
  GridBox box_{};
  BoxTree tree_;
};

/// The same in the plane, for the corners of a simple ring that may run either way.
Side locate(std::span<const GridPoint2> ring, const GridPoint2& place, std::int64_t parts = 1);

}  // namespace citymesh
