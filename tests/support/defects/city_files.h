#pragma once

#include <ostream>
#include <vector>

#include "tests/support/defects/city.h"

namespace citymesh::testing {

/// The city as CityJSON 2.0 at real coordinates of EPSG:25833, in steps of 0.1 mm.
void write_city(const std::vector<DefectiveHouse>& city, std::ostream& file);

/// What every house should be, one line each: gml_id, shape, defects (joined by +, or -), volume,
/// undefined volume.
void write_truth(const std::vector<DefectiveHouse>& city, std::ostream& file);

}  // namespace citymesh::testing
