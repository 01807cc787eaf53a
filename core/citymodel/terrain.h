#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/crs.h"
#include "core/geometry/point.h"

namespace citymesh {

/// A triangulated piece of the ground as its source has it: a TINRelief.
struct TerrainComponent {
  std::string gml_id{};
  Lod lod{};  ///< 0 where the source states none
  std::uint32_t first_triangle = 0, triangle_count = 0;
};

/// The ground as triangles. Pieces may overlap, and nothing is promised of how they meet.
struct Terrain {
  Crs crs{};
  std::vector<Point3> points{};       ///< in the units of `crs`, x east, y north; each place once
  std::vector<Triangle> triangles{};  ///< component by component; turned as the source has them
  std::vector<TerrainComponent> components{};  ///< those that have triangles
  std::uint64_t degenerate = 0;  ///< triangles left out because their corners lie on a line
  /// Relief left out: gml:ids by the reason.
  std::map<std::string, std::vector<std::string>> left_out{};
};

}  // namespace citymesh
