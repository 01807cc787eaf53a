#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

struct WrapMesh {
  std::vector<Point3> points{};
  std::vector<Triangle> triangles{};
};

struct WrapLimits {
  std::size_t max_steps = 200'000;  ///< facets of the Delaunay tetrahedra that are looked through
  std::stop_token stop{};
};

/// The closed surface around all triangles that no ball of radius `alpha_m` from outside gets
/// through, `offset_m` away from them (Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez
/// 2022); then flat regions are thinned out (Lindstrom, Turk 1998). Takes time with (size / alpha)²
/// up to its limit. None at the limit, and where the library gives up.
std::optional<WrapMesh> alpha_wrap(std::span<const Point3> points,
                                   std::span<const Triangle> triangles, double alpha_m,
                                   double offset_m, const WrapLimits& limits);

}  // namespace citymesh
