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

/// Copies a polygon of `from` (which may be `to`) to where the placement puts it. Template
/// coordinates are metres east, north and up of the reference point; a matrix that mirrors turns
/// the polygon so that it still looks outwards.
PolygonUse place_copy(const Feature& from, const PolygonUse& use, const Placement& placement,
                      std::string_view srs_name, Feature& to);

}  // namespace citymesh::source
