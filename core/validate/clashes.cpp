#include "core/validate/clashes.h"

#include <algorithm>
#include <map>

#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"

namespace citymesh {
namespace {

/// Distances of two ends of a segment to a plane are of different sign: where it goes through.
Point3 pierced(const GridPoint& a, const GridPoint& b, double da, double db) {
  const Point3 p = to_metres(a), q = to_metres(b);
  const double t = da / (da - db);
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
}

}  // namespace

Point3 meeting_place(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t) {
  const auto box = [](const std::array<GridPoint, 3>& triangle) {
    GridBox all = GridBox::of(triangle[0]);
    all.add(triangle[1]);
    all.add(triangle[2]);
    return all;
  };
  const GridBox a = box(s), b = box(t);
  const Point3 low = to_metres(
      {std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y), std::max(a.min.z, b.min.z)});
  const Point3 high = to_metres(
      {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y), std::min(a.max.z, b.max.z)});
  // Middle of the places where edges go through the other triangle's plane in the common box.
  Point3 sum{};
  double count = 0;
  const auto add = [&](const std::array<GridPoint, 3>& edges, const std::array<GridPoint, 3>& of) {
    for (std::size_t i = 0; i < 3; ++i) {
      const GridPoint &p = edges[i], &q = edges[(i + 1) % 3];
      const auto dp = static_cast<double>(volume6(of[0], of[1], of[2], p)),
                 dq = static_cast<double>(volume6(of[0], of[1], of[2], q));
      if ((dp > 0) == (dq > 0) || dp == dq) continue;
      const Point3 at = pierced(p, q, dp, dq);
      if (at.x < low.x || at.x > high.x || at.y < low.y || at.y > high.y || at.z < low.z ||
          at.z > high.z)
        continue;
      sum = {sum.x + at.x, sum.y + at.y, sum.z + at.z};
      ++count;
    }
  };
  add(s, t);
  add(t, s);
  if (count > 0) return {sum.x / count, sum.y / count, sum.z / count};
  return {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
}

std::vector<Clash> find_clashes(const Boundary& boundary) {
  const auto corners = [&](std::uint32_t i) {
    const Triangle& t = boundary.triangles[i];
    return std::array<GridPoint, 3>{boundary.points[t[0]], boundary.points[t[1]],
                                    boundary.points[t[2]]};
  };
  const std::vector<GridBox> boxes = boxes_of(boundary.points, boundary.triangles);
  const BoxTree tree(boxes);

  std::map<std::pair<std::uint32_t, std::uint32_t>, Point3> found;
  std::uint64_t tests = 0;
  for (std::uint32_t i = 0; i < boxes.size() && tests < kMaxClashTests; ++i)
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      ++tests;
      if (j <= i || !triangles_clash(corners(i), corners(j))) return;
      const auto key = std::minmax(boundary.polygon_of[i], boundary.polygon_of[j]);
      if (!found.contains(key)) found.emplace(key, meeting_place(corners(i), corners(j)));
    });
  std::vector<Clash> clashes;
  clashes.reserve(found.size());
  for (const auto& [pair, at] : found) clashes.push_back({pair.first, pair.second, at});
  return clashes;
}

}  // namespace citymesh
