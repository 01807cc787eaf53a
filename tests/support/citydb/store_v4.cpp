#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "tests/support/citydb/columns_v4.h"
#include "tests/support/citydb/copy_table.h"
#include "tests/support/citydb/store.h"

namespace citymesh::citydb_support {
namespace {

using source::PolygonUse;
using source::RawObject;
using source::RawShape;

/// What a row of surface_geometry above the polygons is.
struct Flags {
  bool solid = false, composite = false;
};

class StoreV4 final : public Store {
 public:
  StoreV4(Database& database, const LoadOptions& options, LoadReport& report)
      : database_(database), options_(options), report_(report) {}

  Result<void> find_ids() {
    for (const auto& [table, id] :
         {std::pair(&cityobjects_, &cityobject_), std::pair(&surfaces_, &surface_),
          std::pair(&generics_, &generic_), std::pair(&addresses_, &address_)}) {
      const auto next = table->next_id(database_);
      if (!next) return next.error();
      *id = *next;
    }
    return {};
  }

  void add(const StoredFeature& feature) override {
    std::vector<std::int64_t> ids(feature.objects().size());
    for (std::int64_t& id : ids) id = cityobject_++;
    Box3 all;
    for (std::size_t i = ids.size(); i-- > 1;) add_object(feature, i, ids, all);
    add_object(feature, 0, ids, all);
    add_copies();
  }

  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const CopyTable* table : tables()) sum += table->bytes();
    return sum;
  }

  Result<void> flush() override {
    for (CopyTable* table : tables())
      if (auto flushed = table->flush(database_); !flushed) return flushed;
    return {};
  }

 private:
  std::array<CopyTable*, 10> tables() {
    return {&cityobjects_, &surfaces_, &buildings_, &installations_, &thematic_,
            &openings_,    &fillings_, &addresses_, &address_links_, &generics_};
  }
  std::array<const CopyTable*, 10> tables() const {
    return {&cityobjects_, &surfaces_, &buildings_, &installations_, &thematic_,
            &openings_,    &fillings_, &addresses_, &address_links_, &generics_};
  }

  // `all` is the extent of the building with everything that belongs to it.
  void add_object(const StoredFeature& feature, std::size_t index,
                  const std::vector<std::int64_t>& ids, Box3& all) {
    const RawObject& object = feature.objects()[index];
    const std::int64_t id = ids[index];
    std::vector<Cell> columns{{"id", id}, {"objectclass_id", std::int64_t{class_v4(object)}}};
    const bool installation = object.kind == ObjectKind::BuildingInstallation;
    const auto parent = object.parent < 0 ? id : ids[static_cast<std::size_t>(object.parent)];
    if (installation) {
      columns.push_back({"building_id", parent});
    } else {
      if (parent != id) columns.push_back({"building_parent_id", parent});
      columns.push_back({"building_root_id", ids.front()});
    }
    Box3 box;
    add_geometries(feature, object, id, box, columns);
    add_surfaces(feature, index, id, box);
    all.add(box);

    std::vector<Cell> row = cityobject(feature, id, class_v4(object), object.gml_id,
                                       " object " + std::to_string(index), index == 0 ? all : box);
    add_attributes(object, id, installation, columns, row);
    cityobjects_.add(row);
    (installation ? installations_ : buildings_).add(columns);
    if (!installation)
      for (const Address& address : object.addresses) add_address(address, id);
  }

  std::vector<Cell> cityobject(const StoredFeature& feature, std::int64_t id, int object_class,
                               const std::string& gml_id, const std::string& unique,
                               const Box3& box) const {
    std::vector<Cell> row{{"id", id},
                          {"objectclass_id", std::int64_t{object_class}},
                          {"gmlid", feature.id(gml_id, unique)}};
    if (!box.is_empty()) row.push_back({"envelope", envelope_ewkb(box, options_.schema.srid)});
    row.push_back({"last_modification_date", options_.creation_date});
    row.push_back({"updating_person", "importer"});
    return row;
  }

  // ---- geometry ----------------------------------------------------------------------------

  void add_geometries(const StoredFeature& feature, const RawObject& object, std::int64_t owner,
                      Box3& box, std::vector<Cell>& columns) {
    for (const RawShape& shape : object.shapes) {
      if (shape.assembled) continue;
      const std::string_view column = free_column(object, shape, columns);
      if (column.empty()) {
        ++report_.dropped_geometries;
        continue;
      }
      columns.push_back({column, tree(feature, shape, owner, box)});
    }
  }

  std::int64_t tree(const StoredFeature& feature, const RawShape& shape, std::int64_t owner,
                    Box3& box) {
    const std::int64_t root = surface_++;
    switch (shape.type) {
      case GeometryType::MultiSurface:
      case GeometryType::CompositeSurface:
        inner(root, 0, root, {.composite = shape.type == GeometryType::CompositeSurface}, owner);
        for (const PolygonUse& use : shape.uses) leaf(feature, use, root, root, owner, true, box);
        break;
      case GeometryType::Solid:
        solid(feature, shape, shape.solids.front(), root, 0, root, owner, box);
        break;
      case GeometryType::MultiSolid:
      case GeometryType::CompositeSolid: {
        const bool composite = shape.type == GeometryType::CompositeSolid;
        inner(root, 0, root, {.solid = composite, .composite = composite}, owner);
        for (const Solid& member : shape.solids)
          solid(feature, shape, member, surface_++, root, root, owner, box);
      }
    }
    return root;
  }

  // A solid has one child, its shell; cavities are dropped.
  void solid(const StoredFeature& feature, const RawShape& shape, const Solid& solid,
             std::int64_t id, std::int64_t parent, std::int64_t root, std::int64_t owner,
             Box3& box) {
    inner(id, parent, root, {.solid = true}, owner);
    const std::int64_t shell = surface_++;
    inner(shell, id, root, {.composite = true}, owner);
    for (const std::uint32_t use : solid.exterior)
      leaf(feature, shape.uses[use], shell, root, owner, true, box);
    report_.dropped_cavities += solid.interiors.size();
  }

  void inner(std::int64_t id, std::int64_t parent, std::int64_t root, Flags flags,
             std::int64_t owner) {
    surfaces_.add({{"id", id},
                   {"gmlid", generated_id("surface_geometry " + std::to_string(id))},
                   {"parent_id", id == root ? std::nullopt : std::optional(std::to_string(parent))},
                   {"root_id", root},
                   {"is_solid", flags.solid ? "1" : "0"},
                   {"is_composite", flags.composite ? "1" : "0"},
                   {"is_triangulated", "0"},
                   {"is_xlink", "0"},
                   {"is_reverse", "0"},
                   {"cityobject_id", owner}});
  }

  // `refers`: the polygon is another's where a surface of the building has it.
  void leaf(const StoredFeature& feature, const PolygonUse& use, std::int64_t parent,
            std::int64_t root, std::int64_t owner, bool refers, Box3& box) {
    const auto rings = feature.rings(use, box);
    if (!rings) return;
    const bool global = feature.is_borrowed(use.polygon);
    const bool local = !global && refers && feature.is_shared(use.polygon);
    std::vector<Cell> row{{"gmlid", feature.polygon_id(use.polygon)},
                          {"parent_id", parent},
                          {"root_id", root},
                          {"is_solid", "0"},
                          {"is_composite", "0"},
                          {"is_triangulated", "0"},
                          {"is_xlink", global  ? "1"
                                       : local ? "2"
                                               : "0"},
                          {"is_reverse", use.reversed ? "1" : "0"},
                          {"geometry", Ewkb(options_.schema.srid).polygon(*rings).take()},
                          {"cityobject_id", owner}};
    if (global || local) {
      copies_.push_back(std::move(row));
      return;
    }
    row.push_back({"id", surface_++});
    surfaces_.add(row);
  }

  // The importer follows references when everything else is stored.
  void add_copies() {
    for (std::vector<Cell>& row : copies_) {
      row.push_back({"id", surface_++});
      surfaces_.add(row);
    }
    copies_.clear();
  }

  // ---- boundary surfaces -------------------------------------------------------------------

  void add_surfaces(const StoredFeature& feature, std::size_t index, std::int64_t owner,
                    Box3& all) {
    const RawObject& object = feature.objects()[index];
    const std::size_t count = object.surfaces.size();
    std::vector<std::int64_t> ids(count);
    std::vector<Box3> boxes(count);
    std::vector<std::vector<Cell>> columns(count);
    for (std::int64_t& id : ids) id = cityobject_++;

    const auto has_class = [&](std::size_t s) { return class_v4(object.surfaces[s].type) != 0; };
    const auto is_storable = [&](std::size_t s) {
      const Surface& surface = object.surfaces[s];
      if (!is_opening(surface.type)) return has_class(s);
      return surface.parent >= 0 && has_class(static_cast<std::size_t>(surface.parent));
    };

    for (const auto& geometry : feature.surface_geometries(index)) {
      const std::size_t s = geometry.surface;
      const std::string_view column = surface_column(object.surfaces[s].type, geometry.lod);
      if (!is_storable(s) || column.empty()) {
        ++report_.dropped_geometries;
        continue;
      }
      const std::int64_t root = surface_++;
      inner(root, 0, root, {}, ids[s]);
      for (const PolygonUse& use : geometry.uses)
        leaf(feature, use, root, root, ids[s], false, boxes[s]);
      columns[s].push_back({column, root});
    }

    for (std::size_t s = 0; s < count; ++s) {
      const Surface& surface = object.surfaces[s];
      const int number = class_v4(surface.type);
      if (!is_storable(s)) {
        ++report_.dropped_surfaces;
        continue;
      }
      all.add(boxes[s]);
      std::vector<Cell> row =
          cityobject(feature, ids[s], number, surface.gml_id,
                     " surface " + std::to_string(index) + "." + std::to_string(s), boxes[s]);
      row.push_back({"creation_date", options_.creation_date});
      cityobjects_.add(row);
      columns[s].push_back({"id", ids[s]});
      columns[s].push_back({"objectclass_id", std::int64_t{number}});
      if (is_opening(surface.type)) {
        openings_.add(columns[s]);
        fillings_.add({{"opening_id", ids[s]},
                       {"thematic_surface_id", ids[static_cast<std::size_t>(surface.parent)]}});
        continue;
      }
      columns[s].push_back({object.kind == ObjectKind::BuildingInstallation
                                ? "building_installation_id"
                                : "building_id",
                            owner});
      thematic_.add(columns[s]);
    }
  }

  // ---- attributes --------------------------------------------------------------------------

  void add_attributes(const RawObject& object, std::int64_t owner, bool installation,
                      std::vector<Cell>& columns, std::vector<Cell>& cityobject) {
    std::map<std::string, std::int64_t> sets;
    bool created = false;
    for (const auto& [name, value] : object.attributes) {
      if (add_to_cityobject(name, value, cityobject)) {
        created = created || name == "creationDate";
        continue;
      }
      if (add_to_building(name, value, installation, columns)) continue;
      add_generic(name, value, owner, sets);
    }
    if (!created) cityobject.push_back({"creation_date", options_.creation_date});
  }

  void add_generic(const std::string& full_name, const AttributeValue& value, std::int64_t owner,
                   std::map<std::string, std::int64_t>& sets) {
    constexpr std::int64_t kText = 1, kWhole = 2, kNumber = 3, kSet = 7;
    const auto [set, name] = split_set(full_name);
    std::int64_t parent = 0;
    if (!set.empty()) {
      const auto [known, is_new] = sets.try_emplace(set, generic_);
      parent = known->second;
      if (is_new)
        generics_.add({{"id", generic_++},
                       {"root_genattrib_id", parent},
                       {"attrname", set},
                       {"datatype", kSet},
                       {"cityobject_id", owner}});
    }
    const std::int64_t id = generic_++;
    std::vector<Cell> row{{"id", id}};
    if (parent) row.push_back({"parent_genattrib_id", parent});
    row.push_back({"root_genattrib_id", parent ? parent : id});
    row.push_back({"attrname", name});
    const auto* const whole = std::get_if<std::int64_t>(&value);
    const auto* const number = std::get_if<double>(&value);
    constexpr std::int64_t kMaxInteger = 0x7FFFFFFF;
    if (whole && *whole <= kMaxInteger && *whole >= -kMaxInteger) {
      row.push_back({"datatype", kWhole});
      row.push_back({"intval", *whole});
    } else if (number || whole) {
      row.push_back({"datatype", kNumber});
      row.push_back({"realval", number ? *number : static_cast<double>(*whole)});
    } else {
      row.push_back({"datatype", kText});
      row.push_back({"strval", text_of(value)});
    }
    row.push_back({"cityobject_id", owner});
    generics_.add(row);
  }

  void add_address(const Address& address, std::int64_t building) {
    const std::int64_t id = address_++;
    const auto text = [](const std::string& part) {
      return part.empty() ? std::nullopt : std::optional(part);
    };
    addresses_.add({{"id", id},
                    {"gmlid", generated_id("address " + std::to_string(id))},
                    {"street", text(address.street)},
                    {"house_number", text(address.house_number)},
                    {"po_box", text(address.po_box)},
                    {"zip_code", text(address.zip_code)},
                    {"city", text(address.city)},
                    {"state", text(address.state)},
                    {"country", text(address.country)}});
    address_links_.add({{"building_id", building}, {"address_id", id}});
  }

  std::string in_schema(const char* table) const {
    return identifier(options_.schema.name) + "." + table;
  }

  Database& database_;
  const LoadOptions& options_;
  LoadReport& report_;
  std::int64_t cityobject_ = 1, surface_ = 1, generic_ = 1, address_ = 1;  ///< next ids
  std::vector<std::vector<Cell>> copies_{};  ///< of shared polygons, still without ids
  CopyTable cityobjects_{in_schema("cityobject"),
                         {"id", "objectclass_id", "gmlid", "name", "description", "envelope",
                          "creation_date", "termination_date", "relative_to_terrain",
                          "relative_to_water", "last_modification_date", "updating_person"}};
  CopyTable surfaces_{in_schema("surface_geometry"),
                      {"id", "gmlid", "parent_id", "root_id", "is_solid", "is_composite",
                       "is_triangulated", "is_xlink", "is_reverse", "geometry", "cityobject_id"}};
  CopyTable buildings_{in_schema("building"),
                       {"id",
                        "objectclass_id",
                        "building_parent_id",
                        "building_root_id",
                        "class",
                        "function",
                        "usage",
                        "year_of_construction",
                        "year_of_demolition",
                        "roof_type",
                        "measured_height",
                        "measured_height_unit",
                        "storeys_above_ground",
                        "storeys_below_ground",
                        "storey_heights_above_ground",
                        "storey_heights_ag_unit",
                        "storey_heights_below_ground",
                        "storey_heights_bg_unit",
                        "lod0_footprint_id",
                        "lod0_roofprint_id",
                        "lod1_multi_surface_id",
                        "lod2_multi_surface_id",
                        "lod3_multi_surface_id",
                        "lod4_multi_surface_id",
                        "lod1_solid_id",
                        "lod2_solid_id",
                        "lod3_solid_id",
                        "lod4_solid_id"}};
  CopyTable installations_{in_schema("building_installation"),
                           {"id", "objectclass_id", "class", "function", "usage", "building_id",
                            "lod2_brep_id", "lod3_brep_id", "lod4_brep_id"}};
  CopyTable thematic_{in_schema("thematic_surface"),
                      {"id", "objectclass_id", "building_id", "building_installation_id",
                       "lod2_multi_surface_id", "lod3_multi_surface_id", "lod4_multi_surface_id"}};
  CopyTable openings_{in_schema("opening"),
                      {"id", "objectclass_id", "lod3_multi_surface_id", "lod4_multi_surface_id"}};
  CopyTable fillings_{in_schema("opening_to_them_surface"), {"opening_id", "thematic_surface_id"}};
  CopyTable addresses_{
      in_schema("address"),
      {"id", "gmlid", "street", "house_number", "po_box", "zip_code", "city", "state", "country"}};
  CopyTable address_links_{in_schema("address_to_building"), {"building_id", "address_id"}};
  CopyTable generics_{in_schema("cityobject_genericattrib"),
                      {"id", "parent_genattrib_id", "root_genattrib_id", "attrname", "datatype",
                       "strval", "intval", "realval", "cityobject_id"}};
};

}  // namespace

Result<std::unique_ptr<Store>> open_store_v4(Database& database, const LoadOptions& options,
                                             LoadReport& report) {
  auto store = std::make_unique<StoreV4>(database, options, report);
  if (auto found = store->find_ids(); !found) return found.error();
  return std::unique_ptr<Store>(std::move(store));
}

}  // namespace citymesh::citydb_support
