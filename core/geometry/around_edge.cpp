#include "core/geometry/around_edge.h"

#include <algorithm>

#include "core/geometry/predicates.h"

namespace citymesh {

EdgeFans edge_fans(std::span<const Triangle> triangles) {
  EdgeFans fans;
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangles[f][i], b = triangles[f][(i + 1) % 3];
      fans[{std::min(a, b), std::max(a, b)}].push_back({f, triangles[f][(i + 2) % 3], a < b});
    }
  return fans;
}

void sort_around(std::span<const GridPoint> points, std::uint32_t a, std::uint32_t b,
                 std::vector<EdgeFacet>& fan) {
  if (fan.size() < 3) return;
  const auto turn = [&](std::uint32_t c, std::uint32_t d) {
    return orient3d(points[a], points[b], points[c], points[d]);
  };
  const std::uint32_t start = fan[0].apex;
  const auto half = [&](std::uint32_t apex) { return turn(start, apex) > 0 ? 0 : 1; };
  std::sort(fan.begin() + 1, fan.end(), [&](const EdgeFacet& s, const EdgeFacet& t) {
    const int hs = half(s.apex), ht = half(t.apex);
    return hs != ht ? hs < ht : turn(s.apex, t.apex) > 0;
  });
}

}  // namespace citymesh
