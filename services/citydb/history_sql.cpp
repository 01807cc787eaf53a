#include "services/citydb/history_sql.h"

#include <fmt/format.h>

namespace citymesh::citydb {
namespace {

/// Versions of one object are rows of the same id and class.
constexpr std::string_view kVersions =
    " FROM {0} mine JOIN {0} old"
    " ON old.{1} = mine.{1} AND old.objectclass_id = mine.objectclass_id";

std::string select(std::string_view columns, const ObjectTable& table, std::string_view which) {
  return fmt::format("SELECT {}", columns) +
         fmt::format(fmt::runtime(kVersions), table.name, table.gml_id) +
         fmt::format(" WHERE {}", which);
}

}  // namespace

std::string ended_by_lineage(const ObjectTable& table) {
  return select(
      "old.id, old.termination_date", table,
      "mine.lineage = $1 AND mine.creation_date <> now() AND mine.termination_date IS NULL"
      " AND old.termination_date = GREATEST(mine.creation_date, old.creation_date)");
}

std::string current_beside(const ObjectTable& table) {
  return select("old.id, GREATEST(now(), old.creation_date)", table,
                "mine.id = ANY($1::bigint[]) AND old.termination_date IS NULL"
                " AND (old.creation_date IS DISTINCT FROM now()"
                " OR old.lineage IS DISTINCT FROM mine.lineage)");
}

}  // namespace citymesh::citydb
