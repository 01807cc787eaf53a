#pragma once

#include <span>

#include "core/geometry/point.h"

namespace citymesh {

struct Plane {
  Point3 origin{};
  Point3 normal{};  ///< unit length; of either sense
};

/// The plane with the least sum of squared distances to the points: through their mean, normal to
/// the direction in which they spread least. Of points on a line any plane through it.
Plane fit_plane(std::span<const Point3> points);

double signed_distance(const Plane& plane, const Point3& p);

}  // namespace citymesh
