#include "tests/support/citydb/columns_v4.h"

#include <algorithm>
#include <array>

#include "tests/support/citydb/stored_feature.h"

namespace citymesh::citydb_support {
namespace {

using source::RawObject;
using source::RawShape;

/// By level of detail.
using Names = std::array<std::string_view, 5>;

// Codelist values that repeat share one column.
std::string joined_values(const std::string& text) {
  std::string joined;
  for (const std::string& value : split_values(text))
    joined += (joined.empty() ? "" : "--/\\--") + value;
  return joined;
}

}  // namespace

int class_v4(const RawObject& object) {
  switch (object.kind) {
    case ObjectKind::Building:
      return 26;
    case ObjectKind::BuildingPart:
      return 25;
    case ObjectKind::BuildingInstallation:
      return object.inside ? 28 : 27;
  }
  return 0;
}

int class_v4(SurfaceType type) {
  switch (type) {
    case SurfaceType::CeilingSurface:
      return 30;
    case SurfaceType::InteriorWallSurface:
      return 31;
    case SurfaceType::FloorSurface:
      return 32;
    case SurfaceType::RoofSurface:
      return 33;
    case SurfaceType::WallSurface:
      return 34;
    case SurfaceType::GroundSurface:
      return 35;
    case SurfaceType::ClosureSurface:
      return 36;
    case SurfaceType::Window:
      return 38;
    case SurfaceType::Door:
      return 39;
    case SurfaceType::OuterCeilingSurface:
      return 60;
    case SurfaceType::OuterFloorSurface:
      return 61;
    case SurfaceType::Unknown:
      break;
  }
  return 0;
}

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

std::string_view free_column(const RawObject& object, const RawShape& shape,
                             const std::vector<Cell>& columns) {
  constexpr Names kFootprints{"lod0_footprint_id"}, kRoofprints{"lod0_roofprint_id"};
  constexpr Names kSurfaces{"", "lod1_multi_surface_id", "lod2_multi_surface_id",
                            "lod3_multi_surface_id", "lod4_multi_surface_id"};
  constexpr Names kSolids{"", "lod1_solid_id", "lod2_solid_id", "lod3_solid_id", "lod4_solid_id"};
  constexpr Names kBreps{"", "", "lod2_brep_id", "lod3_brep_id", "lod4_brep_id"};
  const auto lod = static_cast<std::size_t>(shape.lod.major);
  if (lod >= kSolids.size()) return {};
  const bool solid = !shape.solids.empty();
  const auto is_free = [&](std::string_view name) {
    return std::none_of(columns.begin(), columns.end(),
                        [&](const Cell& cell) { return cell.column == name; });
  };
  std::string_view name = (object.kind == ObjectKind::BuildingInstallation ? kBreps
                           : lod == 0                                      ? kFootprints
                           : solid                                         ? kSolids
                                                                           : kSurfaces)[lod];
  if (name == kFootprints[0] && !is_free(name)) name = kRoofprints[0];
  return is_free(name) ? name : std::string_view{};
}

std::string_view surface_column(SurfaceType type, int lod) {
  constexpr Names kColumns{"", "", "lod2_multi_surface_id", "lod3_multi_surface_id",
                           "lod4_multi_surface_id"};
  if (lod < (is_opening(type) ? 3 : 2) || lod >= static_cast<int>(kColumns.size())) return {};
  return kColumns[static_cast<std::size_t>(lod)];
}

bool add_to_cityobject(const std::string& name, const AttributeValue& value,
                       std::vector<Cell>& row) {
  if (name == "name") {
    row.push_back({"name", joined_values(text_of(value))});
  } else if (name == "description") {
    row.push_back({"description", text_of(value)});
  } else if (name == "relativeToTerrain") {
    row.push_back({"relative_to_terrain", text_of(value)});
  } else if (name == "relativeToWater") {
    row.push_back({"relative_to_water", text_of(value)});
  } else if (name == "creationDate" || name == "terminationDate") {
    const auto date = timestamp_from(text_of(value));
    if (date) row.push_back({name == "creationDate" ? "creation_date" : "termination_date", *date});
    return date.has_value();
  } else {
    return false;
  }
  return true;
}

bool add_to_building(const std::string& name, const AttributeValue& value, bool installation,
                     std::vector<Cell>& row) {
  if (name == "class") {
    row.push_back({"class", text_of(value)});
    return true;
  }
  if (name == "function" || name == "usage") {
    row.push_back({name == "usage" ? "usage" : "function", joined_values(text_of(value))});
    return true;
  }
  if (installation) return false;
  if (name == "yearOfConstruction" || name == "yearOfDemolition") {
    const auto day = new_year_of(value);
    if (day)
      row.push_back(
          {name == "yearOfConstruction" ? "year_of_construction" : "year_of_demolition", *day});
    return day.has_value();
  }
  if (name == "roofType") {
    row.push_back({"roof_type", text_of(value)});
    return true;
  }
  if (name == "measuredHeight") {
    const double* const height = std::get_if<double>(&value);
    const std::int64_t* const whole = std::get_if<std::int64_t>(&value);
    if (!height && !whole) return false;
    row.push_back({"measured_height", height ? *height : static_cast<double>(*whole)});
    row.push_back({"measured_height_unit", "m"});
    return true;
  }
  if (name == "storeysAboveGround" || name == "storeysBelowGround") {
    const std::int64_t* const count = std::get_if<std::int64_t>(&value);
    if (count)
      row.push_back(
          {name == "storeysAboveGround" ? "storeys_above_ground" : "storeys_below_ground", *count});
    return count != nullptr;
  }
  if (name == "storeyHeightsAboveGround") {
    row.push_back({"storey_heights_above_ground", text_of(value)});
    row.push_back({"storey_heights_ag_unit", "m"});
    return true;
  }
  if (name == "storeyHeightsBelowGround") {
    row.push_back({"storey_heights_below_ground", text_of(value)});
    row.push_back({"storey_heights_bg_unit", "m"});
    return true;
  }
  return false;
}

}  // namespace citymesh::citydb_support
