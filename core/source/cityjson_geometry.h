#pragma once

#include <cstdint>
#include <vector>

#include "core/source/cityjson_header.h"

namespace citymesh::source {

/// Appends the geometries of a city object to an object of a feature; what is wrong becomes an
/// issue of it. false: the feature has more than `max_points` points.
bool add_geometries(const simdjson::dom::object& city_object, const CityJsonHeader& header,
                    std::string_view srs_name, const std::vector<Point3>& vertices,
                    std::uint64_t max_points, std::size_t object, Feature& feature);

/// Reads "geometry-templates"; one that is not readable has no shape.
void read_templates(const simdjson::dom::element& element, const DocumentOptions& options,
                    CityJsonHeader& header);

}  // namespace citymesh::source
