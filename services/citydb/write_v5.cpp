#include <fmt/format.h>

#include <utility>

#include "core/write/boundaries.h"
#include "core/write/solids.h"
#include "services/citydb/copy_rows.h"
#include "services/citydb/history_sql.h"
#include "services/citydb/stored_geometry.h"
#include "services/citydb/version_writer.h"

namespace citymesh::citydb {
namespace {

/// Types in geometry_properties.
enum StoredKind : int {
  kPolygonKind = 5,
  kCompositeSurfaceKind = 6,
  kMultiSurfaceKind = 8,
  kSolidKind = 9,
  kCompositeSolidKind = 10
};

/// The JSON beside a geometry. Ids are names of XML: nothing in them needs an escape.
class Properties {
 public:
  Properties(StoredKind kind, std::string_view id)
      : json_(fmt::format(R"({{"type":{},"objectId":"{}","children":[)", int{kind}, id)) {}

  /// `parent`: number of a child, or below 0 for the root.
  int add(StoredKind kind, std::string_view id, int parent) {
    if (children_ > 0) json_ += ',';
    json_ += fmt::format(R"({{"type":{},"objectId":"{}")", int{kind}, id);
    if (parent >= 0) json_ += fmt::format(R"(,"parent":{})", parent);
    if (kind == kPolygonKind) json_ += fmt::format(R"(,"geometryIndex":{})", polygons_++);
    json_ += '}';
    return children_++;
  }
  std::string take() { return std::move(json_) + "]}"; }

 private:
  std::string json_;
  int children_ = 0, polygons_ = 0;
};

class WriterV5 final : public VersionWriter {
 public:
  WriterV5(postgres::Connection& connection, NamedIds names, Stamp stamp)
      : connection_(connection), names_(std::move(names)), stamp_(std::move(stamp)) {}

  Result<void> add(const BuildingBodies& building, const std::stop_token& stop) override {
    const auto objects = city_objects(building);
    std::size_t faces = 0;
    for (const auto& object : objects)
      if (object.body) faces += object.body->mesh.faces.size();
    // A face at most has a surface and the wall that it is an opening of.
    const std::size_t most = 2 * (objects.size() + 2 * faces);
    for (auto* ids : {&feature_ids_, &geometry_ids_, &property_ids_})
      if (auto provided = ids->provide(most, connection_, stop); !provided) return provided;

    GmlIds gml_ids;
    for (const auto& object : objects) (void)gml_ids.take(stored_id(object), "");
    const auto top = feature_ids_.take();
    buildings_.push_back(top);
    Box3 all;
    for (std::size_t i = 1; i < objects.size(); ++i) {
      const auto part = feature_ids_.take();
      const Box3 box = add_geometry(objects[i], part, gml_ids);
      const bool installation = objects[i].kind == ObjectKind::BuildingInstallation;
      add_feature(part, installation ? "BuildingInstallation" : "BuildingPart",
                  stored_id(objects[i]), box, objects[i].body->rung);
      contain(top, "bldg", installation ? "buildingInstallation" : "buildingPart", part);
      all.add(box);
    }
    all.add(add_geometry(objects.front(), top, gml_ids));
    add_feature(top, "Building", stored_id(objects.front()), all, building.rung);
    return {};
  }

  std::size_t bytes() const override {
    return features_.bytes() + geometries_.bytes() + properties_.bytes();
  }

  Result<void> flush(const std::stop_token& stop) override {
    for (auto* rows : {&features_, &geometries_, &properties_})
      if (auto sent = rows->send(connection_, stop); !sent) return sent;
    return {};
  }

 private:
  std::int64_t id_of(std::string_view kind, std::string_view name) const {
    const auto found = names_.find(fmt::format("{} {}", kind, name));
    return found == names_.end() ? 0 : found->second;
  }

  void add_feature(std::int64_t id, std::string_view class_name, std::string_view gml_id,
                   const Box3& box, std::string_view rung) {
    features_.number(id).number(id_of("class", class_name)).text(gml_id);
    if (box.is_empty())
      features_.null();
    else
      features_.text(envelope_text(box, stamp_.srid));
    features_.text(stamp_.created)
        .text("citymesh")
        .text(fmt::format("{}: {}", stamp_.reason, rung))
        .text(stamp_.lineage)
        .text(stamp_.created)
        .end();
  }

  void contain(std::int64_t owner, std::string_view space, std::string_view name,
               std::int64_t member) {
    constexpr int kContains = 1;
    properties_.number(property_ids_.take())
        .number(owner)
        .number(id_of("type", "FeatureProperty"))
        .number(id_of("space", space))
        .text(name)
        .null()
        .null()
        .number(member)
        .number(kContains)
        .end();
  }

  void add_geometry_row(std::int64_t owner, int lod, std::string_view kind,
                        const std::string& geometry, const std::string& properties) {
    const auto id = geometry_ids_.take();
    geometries_.number(id).text(geometry).text(properties).number(owner).end();
    properties_.number(property_ids_.take())
        .number(owner)
        .number(id_of("type", "GeometryProperty"))
        .number(id_of("space", "core"))
        .text(fmt::format("lod{}{}", lod, kind))
        .text(std::to_string(lod))
        .number(id)
        .null()
        .null()
        .end();
  }

  /// Solid and boundary surfaces; what they cover.
  Box3 add_geometry(const CityObject& object, std::int64_t owner, GmlIds& gml_ids) {
    if (!object.body) return {};
    BodyIds ids(gml_ids, std::to_string(owner));
    const Boundaries boundaries = boundaries_of(CityGml::V3, object, ids);
    add_solid(*object.body, boundaries, owner, ids);
    std::size_t surfaces = 0;
    for (const BoundarySurface& surface : boundaries.surfaces)
      if (!is_opening(surface.type))
        contain(owner, "core", "boundary",
                add_surface(*object.body, boundaries, surface, surfaces, ids));
    Box3 box;
    const GeometryText text(object.body->mesh, stamp_.origin, stamp_.srid);
    for (std::size_t f = 0; f < object.body->mesh.faces.size(); ++f) text.extend(box, f);
    return box;
  }

  void add_solid(const Body& body, const Boundaries& boundaries, std::int64_t owner, BodyIds& ids) {
    const auto solids = solids_of(body.mesh);
    if (solids.empty()) return;
    const bool several = solids.size() > 1;
    GeometryText text(body.mesh, stamp_.origin, stamp_.srid);
    Properties properties(several ? kCompositeSolidKind : kSolidKind,
                          ids.generated(several ? 'c' : 's', 0));
    if (several) text.collection(GeometryText::Type::GeometryCollection, solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s) {
      const auto [begin, end] = solids[s].exterior;
      const int solid = several ? properties.add(kSolidKind, ids.generated('s', s), -1) : -1;
      const int shell = properties.add(kCompositeSurfaceKind, ids.generated('k', s), solid);
      text.collection(GeometryText::Type::PolyhedralSurface, end - begin);
      for (std::size_t f = begin; f < end; ++f) {
        text.polygon(f);
        properties.add(kPolygonKind, boundaries.polygon_ids[f], shell);
      }
      cavities_ += solids[s].interiors.size();
    }
    add_geometry_row(owner, boundaries.lod, "Solid", text.take(), properties.take());
  }

  std::int64_t add_surface(const Body& body, const Boundaries& boundaries,
                           const BoundarySurface& surface, std::size_t& surfaces, BodyIds& ids) {
    const auto id = feature_ids_.take();
    GeometryText text(body.mesh, stamp_.origin, stamp_.srid);
    Box3 box;
    if (!surface.faces.empty()) {
      Properties properties(kMultiSurfaceKind, ids.generated('m', surfaces++));
      text.collection(GeometryText::Type::MultiPolygon, surface.faces.size());
      for (const std::size_t f : surface.faces) {
        text.polygon(f);
        text.extend(box, f);
        properties.add(kPolygonKind, boundaries.polygon_ids[f], -1);
      }
      add_geometry_row(id, boundaries.lod, "MultiSurface", text.take(), properties.take());
    }
    std::string class_name(to_string(surface.type));
    if (is_opening(surface.type)) class_name += "Surface";
    add_feature(id, class_name, surface.id, box,
                surface.made_by.empty() ? std::string_view(body.rung) : surface.made_by);
    for (const std::size_t opening : surface.openings)
      contain(id, "con", "fillingSurface",
              add_surface(body, boundaries, boundaries.surfaces[opening], surfaces, ids));
    return id;
  }

  postgres::Connection& connection_;
  const NamedIds names_;
  const Stamp stamp_;
  Ids feature_ids_{"SELECT nextval('feature_seq') FROM generate_series(1, $1::integer)"};
  Ids geometry_ids_{"SELECT nextval('geometry_data_seq') FROM generate_series(1, $1::integer)"};
  Ids property_ids_{"SELECT nextval('property_seq') FROM generate_series(1, $1::integer)"};
  CopyRows features_{
      "COPY feature (id, objectclass_id, objectid, envelope, last_modification_date,"
      " updating_person, reason_for_update, lineage, creation_date) FROM STDIN"};
  CopyRows geometries_{
      "COPY geometry_data (id, geometry, geometry_properties, feature_id) FROM STDIN"};
  CopyRows properties_{
      "COPY property (id, feature_id, datatype_id, namespace_id, name, val_lod, val_geometry_id,"
      " val_feature_id, val_relation_type) FROM STDIN"};
};

constexpr ObjectTable kObjects{"feature", "objectid"};

/// All features below the rows of `tops` (id, ended) get `to` for termination_date.
std::string end_of_tree(std::string_view tops, std::string_view to, std::string_view which) {
  return fmt::format(
      "WITH RECURSIVE tree(id, ended) AS ({}"
      " UNION SELECT p.val_feature_id, t.ended FROM tree t JOIN property p ON p.feature_id = t.id"
      " AND p.val_relation_type = 1 AND p.val_feature_id IS NOT NULL)"
      " UPDATE feature f SET termination_date = {} FROM tree WHERE f.id = tree.id AND {}",
      tops, to, which);
}

}  // namespace

std::unique_ptr<VersionWriter> writer_v5(postgres::Connection& connection, NamedIds names,
                                         Stamp stamp) {
  return std::make_unique<WriterV5>(connection, std::move(names), std::move(stamp));
}

const VersionSql& sql_v5() {
  static const std::string restore =
      end_of_tree(ended_by_lineage(kObjects), "NULL", "f.termination_date = tree.ended");
  static const std::string supersede =
      end_of_tree(current_beside(kObjects), "tree.ended", "f.termination_date IS NULL");
  static const VersionSql sql{
      .names =
          "SELECT 'class ' || classname, id::bigint FROM objectclass WHERE ade_id IS NULL"
          " UNION ALL SELECT 'type ' || typename, id::bigint FROM datatype"
          " WHERE ade_id IS NULL"
          " UNION ALL SELECT 'space ' || alias, id::bigint FROM namespace"
          " WHERE ade_id IS NULL",
      .lock = "LOCK TABLE feature, geometry_data, property IN ROW EXCLUSIVE MODE",
      .in_place =
          "SELECT bool_and(coalesce(to_regclass(name) ="
          " to_regclass(quote_ident($1) || '.' || name), false))"
          " FROM unnest(ARRAY['feature', 'geometry_data', 'property', 'feature_seq',"
          " 'geometry_data_seq', 'property_seq']) AS names(name)",
      .withdraw = {restore.c_str(),
                   "DELETE FROM property p USING feature f WHERE p.feature_id = f.id"
                   " AND f.lineage = $1 AND f.creation_date <> now()",
                   "DELETE FROM geometry_data g USING feature f WHERE g.feature_id = f.id"
                   " AND f.lineage = $1 AND f.creation_date <> now()",
                   "DELETE FROM feature WHERE lineage = $1 AND creation_date <> now()"},
      .supersede = supersede.c_str()};
  return sql;
}

}  // namespace citymesh::citydb
