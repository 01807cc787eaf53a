#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

bool within_span(const GridPoint2& a, const GridPoint2& b, const GridPoint2& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool in_triangle(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c,
                 const GridPoint2& p) {
  const int u = orient2d(a, b, p), v = orient2d(b, c, p), w = orient2d(c, a, p);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// Closed segment pq against closed triangle t.
bool segment_meets_triangle(const GridPoint& p, const GridPoint& q,
                            const std::array<GridPoint, 3>& t) {
  const int side_p = orient3d(t[0], t[1], t[2], p);
  const int side_q = orient3d(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {
    const Axis axis = dominant_axis(t[0], t[1], t[2]);
    const GridPoint2 a = project(t[0], axis), b = project(t[1], axis), c = project(t[2], axis);
    const GridPoint2 u = project(p, axis), v = project(q, axis);
    return in_triangle(a, b, c, u) || segments_meet(u, v, a, b) || segments_meet(u, v, b, c) ||
           segments_meet(u, v, c, a);
  }
  const int u = orient3d(p, q, t[0], t[1]);
  const int v = orient3d(p, q, t[1], t[2]);
  const int w = orient3d(p, q, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

}  // namespace

bool segments_meet(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c,
                   const GridPoint2& d) {
  const int abc = orient2d(a, b, c), abd = orient2d(a, b, d);
  const int cda = orient2d(c, d, a), cdb = orient2d(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && within_span(a, b, c)) || (abd == 0 && within_span(a, b, d)) ||
         (cda == 0 && within_span(c, d, a)) || (cdb == 0 && within_span(c, d, b));
}

Point3 normal_of(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const auto bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y),
             bz = static_cast<double>(b.z - a.z);
  const auto cx = static_cast<double>(c.x - a.x), cy = static_cast<double>(c.y - a.y),
             cz = static_cast<double>(c.z - a.z);
  return {by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx};
}

Axis dominant_axis(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const auto magnitude = [&](Axis axis) {
    const Int128 area = area2(project(a, axis), project(b, axis), project(c, axis));
    return area < 0 ? -area : area;
  };
  const Int128 x = magnitude(Axis::X), y = magnitude(Axis::Y), z = magnitude(Axis::Z);
  if (z >= x && z >= y) return Axis::Z;
  return x >= y ? Axis::X : Axis::Y;
}

bool triangles_meet(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets_triangle(s[i], s[(i + 1) % 3], t)) return true;
    if (segment_meets_triangle(t[i], t[(i + 1) % 3], s)) return true;
  }
  return false;
}

bool triangles_clash(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t) {
  // Corner i of s equals corner partner[i] of t, or -1.
  std::array<int, 3> partner{-1, -1, -1};
  std::array<bool, 3> taken{};
  int shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (s[static_cast<std::size_t>(i)] == t[static_cast<std::size_t>(j)]) {
        partner[static_cast<std::size_t>(i)] = j;
        taken[static_cast<std::size_t>(j)] = true;
        ++shared;
      }
  if (shared == 3) return false;

  if (shared == 2) {
    // An edge in common: they overlap only when folded flat onto each other.
    std::size_t lone_s = 0, lone_t = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (partner[i] < 0) lone_s = i;
      if (!taken[i]) lone_t = i;
    }
    if (orient3d(s[0], s[1], s[2], t[lone_t]) != 0) return false;
    const Axis axis = dominant_axis(s[0], s[1], s[2]);
    const GridPoint2 a = project(s[(lone_s + 1) % 3], axis), b = project(s[(lone_s + 2) % 3], axis);
    return orient2d(a, b, project(s[lone_s], axis)) == orient2d(a, b, project(t[lone_t], axis));
  }

  if (shared == 1) {
    // A corner in common: any further common point shows on one of the two opposite edges.
    std::size_t i = 0, j = 0;
    while (partner[i] < 0) ++i;
    j = static_cast<std::size_t>(partner[i]);
    return segment_meets_triangle(s[(i + 1) % 3], s[(i + 2) % 3], t) ||
           segment_meets_triangle(t[(j + 1) % 3], t[(j + 2) % 3], s);
  }

  return triangles_meet(s, t);
}

}  // namespace citymesh
