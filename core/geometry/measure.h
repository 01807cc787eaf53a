#pragma once

#include <span>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// Six times the signed volume enclosed by a closed set of triangles, exact; positive when they
/// face outwards.
Int128 volume6(std::span<const GridPoint> points, std::span<const Triangle> triangles);

double volume_m3(std::span<const GridPoint> points, std::span<const Triangle> triangles);
double area_m2(std::span<const GridPoint> points, std::span<const Triangle> triangles);

double distance_m(const GridPoint& a, const GridPoint& b);
/// From a point to a closed segment; `position` (optional) receives the parameter 0 … 1 of the
/// nearest point.
double distance_to_segment_m(const GridPoint& p, const GridPoint& a, const GridPoint& b,
                             double* position = nullptr);
double distance_to_triangle_m(const GridPoint& p, const GridPoint& a, const GridPoint& b,
                              const GridPoint& c);

GridBox box_of(std::span<const GridPoint> points, const Triangle& triangle);
std::vector<GridBox> boxes_of(std::span<const GridPoint> points,
                              std::span<const Triangle> triangles);

/// Nearest distances from places to a fixed set of triangles.
class DistanceField {
 public:
  DistanceField(std::span<const GridPoint> points, std::span<const Triangle> triangles);
  /// Infinite when there are no triangles.
  double distance_m(const GridPoint& p) const;

 private:
  std::vector<GridPoint> points_;
  std::vector<Triangle> triangles_;
  BoxTree tree_;
};

struct Deviation {
  double max_m = 0, mean_m = 0;
};

struct TriangleView {
  std::span<const GridPoint> points;
  std::span<const Triangle> triangles;
};

/// Distance from one surface to another, at the corners, edge middles and centres of its triangles;
/// 0 where one has no triangles.
Deviation deviation_to(const TriangleView& from, const TriangleView& to);

/// Both directions together: the larger maximum, the mean of the means.
Deviation two_sided(const Deviation& a, const Deviation& b);

}  // namespace citymesh
