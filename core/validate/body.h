#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// A closed surface without defects of its own, its triangles facing outwards.
struct ClosedSurface {
  std::vector<GridPoint> points{};
  std::vector<Triangle> triangles{};
  GridBox box{};
};

/// A solid whose shells are sound: what can be compared with other solids.
struct SolidBody {
  std::string name{};  ///< "solid 2" or the id of what it belongs to
  ClosedSurface exterior{};
  std::vector<ClosedSurface> cavities{};  ///< facing outwards too
};

/// How the inside of one solid lies to that of another. Exact; "maybe" is for those that touch in a
/// way that only volumes with exact coordinates can tell.
enum class Answer { No, Yes, Maybe };

/// Whether the interiors have points in common, cavities not regarded.
Answer interiors_overlap(const ClosedSurface& a, const ClosedSurface& b);

/// Whether the inside of `inner` lies within `outer`, where they may touch.
Answer lies_within(const ClosedSurface& inner, const ClosedSurface& outer);

/// Whether they have points in common, on the surface or inside.
bool touch_or_overlap(const ClosedSurface& a, const ClosedSurface& b);

/// Whether their surfaces have points in common.
bool surfaces_touch(const ClosedSurface& a, const ClosedSurface& b);

/// Whether faces of the two lie on each other.
bool share_area(const ClosedSurface& a, const ClosedSurface& b);

/// A place near which both are.
Point3 common_place(const ClosedSurface& a, const ClosedSurface& b);

}  // namespace citymesh
