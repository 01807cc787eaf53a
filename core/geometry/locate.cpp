#include "core/geometry/locate.h"

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

Side locate(std::span<const GridPoint> points, std::span<const Triangle> triangles,
            const GridPoint& place, std::int64_t parts) {
  bool inside = false;
  const GridPoint2 o = project(place, Axis::X);
  for (const Triangle& triangle : triangles) {
    GridPoint corner[3];
    GridPoint2 flat[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const GridPoint& p = points[triangle[i]];
      corner[i] = {p.x * parts, p.y * parts, p.z * parts};
      flat[i] = project(corner[i], Axis::X);
    }
    const auto all = [&](auto&& beyond) { return beyond(0) && beyond(1) && beyond(2); };
    if (all([&](int i) { return corner[i].x < place.x; }) ||
        all([&](int i) { return flat[i].x < o.x; }) ||
        all([&](int i) { return flat[i].x > o.x; }) ||
        all([&](int i) { return flat[i].y < o.y; }) || all([&](int i) { return flat[i].y > o.y; }))
      continue;
    const int side = orient3d(corner[0], corner[1], corner[2], place);
    if (side == 0) {
      const Axis axis = dominant_axis(corner[0], corner[1], corner[2]);
      const GridPoint2 seen[3]{project(corner[0], axis), project(corner[1], axis),
                               project(corner[2], axis)};
      if (contains(seen, project(place, axis))) return Side::On;
    }
    // The line through the place crosses the triangle where its projection holds the place. Seen
    // along +x the plane is ahead when the place lies behind a face that looks towards +x, or in
    // front of one towards -x.
    bool crossed = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const GridPoint2 &a = flat[i], &b = flat[(i + 1) % 3];
      if ((a.y > o.y) == (b.y > o.y)) continue;
      const int turn = orient2d(a, b, o);
      if (turn != 0 && (turn > 0) == (b.y > a.y)) crossed = !crossed;
    }
    if (crossed && side * orient2d(flat[0], flat[1], flat[2]) < 0) inside = !inside;
  }
  return inside ? Side::Inside : Side::Outside;
}

}  // namespace citymesh
