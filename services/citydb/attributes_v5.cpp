#include "services/citydb/attributes_v5.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace citymesh::citydb {

// Dates are stored as midnight of UTC.
const char* const kAttributesV5 =
    "SELECT p.feature_id, p.id, coalesce(p.parent_id, 0), p.name, coalesce(n.alias, ''),"
    " n.ade_id IS NOT NULL, coalesce(d.typename, ''), p.val_int, p.val_double, p.val_string,"
    " to_char(p.val_timestamp AT TIME ZONE 'UTC', 'YYYY-MM-DD'), p.val_uri, p.val_array::text"
    " FROM unnest($1::bigint[]) x(id)"
    " CROSS JOIN LATERAL (SELECT * FROM property a WHERE a.feature_id = x.id"
    " AND a.val_feature_id IS NULL AND a.val_geometry_id IS NULL AND a.val_implicitgeom_id IS NULL"
    " AND a.val_appearance_id IS NULL AND a.val_address_id IS NULL OFFSET 0) p"
    " LEFT JOIN namespace n ON n.id = p.namespace_id LEFT JOIN datatype d ON d.id = p.datatype_id";

namespace {

enum Column {
  kId = 1,
  kParent,
  kName,
  kNamespace,
  kExtension,
  kType,
  kWhole,
  kNumber,
  kText,
  kDate,
  kUri,
  kList
};

/// Types of one value; those of others are made of parts.
constexpr std::array<std::string_view, 13> kSimpleTypes{"Boolean",
                                                        "Integer",
                                                        "Double",
                                                        "String",
                                                        "URI",
                                                        "Timestamp",
                                                        "Code",
                                                        "Measure",
                                                        "MeasureOrNilReasonList",
                                                        "StringOrRef",
                                                        "TimePosition",
                                                        "Duration",
                                                        ""};

std::optional<AttributeValue> value_of(const postgres::Rows& rows, int row, GeometryData& json) {
  if (!rows.null(row, kWhole)) {
    if (rows.text(row, kType) == "Boolean") return rows.integer(row, kWhole) != 0;
    return rows.integer(row, kWhole);
  }
  if (!rows.null(row, kNumber)) return rows.number(row, kNumber);
  for (const int column : {kText, kDate, kUri})
    if (!rows.null(row, column)) return std::string(rows.text(row, column));
  if (!rows.null(row, kList))
    if (auto words = json.words(rows.text(row, kList))) return *std::move(words);
  return std::nullopt;
}

}  // namespace

void add_attributes_v5(const postgres::Rows& rows, std::span<const int> which, GeometryData& json,
                       source::RawObject& object) {
  constexpr std::string_view kHeight = "measuredHeight";
  std::map<std::int64_t, std::string> sets;  // "heat." by the id of the set's row
  std::set<std::int64_t> heights;
  for (const int row : which) {
    const auto name = rows.text(row, kName), type = rows.text(row, kType);
    if (rows.integer(row, kExtension) != 0) {
      source::count_name(object.skipped_ade_elements, name);
      continue;
    }
    const bool generic = rows.text(row, kNamespace) == "gen";
    const auto above = rows.integer(row, kParent);
    std::string full_name(name);
    if (heights.contains(above)) {
      if (name != "value") continue;
      full_name = kHeight;
    } else if (const auto set = sets.find(above); set != sets.end()) {
      full_name.insert(0, set->second);
    } else if (above != 0) {
      continue;  // of an attribute that is left out
    }
    if (type == "Height") {
      heights.insert(rows.integer(row, kId));
    } else if (type == "GenericAttributeSet") {
      sets.emplace(rows.integer(row, kId), full_name + ".");
    } else if (std::ranges::find(kSimpleTypes, type) != kSimpleTypes.end()) {
      auto value = value_of(rows, row, json);
      if (!value) continue;
      const auto* text = std::get_if<std::string>(&*value);
      if (generic || text == nullptr || !text->empty())
        add_attribute(object.attributes, full_name, *std::move(value));
    }
  }
}

}  // namespace citymesh::citydb
