#pragma once

#include <vector>

#include "core/citymodel/building.h"
#include "core/geometry/point.h"

namespace citymesh::testing {

struct HouseFace {
  SurfaceType type = SurfaceType::Unknown;
  std::vector<std::vector<Point3>> rings{};  ///< exterior, then holes; seen from outside ccw and cw
};

/// The boundary of a solid, face by face; a corner is the same double in every face that has it.
struct House {
  std::vector<HouseFace> faces{};
};

/// Vector area of a face: along its normal, as long as its area; holes count against it.
Point3 area_vector(const HouseFace& face);

/// Volume within a closed boundary of planar faces (divergence theorem).
double volume_m3(const House& house);

/// Walls across the house: what it has in common with the plane x = `x_m`, which passes through no
/// corner.
std::vector<HouseFace> cross_section(const House& house, double x_m);

}  // namespace citymesh::testing
