#pragma once

#include <string>
#include <string_view>

namespace citymesh::citydb {

/// The table that has the history of objects, and its column for the gml:id.
struct ObjectTable {
  std::string_view name;
  std::string_view gml_id;
};

/// Both select (id, ended): an object and when it ended or is to end.

/// What buildings that earlier transactions wrote with the lineage $1 took the place of.
std::string ended_by_lineage(const ObjectTable& table);
/// What the buildings $1, bigint[], of this transaction take the place of.
std::string current_beside(const ObjectTable& table);

}  // namespace citymesh::citydb
