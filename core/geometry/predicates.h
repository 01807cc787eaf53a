#pragma once

#include <cstdint>

#include "core/geometry/point.h"

namespace citymesh {

/// Exact for |coordinate| <= kGridLimit: differences fit 33 bits, a determinant of three of them
/// 102 bits.
__extension__ using Int128 = __int128;

struct GridPoint2 {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const GridPoint2&, const GridPoint2&) = default;
  friend auto operator<=>(const GridPoint2&, const GridPoint2&) = default;
};

constexpr int sign(Int128 value) { return (value > 0) - (value < 0); }

/// Twice the signed area of abc: positive when c lies to the left of a→b.
constexpr Int128 area2(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c) {
  return Int128{b.x - a.x} * (c.y - a.y) - Int128{b.y - a.y} * (c.x - a.x);
}
constexpr int orient2d(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c) {
  return sign(area2(a, b, c));
}

/// Six times the signed volume of abcd: positive when a, b, c appear counter-clockwise seen from d.
constexpr Int128 volume6(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                         const GridPoint& d) {
  const std::int64_t bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
  const std::int64_t cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
  const std::int64_t dx = d.x - a.x, dy = d.y - a.y, dz = d.z - a.z;
  return (Int128{by} * cz - Int128{bz} * cy) * dx + (Int128{bz} * cx - Int128{bx} * cz) * dy +
         (Int128{bx} * cy - Int128{by} * cx) * dz;
}
constexpr int orient3d(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                       const GridPoint& d) {
  return sign(volume6(a, b, c, d));
}

/// Which coordinate a planar figure is seen along.
enum class Axis : std::uint8_t { X, Y, Z };

/// Drops `axis`; the remaining axes keep their cyclic order, so that a figure that is
/// counter-clockwise seen from the positive side of the axis stays counter-clockwise.
constexpr GridPoint2 project(const GridPoint& p, Axis axis) {
  switch (axis) {
    case Axis::X:
      return {p.y, p.z};
    case Axis::Y:
      return {p.z, p.x};
    case Axis::Z:
      return {p.x, p.y};
  }
  return {p.x, p.y};
}

/// Whether the closed segments ab and cd have a point in common.
bool segments_meet(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c,
                   const GridPoint2& d);

/// Normal of a triangle in double precision, exact up to rounding; length is twice the area
/// (steps²).
Point3 normal_of(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// The axis along which the triangle's projection is largest; exact. Any axis for a degenerate one.
Axis dominant_axis(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// Whether two closed triangles have a point in common. Neither may be degenerate.
bool triangles_meet(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t);

/// How two triangles of a shell may meet: through the vertices they share, and nowhere else.
/// True when the closed triangles have a point in common that is not explained by shared corners
/// (identical coordinates). Triangles that share all three corners are not judged here.
/// Neither triangle may be degenerate. Cf. Guigue and Devillers 2003, here on exact integers.
bool triangles_clash(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t);

}  // namespace citymesh
