#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/source/feature.h"
#include "tests/support/citydb/copy_table.h"

namespace citymesh::citydb_support {

/// Where version 4 keeps what a city model has.

int class_v4(const source::RawObject& object);
/// 0: there is no class for it.
int class_v4(SurfaceType type);
bool is_opening(SurfaceType type);

/// The column of a stated geometry that the row does not have yet; "" when there is none.
std::string_view free_column(const source::RawObject& object, const source::RawShape& shape,
                             const std::vector<Cell>& row);
/// lodN_multi_surface_id of a boundary surface or an opening; "" when there is none.
std::string_view surface_column(SurfaceType type, int lod);

/// Puts an attribute into the row of cityobject, of building or building_installation; false when
/// it has no column there.
bool add_to_cityobject(const std::string& name, const AttributeValue& value,
                       std::vector<Cell>& row);
bool add_to_building(const std::string& name, const AttributeValue& value, bool installation,
                     std::vector<Cell>& row);

}  // namespace citymesh::citydb_support
