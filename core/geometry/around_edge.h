#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

/// A triangle at an edge.
struct EdgeFacet {
  std::uint32_t facet = 0;
  std::uint32_t apex = 0;  ///< the corner that is not of the edge
  bool forward = true;     ///< the facet walks the edge from the lower to the higher vertex
};

/// Triangles by edge (vertices, lower first).
using EdgeFans = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<EdgeFacet>>;

EdgeFans edge_fans(std::span<const Triangle> triangles);

/// Sorts the triangles at edge a→b counter-clockwise, seen against its direction, beginning with
/// the first; exact. No two of them may overlap. Counter-clockwise of a triangle that walks the
/// edge forward lies its front.
void sort_around(std::span<const GridPoint> points, std::uint32_t a, std::uint32_t b,
                 std::vector<EdgeFacet>& fan);

}  // namespace citymesh
