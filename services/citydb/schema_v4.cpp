#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/placement.h"
#include "services/citydb/schema.h"
#include "services/citydb/surface_tree.h"

/// 3DCityDB 4: a table per class, all with the id of their row in cityobject.
namespace citymesh::citydb {
namespace {

using postgres::Rows;
using postgres::Statement;

// Envelopes are rings of three dimensions: their corners are read as numbers.
constexpr const char* kInBox =
    "SELECT c.id, c.gmlid, ST_XMin(c.envelope), ST_YMin(c.envelope), ST_ZMin(c.envelope),"
    " ST_XMax(c.envelope), ST_YMax(c.envelope), ST_ZMax(c.envelope)"
    " FROM cityobject c WHERE c.objectclass_id = ANY($1::int[]) AND c.termination_date IS NULL"
    " AND c.envelope && ST_MakeEnvelope($2::float8, $3::float8, $4::float8, $5::float8, $6::int)"
    " ORDER BY c.id";
constexpr const char* kAll =
    "SELECT c.id, c.gmlid, ST_XMin(c.envelope), ST_YMin(c.envelope), ST_ZMin(c.envelope),"
    " ST_XMax(c.envelope), ST_YMax(c.envelope), ST_ZMax(c.envelope)"
    " FROM cityobject c WHERE c.objectclass_id = ANY($1::int[]) AND c.termination_date IS NULL"
    " ORDER BY c.id";
constexpr const char* kExtent =
    "SELECT e.n, ST_XMin(e.b), ST_YMin(e.b), ST_ZMin(e.b), ST_XMax(e.b), ST_YMax(e.b), ST_ZMax(e.b)"
    " FROM (SELECT count(*) AS n, ST_3DExtent(c.envelope) AS b FROM cityobject c"
    " WHERE c.objectclass_id = ANY($1::int[]) AND c.termination_date IS NULL) e";
// A GiST index has to be read from end to end for what has no box: the statistics decide whether.
constexpr const char* kWithoutEnvelope =
    "SELECT count(*) FROM cityobject c WHERE c.objectclass_id = ANY($1::int[])"
    " AND c.termination_date IS NULL AND c.envelope IS NULL"
    " AND coalesce((SELECT max(s.null_frac) > 0 FROM pg_stats s WHERE s.attname = 'envelope'"
    " AND s.tablename = 'cityobject' AND s.schemaname = current_schema()), true)";
constexpr const char* kById =
    "SELECT c.id, c.gmlid, ST_XMin(c.envelope), ST_YMin(c.envelope), ST_ZMin(c.envelope),"
    " ST_XMax(c.envelope), ST_YMax(c.envelope), ST_ZMax(c.envelope)"
    " FROM cityobject c WHERE c.objectclass_id = ANY($1::int[]) AND c.termination_date IS NULL"
    " AND c.id IN (SELECT b.building_root_id FROM cityobject p JOIN building b ON b.id = p.id"
    " WHERE p.gmlid = ANY($2::text[]) AND p.termination_date IS NULL"
    " UNION SELECT b.building_root_id FROM cityobject p JOIN building_installation i ON i.id = p.id"
    " JOIN building b ON b.id = i.building_id"
    " WHERE p.gmlid = ANY($2::text[]) AND p.termination_date IS NULL) ORDER BY c.id";
constexpr const char* kMembers =
    "SELECT b.building_root_id, c.gmlid, c.id FROM building b JOIN cityobject c ON c.id = b.id"
    " WHERE b.building_root_id = ANY($1::bigint[]) AND b.id <> b.building_root_id"
    " AND c.termination_date IS NULL"
    " UNION ALL SELECT b.building_root_id, c.gmlid, c.id FROM building b"
    " JOIN building_installation i ON i.building_id = b.id JOIN cityobject c ON c.id = i.id"
    " WHERE b.building_root_id = ANY($1::bigint[]) AND i.objectclass_id = ANY($2::int[])"
    " AND c.termination_date IS NULL ORDER BY 1, 3";

constexpr const char* kBuildings =
    "SELECT b.building_root_id, b.id, coalesce(b.building_parent_id, 0), b.objectclass_id, c.gmlid,"
    " c.description, c.name, to_char(c.creation_date AT TIME ZONE 'UTC', 'YYYY-MM-DD'), "
    "c.relative_to_terrain,"
    " c.relative_to_water, b.class, b.function, b.usage,"
    " extract(year FROM b.year_of_construction)::bigint,"
    " extract(year FROM b.year_of_demolition)::bigint, b.roof_type, b.measured_height,"
    " b.storeys_above_ground::bigint, b.storeys_below_ground::bigint,"
    " b.storey_heights_above_ground, b.storey_heights_below_ground,"
    " b.lod0_footprint_id, b.lod0_roofprint_id, b.lod1_multi_surface_id, b.lod2_multi_surface_id,"
    " b.lod3_multi_surface_id, b.lod4_multi_surface_id, b.lod1_solid_id, b.lod2_solid_id,"
    " b.lod3_solid_id, b.lod4_solid_id"
    " FROM building b JOIN cityobject c ON c.id = b.id"
    " WHERE b.building_root_id = ANY($1::bigint[]) AND c.termination_date IS NULL"
    " ORDER BY b.building_root_id, b.id";
enum BuildingColumn {
  kRoot,
  kId,
  kParent,
  kClass,
  kGmlId,
  kDescription,                   // and the others of kObjectNames
  kClassCode = kDescription + 5,  // and the others of kCodeNames
  kConstruction = kClassCode + 3,
  kDemolition,
  kRoofType,
  kHeight,
  kStoreysAbove,
  kStoreysBelow,
  kHeightsAbove,
  kHeightsBelow,
  kFootprint,
  kRoofprint,
  kMultiSurface1,
  kSolid1 = kMultiSurface1 + 4
};

constexpr const char* kInstallations =
    "SELECT b.building_root_id, i.id, i.building_id, i.objectclass_id, c.gmlid, i.class, "
    "i.function,"
    " i.usage, i.lod2_brep_id, i.lod3_brep_id, i.lod4_brep_id,"
    " g2.relative_brep_id, i.lod2_implicit_ref_point, i.lod2_implicit_transformation,"
    " g3.relative_brep_id, i.lod3_implicit_ref_point, i.lod3_implicit_transformation,"
    " g4.relative_brep_id, i.lod4_implicit_ref_point, i.lod4_implicit_transformation,"
    " c.description, c.name, to_char(c.creation_date AT TIME ZONE 'UTC', 'YYYY-MM-DD'), "
    "c.relative_to_terrain,"
    " c.relative_to_water"
    " FROM building b JOIN building_installation i ON i.building_id = b.id"
    " JOIN cityobject c ON c.id = i.id"
    " LEFT JOIN implicit_geometry g2 ON g2.id = i.lod2_implicit_rep_id"
    " LEFT JOIN implicit_geometry g3 ON g3.id = i.lod3_implicit_rep_id"
    " LEFT JOIN implicit_geometry g4 ON g4.id = i.lod4_implicit_rep_id"
    " WHERE b.building_root_id = ANY($1::bigint[]) AND i.objectclass_id = ANY($2::int[])"
    " AND c.termination_date IS NULL ORDER BY b.building_root_id, i.id";
enum InstallationColumn {
  kOwner = 2,
  kInstallationCodes = 5,
  kBrep2 = 8,
  kImplicit2 = 11,
  kInstallationDescription = 20
};

constexpr const char* kSurfaces =
    "SELECT b.building_root_id, t.id, t.building_id, t.objectclass_id, c.gmlid,"
    " t.lod2_multi_surface_id, t.lod3_multi_surface_id, t.lod4_multi_surface_id"
    " FROM building b JOIN thematic_surface t ON t.building_id = b.id"
    " JOIN cityobject c ON c.id = t.id WHERE b.building_root_id = ANY($1::bigint[])"
    " UNION ALL SELECT b.building_root_id, t.id, t.building_installation_id, t.objectclass_id,"
    " c.gmlid, t.lod2_multi_surface_id, t.lod3_multi_surface_id, t.lod4_multi_surface_id"
    " FROM building b JOIN building_installation i ON i.building_id = b.id"
    " JOIN thematic_surface t ON t.building_installation_id = i.id"
    " JOIN cityobject c ON c.id = t.id WHERE b.building_root_id = ANY($1::bigint[])"
    " ORDER BY 1, 2";
enum SurfaceColumn { kLod2Surface = 5 };

constexpr const char* kOpenings =
    "SELECT b.building_root_id, o.id, t.id, o.objectclass_id, c.gmlid, o.lod3_multi_surface_id,"
    " o.lod4_multi_surface_id, g3.relative_brep_id, o.lod3_implicit_ref_point,"
    " o.lod3_implicit_transformation, g4.relative_brep_id, o.lod4_implicit_ref_point,"
    " o.lod4_implicit_transformation"
    " FROM building b JOIN thematic_surface t ON t.building_id = b.id"
    " JOIN opening_to_them_surface x ON x.thematic_surface_id = t.id"
    " JOIN opening o ON o.id = x.opening_id JOIN cityobject c ON c.id = o.id"
    " LEFT JOIN implicit_geometry g3 ON g3.id = o.lod3_implicit_rep_id"
    " LEFT JOIN implicit_geometry g4 ON g4.id = o.lod4_implicit_rep_id"
    " WHERE b.building_root_id = ANY($1::bigint[]) ORDER BY 1, 3, 2";
enum OpeningColumn { kWall = 2, kLod3Opening = 5, kImplicit3 = 7 };

constexpr const char* kAddresses =
    "SELECT b.building_root_id, b.id, a.street, a.house_number, a.po_box, a.zip_code, a.city,"
    " a.state, a.country FROM building b JOIN address_to_building x ON x.building_id = b.id"
    " JOIN address a ON a.id = x.address_id WHERE b.building_root_id = ANY($1::bigint[])"
    " ORDER BY 1, 2, a.id";
enum AddressColumn { kStreet = 2 };

constexpr const char* kGenerics =
    "SELECT b.building_root_id, g.cityobject_id, g.id, coalesce(g.parent_genattrib_id, 0),"
    " g.attrname, g.datatype::bigint, g.strval, g.intval::bigint, g.realval, g.urival,"
    " to_char(g.dateval AT TIME ZONE 'UTC', 'YYYY-MM-DD')"
    " FROM building b JOIN cityobject_genericattrib g ON g.cityobject_id = b.id"
    " WHERE b.building_root_id = ANY($1::bigint[])"
    " UNION ALL SELECT b.building_root_id, g.cityobject_id, g.id,"
    " coalesce(g.parent_genattrib_id, 0), g.attrname, g.datatype::bigint, g.strval,"
    " g.intval::bigint, g.realval, g.urival, to_char(g.dateval AT TIME ZONE 'UTC', 'YYYY-MM-DD')"
    " FROM building b JOIN building_installation i ON i.building_id = b.id"
    " JOIN cityobject_genericattrib g ON g.cityobject_id = i.id"
    " WHERE b.building_root_id = ANY($1::bigint[]) ORDER BY 1, 2, 3";
enum GenericColumn {
  kObject = 1,
  kGeneric = 2,
  kSet = 3,
  kAttribute = 4,
  kType = 5,
  kText = 6,
  kWhole = 7,
  kReal = 8,
  kUri = 9,
  kDate = 10
};

constexpr const char* kGeometry =
    "SELECT s.root_id, s.id, s.parent_id, s.gmlid, s.is_solid::int, s.is_composite::int,"
    " s.is_triangulated::int, coalesce(s.geometry, s.implicit_geometry)"
    " FROM surface_geometry s WHERE s.root_id = ANY($1::bigint[]) ORDER BY s.root_id, s.id";

constexpr std::array<std::string_view, 5> kObjectNames{"description", "name", "creationDate",
                                                       "relativeToTerrain", "relativeToWater"};
constexpr std::array<std::string_view, 3> kCodeNames{"class", "function", "usage"};

// The order of Tables::rows.
enum Table {
  kOfBuildings,
  kOfInstallations,
  kOfSurfaces,
  kOfOpenings,
  kOfAddresses,
  kOfGenerics,
  kOfGeometry
};

/// Where the rows of one building stand among those of the chunk; moves on from building to
/// building.
class Cursor {
 public:
  explicit Cursor(const Rows& rows) : rows_(&rows) {}
  /// The rows whose first column is `root`.
  std::pair<int, int> of(std::int64_t root) {
    while (next_ < rows_->size() && rows_->integer(next_, 0) < root) ++next_;
    const int first = next_;
    while (next_ < rows_->size() && rows_->integer(next_, 0) == root) ++next_;
    return {first, next_};
  }

 private:
  const Rows* rows_;
  int next_ = 0;
};

void add_root(const Rows& rows, int row, int column, std::set<std::int64_t>& roots) {
  if (!rows.null(row, column)) roots.insert(rows.integer(row, column));
}

/// Every geometry that the other tables lead to.
std::vector<std::int64_t> roots_of(const std::vector<Rows>& rows) {
  std::set<std::int64_t> roots;
  const auto add = [&](Table table, std::initializer_list<int> columns) {
    const auto& of = rows[table];
    for (int row = 0; row < of.size(); ++row)
      for (const int column : columns) add_root(of, row, column, roots);
  };
  add(kOfBuildings, {kFootprint, kRoofprint, kMultiSurface1, kMultiSurface1 + 1, kMultiSurface1 + 2,
                     kMultiSurface1 + 3, kSolid1, kSolid1 + 1, kSolid1 + 2, kSolid1 + 3});
  add(kOfInstallations,
      {kBrep2, kBrep2 + 1, kBrep2 + 2, kImplicit2, kImplicit2 + 3, kImplicit2 + 6});
  add(kOfSurfaces, {kLod2Surface, kLod2Surface + 1, kLod2Surface + 2});
  add(kOfOpenings, {kLod3Opening, kLod3Opening + 1, kImplicit3, kImplicit3 + 3});
  return {roots.begin(), roots.end()};
}

Lod lod(int major) { return {static_cast<std::int8_t>(major)}; }

/// Builds the buildings of one chunk.
class Builder {
 public:
  Builder(const Tables& tables, const Instance& instance, const SurfaceTrees& trees,
          FeatureBuilder& builder)
      : rows_(tables.rows),
        instance_(instance),
        trees_(trees),
        builder_(builder),
        buildings_(rows_[kOfBuildings]),
        installations_(rows_[kOfInstallations]),
        surfaces_(rows_[kOfSurfaces]),
        openings_(rows_[kOfOpenings]),
        addresses_(rows_[kOfAddresses]),
        generics_(rows_[kOfGenerics]) {}

  /// False when there is no such building.
  bool build(std::int64_t root) {
    builder_.start();
    objects_.clear();
    walls_.clear();
    add_buildings(root);
    const bool found = !objects_.empty();
    add_installations(root);
    add_surfaces(root);
    add_openings(root);
    add_addresses(root);
    add_generics(root);
    return found;
  }

 private:
  const ObjectClass* class_of(const Rows& rows, int row) const {
    const auto known = instance_.classes.find(rows.integer(row, kClass));
    return known == instance_.classes.end() ? nullptr : &known->second;
  }

  std::int32_t object_of(const Rows& rows, int row, int column) const {
    const auto known = objects_.find(rows.integer(row, column));
    return known == objects_.end() ? -1 : known->second;
  }

  /// The building first, then its parts, whatever their ids: a part may stand before the part that
  /// it belongs to.
  void add_buildings(std::int64_t root) {
    const auto [first, last] = buildings_.of(root);
    const auto& rows = rows_[kOfBuildings];
    std::vector<int> waiting;
    for (int row = first; row < last; ++row) waiting.push_back(row);
    for (bool moved = true; moved && !waiting.empty();) {
      moved = false;
      for (auto row = waiting.begin(); row != waiting.end();) {
        const bool top = rows.integer(*row, kId) == root;
        const auto parent = object_of(rows, *row, kParent);
        if (!top && parent < 0) {
          ++row;
          continue;
        }
        add_building(rows, *row, top ? -1 : parent);
        row = waiting.erase(row);
        moved = true;
      }
    }
  }

  void add_building(const Rows& rows, int row, std::int32_t parent) {
    const auto object =
        builder_.add_object(parent < 0 ? ObjectKind::Building : ObjectKind::BuildingPart,
                            rows.text(row, kGmlId), parent);
    objects_.emplace(rows.integer(row, kId), object);
    add_attributes(rows, row, builder_.object(object).attributes);
    const FeatureBuilder::Owner owner{object, -1};
    const auto geometry = [&](int column, int major, bool footprint) {
      if (!rows.null(row, column))
        add_geometry(rows.integer(row, column), owner, lod(major), footprint);
    };
    geometry(kFootprint, 0, true);
    geometry(kRoofprint, 0, true);
    for (int level = 1; level <= 4; ++level) {
      geometry(kSolid1 + level - 1, level, false);
      geometry(kMultiSurface1 + level - 1, level, false);
    }
  }

  void add_geometry(std::int64_t root, FeatureBuilder::Owner owner, Lod level, bool footprint) {
    if (!trees_.add(root, owner, level, footprint, nullptr, builder_))
      builder_.report(owner.object, issue_code::kUnreadableGeometry,
                      fmt::format("surface_geometry has nothing for root {}", root));
  }

  /// Columns one after another.
  static void add_texts(const Rows& rows, int row, int first,
                        std::span<const std::string_view> names, Attributes& attributes) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const auto text = rows.text(row, first + static_cast<int>(i)); !text.empty())
        add_attribute(attributes, names[i], joined_codes(text));
  }

  static void add_attributes(const Rows& rows, int row, Attributes& attributes) {
    const auto text = [&](int column, std::string_view name) {
      if (!rows.null(row, column) && !rows.text(row, column).empty())
        add_attribute(attributes, name, joined_codes(rows.text(row, column)));
    };
    const auto whole = [&](int column, std::string_view name) {
      if (!rows.null(row, column)) add_attribute(attributes, name, rows.integer(row, column));
    };
    add_texts(rows, row, kDescription, kObjectNames, attributes);
    add_texts(rows, row, kClassCode, kCodeNames, attributes);
    whole(kConstruction, "yearOfConstruction");
    whole(kDemolition, "yearOfDemolition");
    text(kRoofType, "roofType");
    if (!rows.null(row, kHeight))
      add_attribute(attributes, "measuredHeight", rows.number(row, kHeight));
    whole(kStoreysAbove, "storeysAboveGround");
    whole(kStoreysBelow, "storeysBelowGround");
    text(kHeightsAbove, "storeyHeightsAboveGround");
    text(kHeightsBelow, "storeyHeightsBelowGround");
  }

  void add_installations(std::int64_t root) {
    const auto [first, last] = installations_.of(root);
    const auto& rows = rows_[kOfInstallations];
    for (int row = first; row < last; ++row) {
      const auto parent = object_of(rows, row, kOwner);
      if (parent < 0) continue;
      const auto object =
          builder_.add_object(ObjectKind::BuildingInstallation, rows.text(row, kGmlId), parent);
      objects_.emplace(rows.integer(row, kId), object);
      auto& attributes = builder_.object(object).attributes;
      add_texts(rows, row, kInstallationDescription, kObjectNames, attributes);
      add_texts(rows, row, kInstallationCodes, kCodeNames, attributes);
      for (int i = 0; i < 3; ++i) {
        const FeatureBuilder::Owner owner{object, -1};
        if (!rows.null(row, kBrep2 + i))
          add_geometry(rows.integer(row, kBrep2 + i), owner, lod(i + 2), false);
        add_implicit(rows, row, kImplicit2 + 3 * i, owner, lod(i + 2));
      }
    }
  }

  void add_implicit(const Rows& rows, int row, int column, FeatureBuilder::Owner owner, Lod level) {
    if (rows.null(row, column)) return;
    const auto reference = point_of_ewkb(rows.text(row, column + 1));
    const auto matrix = source::matrix_from(rows.text(row, column + 2));
    source::Placement placement;
    if (reference && matrix) {
      placement.matrix = *matrix;
      placement.reference = *reference;
      if (trees_.add(rows.integer(row, column), owner, level, false, &placement, builder_)) return;
    }
    builder_.report(owner.object, issue_code::kUnreadableGeometry,
                    fmt::format("implicit geometry of LoD {}: no geometry, reference point or "
                                "transformation of 16 numbers",
                                to_string(level)));
  }

  void add_surfaces(std::int64_t root) {
    const auto [first, last] = surfaces_.of(root);
    const auto& rows = rows_[kOfSurfaces];
    for (int row = first; row < last; ++row) {
      const auto object = object_of(rows, row, kOwner);
      const auto* known = class_of(rows, row);
      if (object < 0 || known == nullptr) continue;
      if (!known->surface) {
        builder_.leave_out(object, known->name);
        continue;
      }
      const auto surface = builder_.add_surface(object, *known->surface, rows.text(row, kGmlId));
      walls_.emplace(rows.integer(row, kId), FeatureBuilder::Owner{object, surface});
      for (int i = 0; i < 3; ++i)
        if (!rows.null(row, kLod2Surface + i))
          add_geometry(rows.integer(row, kLod2Surface + i), {object, surface}, lod(i + 2), false);
    }
  }

  void add_openings(std::int64_t root) {
    const auto [first, last] = openings_.of(root);
    const auto& rows = rows_[kOfOpenings];
    for (int row = first; row < last; ++row) {
      const auto wall = walls_.find(rows.integer(row, kWall));
      const auto* known = class_of(rows, row);
      if (wall == walls_.end() || known == nullptr) continue;
      const auto [object, outer] = wall->second;
      if (!known->surface) {
        builder_.leave_out(object, known->name);
        continue;
      }
      const FeatureBuilder::Owner owner{
          object, builder_.add_surface(object, *known->surface, rows.text(row, kGmlId), outer)};
      for (int i = 0; i < 2; ++i) {
        if (!rows.null(row, kLod3Opening + i))
          add_geometry(rows.integer(row, kLod3Opening + i), owner, lod(i + 3), false);
        add_implicit(rows, row, kImplicit3 + 3 * i, owner, lod(i + 3));
      }
    }
  }

  void add_addresses(std::int64_t root) {
    const auto [first, last] = addresses_.of(root);
    const auto& rows = rows_[kOfAddresses];
    for (int row = first; row < last; ++row) {
      const auto object = object_of(rows, row, kId);
      if (object < 0) continue;
      constexpr std::array kFields{&Address::street,   &Address::house_number, &Address::po_box,
                                   &Address::zip_code, &Address::city,         &Address::state,
                                   &Address::country};
      Address address;
      for (std::size_t i = 0; i < kFields.size(); ++i)
        address.*kFields[i] = rows.text(row, kStreet + static_cast<int>(i));
      builder_.object(object).addresses.push_back(std::move(address));
    }
  }

  /// Types: 1 text, 2 whole, 3 real, 4 URI, 5 date, 6 measure, 7 set.
  void add_generics(std::int64_t root) {
    const auto [first, last] = generics_.of(root);
    const auto& rows = rows_[kOfGenerics];
    std::map<std::int64_t, std::string> names;  // of attributes that may be sets
    for (int row = first; row < last; ++row) {
      const auto object = object_of(rows, row, kObject);
      if (object < 0) continue;
      std::string name(rows.text(row, kAttribute));
      if (const auto set = names.find(rows.integer(row, kSet)); set != names.end())
        name = fmt::format("{}.{}", set->second, name);
      auto& attributes = builder_.object(object).attributes;
      switch (rows.integer(row, kType)) {
        case 2:
          add_attribute(attributes, name, rows.integer(row, kWhole));
          break;
        case 3:
        case 6:
          add_attribute(attributes, name, rows.number(row, kReal));
          break;
        case 4:
          add_attribute(attributes, name, std::string(rows.text(row, kUri)));
          break;
        case 5:
          add_attribute(attributes, name, std::string(rows.text(row, kDate)));
          break;
        case 7:
          names.emplace(rows.integer(row, kGeneric), std::move(name));
          break;
        default:
          add_attribute(attributes, name, std::string(rows.text(row, kText)));
      }
    }
  }

  const std::vector<Rows>& rows_;
  const Instance& instance_;
  const SurfaceTrees& trees_;
  FeatureBuilder& builder_;
  Cursor buildings_, installations_, surfaces_, openings_, addresses_, generics_;
  std::unordered_map<std::int64_t, std::int32_t> objects_{};         // of the building, by row id
  std::unordered_map<std::int64_t, FeatureBuilder::Owner> walls_{};  // likewise
};

class SchemaV4 final : public Schema {
 public:
  Statement candidates(const Instance& instance,
                       const std::optional<source::FlatBox>& box) const override {
    return candidates_of(kAll, kInBox, instance, box);
  }

  Statement extent(const Instance& instance) const override {
    return {kExtent, {postgres::array_of(instance.ids_of(ObjectKind::Building))}};
  }

  Statement without_envelope(const Instance& instance) const override {
    return {kWithoutEnvelope, {postgres::array_of(instance.ids_of(ObjectKind::Building))}};
  }

  std::string sql_for_envelopes(const std::string& schema) const override {
    return fmt::format("SELECT {}.get_envelope_cityobjects(0, 1, 1)", schema);
  }

  Statement candidates_by_id(const Instance& instance,
                             std::span<const std::string> gml_ids) const override {
    return {
        kById,
        {postgres::array_of(instance.ids_of(ObjectKind::Building)), postgres::array_of(gml_ids)}};
  }

  Statement members(const Instance& instance, std::span<const std::int64_t> ids) const override {
    return {kMembers,
            {postgres::array_of(ids),
             postgres::array_of(instance.ids_of(ObjectKind::BuildingInstallation))}};
  }

  Result<Tables> fetch(postgres::Connection& connection, const Instance& instance,
                       std::vector<std::int64_t> ids, const std::stop_token& stop) const override {
    const auto list = postgres::array_of(ids);
    const auto installations =
        postgres::array_of(instance.ids_of(ObjectKind::BuildingInstallation));
    Tables tables{.ids = std::move(ids)};
    tables.sent = {{kBuildings, {list}}, {kInstallations, {list, installations}},
                   {kSurfaces, {list}},  {kOpenings, {list}},
                   {kAddresses, {list}}, {kGenerics, {list}}};
    auto rows = connection.run(tables.sent, stop);
    if (!rows) return rows.error();
    tables.rows = *std::move(rows);
    tables.sent.push_back({kGeometry, {postgres::array_of(roots_of(tables.rows))}});
    auto geometry = connection.run(tables.sent.back(), stop);
    if (!geometry) return geometry.error();
    tables.rows.push_back(*std::move(geometry));
    return tables;
  }

  Result<void> build(const Tables& tables, const Instance& instance, FeatureBuilder& builder,
                     const source::FeatureSink& sink) const override {
    const auto trees = SurfaceTrees::of(tables.rows[kOfGeometry]);
    if (!trees) return trees.error();
    Builder buildings(tables, instance, *trees, builder);
    for (const auto id : tables.ids) {
      if (!buildings.build(id))
        return fail(ErrorCode::DataLoss,
                    fmt::format("cityobject {} is a Building without a row in building", id));
      if (auto taken = sink(builder.finish()); !taken) return taken;
    }
    return {};
  }
};

}  // namespace

std::unique_ptr<const Schema> schema_v4() { return std::make_unique<SchemaV4>(); }

}  // namespace citymesh::citydb
