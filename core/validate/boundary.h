#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/shell.h"
#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// A polygon under test.
struct TestedPolygon {
  std::vector<Ring> rings{};    ///< into Boundary::points, without the repeated last corner
  std::int32_t open_ring = -1;  ///< the first that does not return to its first corner as it should
  std::string_view id{};        ///< gml_id of the polygon or its surface
  std::uint32_t number = 0;     ///< in its geometry
};

/// The polygons of one shell, or of a set of surfaces, over points of their own: points closer than
/// the snap tolerance are one, the first of them.
struct Boundary {
  std::string name{};  ///< "shell 1 of solid 2, "; "" where there is only one
  std::vector<GridPoint> points{};
  std::vector<TestedPolygon> polygons{};
  std::vector<Triangle> triangles{};        ///< once the polygons are sound
  std::vector<std::uint32_t> polygon_of{};  ///< of each triangle

  /// "polygon 'wall_3'", after the name of the boundary.
  std::string label(const TestedPolygon& polygon) const;
};

/// `points` are those of the geometry on the grid. Ids stay in `building` and `geometry`.
Boundary make_boundary(const Building& building, const Geometry& geometry,
                       std::span<const GridPoint> points, std::span<const std::uint32_t> polygons,
                       double snap_tolerance_m);

/// Of the faces of a shell. Ids stay in it.
Boundary make_boundary(const Shell& shell, std::span<const std::uint32_t> faces,
                       double snap_tolerance_m);

}  // namespace citymesh
