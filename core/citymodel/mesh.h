#pragma once

#include <string>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/shell.h"
#include "core/geometry/point.h"

namespace citymesh {

/// Triangles over points of the exact grid; every triangle knows what it is part of. Points are
/// numbered in the order in which the rings of the faces use them first.
struct TriangleMesh {
  std::vector<GridPoint> points{};
  std::vector<Triangle> triangles{};             ///< counter-clockwise seen from outside
  std::vector<SurfaceType> surface_types{};      ///< per triangle
  std::vector<std::uint32_t> source_surfaces{};  ///< per triangle: index into `surface_ids`
  std::vector<std::string> surface_ids{};        ///< gml_id of source surface or polygon, may be ""
  std::vector<Face> faces{};  ///< the polygons that the triangles fill, face by face in their
                              ///< order; rings index `points`, `source` indexes `surface_ids`
};

/// A closed shell (or several that do not touch) that stands for itself in the files.
struct Body {
  std::string name{};    ///< file-safe, unique in the run
  std::string gml_id{};  ///< of the Building or BuildingPart
  ObjectKind kind = ObjectKind::Building;
  std::string rung{};  ///< of this body: as_is, healed …
  std::string lod{};   ///< of the geometry it was made from: "2", "1.2"; "" where nothing is known
  Attributes attributes{};
  std::vector<Address> addresses{};
  TriangleMesh mesh{};
};

/// All that is delivered of one top-level building.
struct BuildingBodies {
  std::string gml_id{};
  std::string rung{};  ///< the worst of its bodies
  Attributes attributes{};
  std::vector<Address> addresses{};
  std::vector<Body> bodies{};
};

}  // namespace citymesh
