#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/citymodel/mesh.h"

namespace citymesh {

/// What points cover, in steps from the origin and with the origin itself: a reader that places its
/// origin by the extent of a file finds the one of the file. Empty until a point comes.
struct GridExtent {
  GridPoint min{}, max{};
  bool empty = true;

  void add(const TriangleMesh& mesh) {
    empty = empty && mesh.points.empty();
    for (const GridPoint& p : mesh.points) {
      min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
  }
};

/// A coordinate in the CRS, in grid steps.
inline std::int64_t absolute_steps(double origin_m, std::int64_t steps) {
  return static_cast<std::int64_t>(std::llround(origin_m * kGridStepsPerMetre)) + steps;
}

}  // namespace citymesh
