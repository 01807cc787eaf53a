#include "core/geometry/locate.h"

#include <algorithm>
#include <vector>

#include "core/geometry/measure.h"

namespace citymesh {
namespace {

/// Crossing of a ray in direction (1, ε) from `o`: the perturbation is symbolic, so that no corner
/// is special.
enum class Crossing { None, Hit, On };

Crossing cross_edge(const GridPoint2& a, const GridPoint2& b, const GridPoint2& o) {
  if ((a.y > o.y && b.y > o.y) || (a.y < o.y && b.y < o.y) || (a.x < o.x && b.x < o.x))
    return Crossing::None;
  const int side = orient2d(a, b, o);
  if (side == 0 && std::min(a.x, b.x) <= o.x && o.x <= std::max(a.x, b.x)) return Crossing::On;
  if ((a.y > o.y) == (b.y > o.y)) return Crossing::None;
  return (side > 0) == (b.y > a.y) ? Crossing::Hit : Crossing::None;
}

std::int64_t floored(std::int64_t value, std::int64_t parts) {
  return value >= 0 ? value / parts : -((-value + parts - 1) / parts);
}

bool contains(const GridPoint2 (&t)[3], const GridPoint2& o) {
  const int u = orient2d(t[0], t[1], o), v = orient2d(t[1], t[2], o), w = orient2d(t[2], t[0], o);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

}  // namespace

Side locate(std::span<const GridPoint2> ring, const GridPoint2& place, std::int64_t parts) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
    const GridPoint2 a{p.x * parts, p.y * parts}, b{q.x * parts, q.y * parts};
    switch (cross_edge(a, b, place)) {
      case Crossing::On:
        return Side::On;
      case Crossing::Hit:
        inside = !inside;
        break;
      case Crossing::None:
        break;
    }
  }
  return inside ? Side::Inside : Side::Outside;
}

Locator::Locator(std::span<const GridPoint> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles), tree_(boxes_of(points, triangles)) {
  if (triangles.empty()) return;
  box_ = box_of(points, triangles[0]);
  for (const Triangle& t : triangles) box_.add(box_of(points, t));
}

Side Locator::locate(const GridPoint& place, std::int64_t parts) const {
  const GridPoint low{floored(place.x, parts), floored(place.y, parts), floored(place.z, parts)};
  const GridBox around{low, {low.x + 1, low.y + 1, low.z + 1}};
  if (triangles_.empty() || !box_.meets(around)) return Side::Outside;
  GridBox ahead = around;  // everything on the ray towards +x
  ahead.max.x = std::max(ahead.max.x, box_.max.x);
  bool inside = false, on = false;
  const GridPoint2 o = project(place, Axis::X);
  tree_.for_each_meeting(ahead, [&](std::uint32_t i) {
    GridPoint corner[3];
    GridPoint2 flat[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const GridPoint& p = points_[triangles_[i][k]];
      corner[k] = {p.x * parts, p.y * parts, p.z * parts};
      flat[k] = project(corner[k], Axis::X);
    }
    const int side = orient3d(corner[0], corner[1], corner[2], place);
    if (side == 0) {
      const Axis axis = dominant_axis(corner[0], corner[1], corner[2]);
      const GridPoint2 seen[3]{project(corner[0], axis), project(corner[1], axis),
                               project(corner[2], axis)};
      on = on || contains(seen, project(place, axis));
    }
    // The line through the place crosses the triangle where its projection holds the place. Seen
    // along +x the plane is ahead when the place lies behind a face that looks towards +x, or in
    // front of one towards -x.
    bool crossed = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const GridPoint2 &a = flat[k], &b = flat[(k + 1) % 3];
      if ((a.y > o.y) == (b.y > o.y)) continue;
      const int turn = orient2d(a, b, o);
      if (turn != 0 && (turn > 0) == (b.y > a.y)) crossed = !crossed;
    }
    if (crossed && side * orient2d(flat[0], flat[1], flat[2]) < 0) inside = !inside;
  });
  return on ? Side::On : inside ? Side::Inside : Side::Outside;
}

}  // namespace citymesh
