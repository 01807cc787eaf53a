#pragma once

#include <string>
#include <vector>

#include "core/citymodel/building.h"
#include "core/geometry/point.h"

namespace citymesh {

/// A polygon of a gridded boundary.
struct Face {
  std::vector<Ring>
      rings{};  ///< into Shell::points, not closed by a repeated corner; the first is the exterior
  SurfaceType type = SurfaceType::Unknown;
  std::uint32_t source = 0;  ///< index into Shell::surface_ids
  bool added = false;        ///< not of the input: closes a hole
  bool cavity = false;       ///< of an interior shell: faces into the hollow
  std::string made_by{};     ///< rung that made it, perhaps in an earlier run; empty: of the source
};

/// The boundary of a body on the exact grid: what healing works on and meshing takes. It may be
/// defective.
struct Shell {
  std::vector<GridPoint> points{};
  std::vector<Face> faces{};
  std::vector<std::string>
      surface_ids{};  ///< gml_id of surfaces or polygons; [0] is "" for faces without one
};

}  // namespace citymesh
