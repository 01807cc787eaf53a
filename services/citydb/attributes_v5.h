#pragma once

#include <span>

#include "core/source/feature.h"
#include "services/citydb/geometry_data.h"
#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// The attributes of features (parameter: their ids) in version 5, where they are rows of
/// property, nested ones with the row above.
extern const char* const kAttributesV5;

/// Adds the attributes of one object, rows `which` in the order of their ids, by the names that
/// the readers of CityGML give them. Like those they leave out what is made of parts (events,
/// elevations, areas), except for the height, which is the measuredHeight of CityGML 2.0. The
/// yearOfConstruction of CityGML 2.0 is in the database only as dateOfConstruction.
void add_attributes_v5(const postgres::Rows& rows, std::span<const int> which, GeometryData& json,
                       source::RawObject& object);

}  // namespace citymesh::citydb
