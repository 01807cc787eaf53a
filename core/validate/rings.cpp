#include "core/validate/rings.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/geometry/measure.h"
#include "core/geometry/place.h"

namespace citymesh {
namespace {

std::string ring_label(const Boundary& boundary, const TestedPolygon& polygon, std::size_t ring) {
  if (polygon.rings.size() == 1) return boundary.label(polygon);
  return fmt::format("{} ring {}", boundary.label(polygon), ring);
}

/// Whether edge b→c turns back onto edge a→b.
bool folds_back(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c) {
  if (orient2d(a, b, c) != 0) return false;
  return Int128{a.x - b.x} * (c.x - b.x) + Int128{a.y - b.y} * (c.y - b.y) > 0;
}

/// Whether edges i < j of a ring are no neighbours that only share their corner.
bool edges_clash(std::span<const GridPoint2> ring, std::size_t i, std::size_t j) {
  const std::size_t n = ring.size();
  if (j == i + 1) return folds_back(ring[i], ring[j], ring[(j + 1) % n]);
  if (i == 0 && j == n - 1) return folds_back(ring[j], ring[0], ring[1]);
  return segments_meet(ring[i], ring[i + 1], ring[j], ring[(j + 1) % n]);
}

}  // namespace

GridBox box_of(const GridPoint2& a, const GridPoint2& b) {
  GridBox box = GridBox::of({a.x, a.y, 0});
  box.add(GridPoint{b.x, b.y, 0});
  return box;
}

bool check_corners(const Boundary& boundary, const TestedPolygon& polygon, Findings& findings) {
  const auto report = [&](int code, std::size_t r, std::size_t corner, double measured) {
    const Ring& ring = polygon.rings[r];
    std::optional<Point3> at;
    if (!ring.empty()) at = to_metres(boundary.points[ring[corner]]);
    findings.add(
        code,
        [&] {
          std::string where = ring_label(boundary, polygon, r);
          if (!ring.empty()) where += " " + place_text(boundary.points[ring[corner]]);
          return where;
        },
        measured, at);
    return false;
  };
  if (polygon.open_ring >= 0) {
    const auto r = static_cast<std::size_t>(polygon.open_ring);
    const Ring& ring = polygon.rings[r];
    const double gap_m =
        ring.empty() ? 0 : distance_m(boundary.points[ring.front()], boundary.points[ring.back()]);
    return report(103, r, ring.empty() ? 0 : ring.size() - 1, gap_m);
  }
  if (polygon.rings.empty()) {
    findings.add(101, [&] { return boundary.label(polygon); }, 0, {});
    return false;
  }
  for (std::size_t r = 0; r < polygon.rings.size(); ++r)
    if (polygon.rings[r].size() < 3)
      return report(101, r, 0, static_cast<double>(polygon.rings[r].size()));
  for (std::size_t r = 0; r < polygon.rings.size(); ++r) {
    const Ring& ring = polygon.rings[r];
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (ring[i] == ring[(i + 1) % ring.size()]) return report(102, r, i, 0);
  }
  return true;
}

std::optional<RingCrossing> find_crossing(std::span<const GridPoint2> ring) {
  const std::size_t n = ring.size();
  constexpr std::size_t kFew = 24;  // a tree does not pay
  if (n <= kFew) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (edges_clash(ring, i, j))
          return RingCrossing{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
    return {};
  }
  std::vector<GridBox> boxes;
  boxes.reserve(n);
  for (std::size_t i = 0; i < n; ++i) boxes.push_back(box_of(ring[i], ring[(i + 1) % n]));
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t first = ~0u;
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      if (j > i && j < first && edges_clash(ring, i, j)) first = j;
    });
    if (first != ~0u) return RingCrossing{i, first};
  }
  return {};
}

}  // namespace citymesh
