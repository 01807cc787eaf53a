#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/crs.h"
#include "core/source/feature.h"

namespace citymesh::source {

/// How coordinates that carry one CRS name of a file get into the working frame.
struct SrsPlacement {
  bool swap_axes = false;
  std::optional<Transformer> transformer{};  ///< none: `problem` says why
  std::string problem{};
};

/// Turns features into buildings of the working frame. Keeps its tables from one to the next.
class BuildingMaker {
 public:
  /// `srs` by index of DocumentFacts::srs_names.
  BuildingMaker(std::vector<SrsPlacement> srs, const Point3& origin)
      : srs_(std::move(srs)), origin_(origin) {}

  /// Polygons that cannot be placed are left out; an issue of the building says why.
  Building make(Feature& feature);

 private:
  void place(Feature& feature);
  bool place_polygon(Feature& feature, RawPolygon& polygon);
  void share_points(const Feature& feature);
  Geometry make_geometry(const Feature& feature, const RawShape& shape, std::int32_t object);

  std::vector<SrsPlacement> srs_;
  Point3 origin_;
  std::vector<std::uint32_t> table_{};       ///< hash table of points, open addressing
  std::vector<std::uint32_t> same_point_{};  ///< first point of the feature at the same place
  std::vector<std::uint32_t> seen_in_{};     ///< by point: the geometry that has it
  std::vector<std::uint32_t> index_in_{};    ///< by point: its index there
  std::uint32_t geometry_ = 0;
};

}  // namespace citymesh::source
