#include "core/geometry/outline.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/geometry/predicates.h"
#include "core/geometry/triangulation.h"

namespace citymesh {

std::vector<std::vector<std::uint32_t>> outline_of(std::span<const Triangle> triangles) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> walked;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) walked.emplace(t[i], t[(i + 1) % 3]);
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [from, to] : walked) {
    if (walked.contains({to, from})) continue;
    if (!next.emplace(from, to).second) return {};
  }
  std::vector<std::vector<std::uint32_t>> loops;
  while (!next.empty()) {
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      next.erase(at);
    }
  }
  return loops;
}

std::vector<std::vector<std::uint32_t>> polygon_of(std::span<const GridPoint> points,
                                                   std::span<const Triangle> triangles) {
  Point3 normal;
  for (const Triangle& t : triangles) {
    const Point3 n = normal_of(points[t[0]], points[t[1]], points[t[2]]);
    normal = {normal.x + n.x, normal.y + n.y, normal.z + n.z};
  }
  std::vector<std::vector<std::uint32_t>> loops = outline_of(triangles);
  const auto turns_along = [&](const std::vector<std::uint32_t>& loop) {
    const Point3 n = ring_normal(points, loop);
    return n.x * normal.x + n.y * normal.y + n.z * normal.z > 0;
  };
  if (std::count_if(loops.begin(), loops.end(), turns_along) != 1) return {};
  std::iter_swap(loops.begin(), std::find_if(loops.begin(), loops.end(), turns_along));
  return loops;
}

}  // namespace citymesh
