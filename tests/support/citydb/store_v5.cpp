#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "tests/support/citydb/copy_table.h"
#include "tests/support/citydb/geometry_properties.h"
#include "tests/support/citydb/names_v5.h"
#include "tests/support/citydb/store.h"

namespace citymesh::citydb_support {
namespace {

using source::PolygonUse;
using source::RawObject;
using source::RawShape;

class StoreV5 final : public Store {
 public:
  StoreV5(Database& database, const LoadOptions& options, LoadReport& report)
      : database_(database), options_(options), report_(report) {}

  Result<void> find_ids() {
    for (const auto& [table, id] :
         {std::pair(&features_, &feature_), std::pair(&properties_, &property_),
          std::pair(&geometries_, &geometry_), std::pair(&addresses_, &address_)}) {
      const auto next = table->next_id(database_);
      if (!next) return next.error();
      *id = *next;
    }
    return {};
  }

  void add(const StoredFeature& feature) override {
    std::vector<std::int64_t> ids(feature.objects().size());
    for (std::int64_t& id : ids) id = feature_++;
    Box3 all;
    for (std::size_t i = ids.size(); i-- > 1;) add_object(feature, i, ids, all);
    add_object(feature, 0, ids, all);
  }

  std::size_t bytes() const override {
    return features_.bytes() + properties_.bytes() + geometries_.bytes() + addresses_.bytes();
  }

  Result<void> flush() override {
    for (CopyTable* table : {&features_, &geometries_, &addresses_, &properties_})
      if (auto flushed = table->flush(database_); !flushed) return flushed;
    return {};
  }

 private:
  // `all` is the extent of the building with everything that belongs to it.
  void add_object(const StoredFeature& feature, std::size_t index,
                  const std::vector<std::int64_t>& ids, Box3& all) {
    const RawObject& object = feature.objects()[index];
    const std::int64_t id = ids[index];
    std::string created = options_.creation_date;
    std::optional<std::string> terminated;
    add_attributes(object, id, created, terminated);
    Box3 box;
    add_geometries(feature, object, id, box);
    add_surfaces(feature, index, id, box);
    for (std::size_t child = index + 1; child < ids.size(); ++child) {
      const RawObject& member = feature.objects()[child];
      if (member.parent != static_cast<std::int32_t>(index)) continue;
      const bool installation = member.kind == ObjectKind::BuildingInstallation;
      relate(id, {installation ? "buildingInstallation" : "buildingPart", kBldg}, ids[child]);
    }
    for (const Address& address : object.addresses) add_address(address, id);
    all.add(box);
    add_feature(id, class_v5(object.kind),
                feature.id(object.gml_id, " object " + std::to_string(index)),
                index == 0 ? all : box, created, terminated);
  }

  void add_feature(std::int64_t id, int object_class, const std::string& object_id, const Box3& box,
                   const std::string& created, const std::optional<std::string>& terminated) {
    features_.add(
        {{"id", id},
         {"objectclass_id", std::int64_t{object_class}},
         {"objectid", object_id},
         {"envelope",
          box.is_empty() ? std::nullopt : std::optional(envelope_ewkb(box, options_.schema.srid))},
         {"last_modification_date", options_.creation_date},
         {"updating_person", "importer"},
         {"creation_date", created},
         {"termination_date", terminated}});
  }

  /// A row of property; `values` are what it holds.
  std::int64_t add_property(std::int64_t owner, PropertyName name, DataType type,
                            std::vector<Cell> values, std::int64_t parent = 0) {
    const std::int64_t id = property_++;
    std::vector<Cell> row{{"id", id}, {"feature_id", owner}};
    if (parent) row.push_back({"parent_id", parent});
    row.push_back({"datatype_id", std::int64_t{type}});
    row.push_back({"namespace_id", std::int64_t{name.space}});
    row.push_back({"name", std::string(name.name)});
    for (Cell& value : values) row.push_back(std::move(value));
    properties_.add(row);
    return id;
  }

  void relate(std::int64_t owner, PropertyName name, std::int64_t member) {
    constexpr std::int64_t kContains = 1;
    add_property(owner, name, kFeature,
                 {{"val_feature_id", member}, {"val_relation_type", kContains}});
  }

  // ---- geometry ----------------------------------------------------------------------------

  void add_geometries(const StoredFeature& feature, const RawObject& object, std::int64_t owner,
                      Box3& box) {
    std::vector<std::string_view> taken;
    for (const RawShape& shape : object.shapes) {
      if (shape.assembled) continue;
      PropertyName name = geometry_name(object, shape, feature.citygml3());
      const auto is_taken = [&] {
        return std::find(taken.begin(), taken.end(), name.name) != taken.end();
      };
      if (shape.lod.major == 0 && is_taken() && object.kind != ObjectKind::BuildingInstallation)
        name = {"lod0RoofEdge", kDepr};
      if (name.name.empty() || is_taken()) {
        ++report_.dropped_geometries;
        continue;
      }
      taken.push_back(name.name);
      add_geometry(feature, owner, name, shape, box);
    }
  }

  /// Faces that can be stored, with their ids.
  struct Faces {
    std::vector<Rings> rings{};
    std::vector<PolygonUse> uses{};
  };
  static Faces faces_of(const StoredFeature& feature, const std::vector<PolygonUse>& uses,
                        Box3& box) {
    Faces faces;
    for (const PolygonUse& use : uses)
      if (auto rings = feature.rings(use, box)) {
        faces.rings.push_back(std::move(*rings));
        faces.uses.push_back(use);
      }
    return faces;
  }

  static void append(const StoredFeature& feature, const Faces& faces, Ewkb::Type type, int parent,
                     Ewkb& wkb, GeometryProperties& properties) {
    wkb.collection(type, faces.rings.size());
    for (const Rings& rings : faces.rings) wkb.polygon(rings);
    for (const PolygonUse& use : faces.uses)
      properties.add_polygon(feature.polygon_id(use.polygon), parent, use.reversed);
  }

  std::string part_id(int part) const {
    return generated_id("geometry_data " + std::to_string(geometry_) + " " + std::to_string(part));
  }

  void add_geometry(const StoredFeature& feature, std::int64_t owner, PropertyName name,
                    const RawShape& shape, Box3& box) {
    using Properties = GeometryProperties;
    Ewkb wkb(options_.schema.srid);
    const bool surfaces = shape.solids.empty();
    Properties properties(surfaces ? shape.type == GeometryType::CompositeSurface
                                         ? Properties::CompositeSurface
                                         : Properties::MultiSurface
                          : shape.type == GeometryType::Solid          ? Properties::Solid
                          : shape.type == GeometryType::CompositeSolid ? Properties::CompositeSolid
                                                                       : Properties::MultiSolid,
                          part_id(0));
    if (surfaces) {
      append(feature, faces_of(feature, shape.uses, box), Ewkb::Type::MultiPolygon,
             Properties::kRoot, wkb, properties);
    } else {
      int parts = 0;
      const bool one = shape.type == GeometryType::Solid;
      if (!one) wkb.collection(Ewkb::Type::GeometryCollection, shape.solids.size());
      for (const Solid& solid : shape.solids) {
        const int member =
            one ? Properties::kRoot
                : properties.add(Properties::Solid, part_id(++parts), Properties::kRoot);
        const int shell = properties.add(Properties::CompositeSurface, part_id(++parts), member);
        std::vector<PolygonUse> uses;
        uses.reserve(solid.exterior.size());
        for (const std::uint32_t use : solid.exterior) uses.push_back(shape.uses[use]);
        append(feature, faces_of(feature, uses, box), Ewkb::Type::PolyhedralSurface, shell, wkb,
               properties);
        report_.dropped_cavities += solid.interiors.size();
        if (one) break;
      }
    }
    add_geometry_row(owner, name, shape.lod.major, wkb.take(), properties.text());
  }

  void add_geometry_row(std::int64_t owner, PropertyName name, int lod, std::string wkb,
                        std::string properties) {
    add_property(owner, name, kGeometry,
                 {{"val_lod", std::to_string(lod)}, {"val_geometry_id", geometry_}});
    geometries_.add({{"id", geometry_++},
                     {"geometry", std::move(wkb)},
                     {"geometry_properties", std::move(properties)},
                     {"feature_id", owner}});
  }

  // ---- boundary surfaces -------------------------------------------------------------------

  void add_surfaces(const StoredFeature& feature, std::size_t index, std::int64_t owner,
                    Box3& all) {
    const RawObject& object = feature.objects()[index];
    const std::size_t count = object.surfaces.size();
    std::vector<std::int64_t> ids(count);
    std::vector<Box3> boxes(count);
    for (std::int64_t& id : ids) id = feature_++;
    const auto has_class = [&](std::size_t s) { return class_v5(object.surfaces[s].type) != 0; };
    const auto is_storable = [&](std::size_t s) {
      const std::int32_t outer = object.surfaces[s].parent;
      return has_class(s) && (outer < 0 || has_class(static_cast<std::size_t>(outer)));
    };

    for (const auto& geometry : feature.surface_geometries(index)) {
      const std::size_t s = geometry.surface;
      const PropertyName name = surface_geometry_name(geometry.lod);
      if (!is_storable(s) || name.name.empty()) {
        ++report_.dropped_geometries;
        continue;
      }
      const RawShape shape{.type = GeometryType::MultiSurface,
                           .lod = {static_cast<std::int8_t>(geometry.lod)},
                           .uses = geometry.uses};
      add_geometry(feature, ids[s], name, shape, boxes[s]);
    }
    for (std::size_t s = 0; s < count; ++s) {
      const Surface& surface = object.surfaces[s];
      if (!is_storable(s)) {
        ++report_.dropped_surfaces;
        continue;
      }
      all.add(boxes[s]);
      add_feature(
          ids[s], class_v5(surface.type),
          feature.id(surface.gml_id, " surface " + std::to_string(index) + "." + std::to_string(s)),
          boxes[s], options_.creation_date, std::nullopt);
      if (surface.parent < 0)
        relate(owner, {"boundary", kCore}, ids[s]);
      else
        relate(ids[static_cast<std::size_t>(surface.parent)], {"fillingSurface", kCon}, ids[s]);
    }
  }

  // ---- attributes --------------------------------------------------------------------------

  void add_attributes(const RawObject& object, std::int64_t owner, std::string& created,
                      std::optional<std::string>& terminated) {
    std::map<std::string, std::int64_t> sets;
    for (const auto& [name, value] : object.attributes) {
      if (name == "creationDate" || name == "terminationDate") {
        if (auto date = timestamp_from(text_of(value))) {
          if (name == "creationDate")
            created = *date;
          else
            terminated = *date;
          continue;
        }
      }
      const KnownAttribute* const known = known_attribute(name);
      if (known && add_known(*known, value, owner)) continue;
      add_generic(name, value, owner, sets);
    }
  }

  bool add_known(const KnownAttribute& known, const AttributeValue& value, std::int64_t owner) {
    switch (known.type) {
      case kCode:
        for (const std::string& code : split_values(text_of(value)))
          add_property(owner, known.property, kCode, {{"val_string", code}});
        return true;
      case kInteger: {
        const auto* const whole = std::get_if<std::int64_t>(&value);
        if (whole) add_property(owner, known.property, kInteger, {{"val_int", *whole}});
        return whole != nullptr;
      }
      case kMeasureList:
        add_property(owner, known.property, kMeasureList,
                     {{"val_uom", "m"}, {"val_array", json_list(text_of(value))}});
        return true;
      case kTimestamp: {
        auto day = timestamp_from(text_of(value));
        if (!day) day = new_year_of(value);
        if (day) add_property(owner, known.property, kTimestamp, {{"val_timestamp", *day}});
        return day.has_value();
      }
      case kHeight:
        return add_height(value, owner);
      default:
        add_property(owner, known.property, known.type, {{"val_string", text_of(value)}});
        return true;
    }
  }

  bool add_height(const AttributeValue& value, std::int64_t owner) {
    const auto* const number = std::get_if<double>(&value);
    const auto* const whole = std::get_if<std::int64_t>(&value);
    if (!number && !whole) return false;
    const std::int64_t height = add_property(owner, {"height", kCon}, kHeight, {});
    add_property(owner, {"value", kCon}, kMeasure,
                 {{"val_double", number ? *number : static_cast<double>(*whole)}, {"val_uom", "m"}},
                 height);
    add_property(owner, {"status", kCon}, kString, {{"val_string", "measured"}}, height);
    add_property(owner, {"lowReference", kCon}, kCode, {{"val_string", "lowestGroundPoint"}},
                 height);
    add_property(owner, {"highReference", kCon}, kCode, {{"val_string", "highestRoofEdge"}},
                 height);
    return true;
  }

  void add_generic(const std::string& full_name, const AttributeValue& value, std::int64_t owner,
                   std::map<std::string, std::int64_t>& sets) {
    const auto [set, name] = split_set(full_name);
    std::int64_t parent = 0;
    if (!set.empty()) {
      std::int64_t& known = sets[set];
      if (known == 0) known = add_property(owner, {set, kGen}, kGenericSet, {});
      parent = known;
    }
    const PropertyName property{name, kGen};
    if (const auto* const whole = std::get_if<std::int64_t>(&value))
      add_property(owner, property, kInteger, {{"val_int", *whole}}, parent);
    else if (const auto* const number = std::get_if<double>(&value))
      add_property(owner, property, kDouble, {{"val_double", *number}}, parent);
    else
      add_property(owner, property, kString, {{"val_string", text_of(value)}}, parent);
  }

  void add_address(const Address& address, std::int64_t owner) {
    const auto text = [](const std::string& part) {
      return part.empty() ? std::nullopt : std::optional(part);
    };
    add_property(owner, {"address", kBldg}, kAddress, {{"val_address_id", address_}});
    addresses_.add({{"id", address_},
                    {"objectid", generated_id("address " + std::to_string(address_))},
                    {"street", text(address.street)},
                    {"house_number", text(address.house_number)},
                    {"po_box", text(address.po_box)},
                    {"zip_code", text(address.zip_code)},
                    {"city", text(address.city)},
                    {"state", text(address.state)},
                    {"country", text(address.country)}});
    ++address_;
  }

  std::string in_schema(const char* table) const {
    return identifier(options_.schema.name) + "." + table;
  }

  Database& database_;
  const LoadOptions& options_;
  LoadReport& report_;
  std::int64_t feature_ = 1, property_ = 1, geometry_ = 1, address_ = 1;  ///< next ids
  CopyTable features_{in_schema("feature"),
                      {"id", "objectclass_id", "objectid", "envelope", "last_modification_date",
                       "updating_person", "creation_date", "termination_date"}};
  CopyTable geometries_{in_schema("geometry_data"),
                        {"id", "geometry", "geometry_properties", "feature_id"}};
  CopyTable properties_{
      in_schema("property"),
      {"id", "feature_id", "parent_id", "datatype_id", "namespace_id", "name", "val_int",
       "val_double", "val_string", "val_timestamp", "val_uom", "val_array", "val_lod",
       "val_geometry_id", "val_address_id", "val_feature_id", "val_relation_type"}};
  CopyTable addresses_{in_schema("address"),
                       {"id", "objectid", "street", "house_number", "po_box", "zip_code", "city",
                        "state", "country"}};
};

}  // namespace

Result<std::unique_ptr<Store>> open_store_v5(Database& database, const LoadOptions& options,
                                             LoadReport& report) {
  auto store = std::make_unique<StoreV5>(database, options, report);
  if (auto found = store->find_ids(); !found) return found.error();
  return std::unique_ptr<Store>(std::move(store));
}

}  // namespace citymesh::citydb_support
