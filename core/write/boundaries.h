#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/write/citygml_features.h"
#include "core/write/gml_ids.h"

namespace citymesh {

inline constexpr std::size_t kNoBoundary = ~std::size_t{0};

bool is_opening(SurfaceType type);

/// A boundary surface: faces of one type and source surface, made by one rung.
struct BoundarySurface {
  SurfaceType type = SurfaceType::Unknown;
  std::string id{};
  std::string_view made_by{};
  std::vector<std::size_t> faces{};     ///< of the mesh; none: a wall that is all opening
  std::vector<std::size_t> openings{};  ///< surfaces that lie in this one
};

/// The faces of a body as CityGML has them: polygons with ids, those of known type in surfaces.
struct Boundaries {
  int lod = 2;  ///< that the version can hold
  std::vector<BoundarySurface> surfaces{};
  std::vector<std::size_t> surface_of_face{};  ///< kNoBoundary: the version has none for its type
  std::vector<std::string> polygon_ids{};      ///< of each face
};

/// Of an object with a body. Every opening is in one other surface.
Boundaries boundaries_of(CityGml version, const CityObject& object, BodyIds& ids);

}  // namespace citymesh
