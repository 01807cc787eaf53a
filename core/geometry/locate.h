#pragma once

#include <span>

#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

enum class Side : signed char { Outside = -1, On = 0, Inside = 1 };

/// Where a place lies relative to a closed set of triangles, by parity of crossings; exact.
/// Coordinates of `place` count 1/`parts` of a step, up to thirds, so that middles of edges and
/// centres of triangles are exact too. No triangle may be degenerate.
Side locate(std::span<const GridPoint> points, std::span<const Triangle> triangles,
            const GridPoint& place, std::int64_t parts = 1);

/// The same in the plane, for the corners of a ring that may run either way.
Side locate(std::span<const GridPoint2> ring, const GridPoint2& place, std::int64_t parts = 1);

}  // namespace citymesh
