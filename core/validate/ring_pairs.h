#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/predicates.h"

namespace citymesh {

using FlatRing = std::vector<GridPoint2>;

enum class RingDefect { Intersect, Same, Outside, Nested, Disconnected };

/// What is wrong with the rings of a polygon together, and which ones it is about.
struct RingPair {
  RingDefect defect{};
  std::size_t ring = 0, other = 0;
  GridPoint2 place{};  ///< on or near the defect
};

/// The first defect of a polygon whose rings are simple; the first ring is the exterior. Exact:
/// rings may touch in points as long as the interior stays in one piece (OGC Simple Features).
/// Looked for in this order: crossing or equal rings, holes outside, nested holes, pieces.
std::optional<RingPair> find_ring_defect(std::span<const FlatRing> rings);

}  // namespace citymesh
