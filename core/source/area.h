#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh::source {

struct Point2 {
  double x = 0, y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// Rings of polygons one after another: the first of each polygon is its exterior.
struct Footprints {
  struct Ring {
    std::uint32_t first = 0, count = 0;  ///< run of points
    bool exterior = false;
  };
  std::vector<Point2> points{};
  std::vector<Ring> rings{};
};

/// Not closed.
using Ring2 = std::vector<Point2>;

/// What a request wants in the plane of the working CRS: inside by the even-odd rule over its
/// rings. All tests are closed: touching is inside. They are done in doubles relative to the rings,
/// exact to about 1e-9 of their size.
class Area {
 public:
  /// @param rings at least one, none empty
  explicit Area(std::vector<Ring2> rings);

  const Point2& min() const { return min_; }
  const Point2& max() const { return max_; }
  bool box_touches(const Point2& min, const Point2& max) const {
    return min.x <= max_.x && max.x >= min_.x && min.y <= max_.y && max.y >= min_.y;
  }
  bool contains(const Point2& point) const;
  /// Whether all of a ring's sides lie within. What an opening of the area leaves out in the middle
  /// of the ring is not looked for.
  bool contains_sides(std::span<const Point2> ring) const;
  /// Whether a polygon (exterior, holes) has a point in common with the area.
  bool touches(std::span<const Point2> points, std::span<const Footprints::Ring> polygon) const;

 private:
  std::vector<Ring2> rings_;
  Point2 min_{}, max_{};
};

}  // namespace citymesh::source
