#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/source/feature.h"

namespace citymesh::source {

/// Where a template geometry is put: implicit geometries of CityGML, instances of CityJSON.
struct Placement {
  std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  ///< row by row
  Point3 reference{};     ///< in the file's coordinates and axis order
  std::uint32_t srs = 0;  ///< of `reference`
};

/// Sixteen finite numbers, the last row 0 0 0 w with w not 0.
std::optional<std::array<double, 16>> matrix_from(std::string_view text);

/// Copies polygons to where a placement puts them. Template coordinates are metres east, north and
/// up of the reference point; a matrix that mirrors turns polygons so that they still look
/// outwards.
class Placer {
 public:
  Placer(const Placement& placement, std::string_view srs_name);

  /// `from` may be `to`.
  PolygonUse copy(const Feature& from, const PolygonUse& use, Feature& to) const;

 private:
  /// Units of the file's axes in a metre east, north and up of the reference point.
  struct Steps {
    double east = 1, north = 1, up = 1;
    bool north_first = false;
  };
  static Steps steps_at(std::string_view srs_name, const Point3& reference);

  Placement placement_;
  Steps steps_;
  bool mirrors_;
};

}  // namespace citymesh::source
