#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/write/boundaries.h"
#include "core/write/solids.h"
#include "services/citydb/copy_rows.h"
#include "services/citydb/history_sql.h"
#include "services/citydb/stored_geometry.h"
#include "services/citydb/version_writer.h"

namespace citymesh::citydb {
namespace {

/// The classes have the module in their names.
std::string class_name_v4(SurfaceType type) {
  switch (type) {
    case SurfaceType::InteriorWallSurface:
      return "InteriorBuildingWallSurface";
    case SurfaceType::OuterCeilingSurface:
      return "OuterBuildingCeilingSurface";
    case SurfaceType::OuterFloorSurface:
      return "OuterBuildingFloorSurface";
    default:
      return "Building" + std::string(to_string(type));
  }
}

/// Rows of surface_geometry above the polygons.
struct Flags {
  bool solid = false, composite = false;
};

class WriterV4 final : public VersionWriter {
 public:
  WriterV4(postgres::Connection& connection, NamedIds names, Stamp stamp)
      : connection_(connection), names_(std::move(names)), stamp_(std::move(stamp)) {}

  Result<void> add(const BuildingBodies& building, const std::stop_token& stop) override {
    const auto objects = city_objects(building);
    std::size_t faces = 0;
    for (const auto& object : objects)
      if (object.body) faces += object.body->mesh.faces.size();
    // A face has at most a surface and the wall that it is an opening of, and a polygon in each of
    // two trees, with a root, a solid and a shell above it.
    const std::size_t most = 2 * objects.size() + 5 * faces;
    for (auto* ids : {&object_ids_, &surface_ids_})
      if (auto provided = ids->provide(most, connection_, stop); !provided) return provided;

    GmlIds gml_ids;
    for (const auto& object : objects) (void)gml_ids.take(stored_id(object), "");
    const auto top = object_ids_.take();
    buildings_.push_back(top);
    Box3 all;
    add_object(objects.front(), top, top, building.rung, gml_ids, all, &objects);
    return {};
  }

  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const auto* rows : {&cityobjects_, &surfaces_, &buildings_rows_, &installations_,
                             &thematic_surfaces_, &openings_, &opening_links_})
      sum += rows->bytes();
    return sum;
  }

  Result<void> flush(const std::stop_token& stop) override {
    for (auto* rows : {&cityobjects_, &surfaces_, &buildings_rows_, &installations_,
                       &thematic_surfaces_, &openings_, &opening_links_})
      if (auto sent = rows->send(connection_, stop); !sent) return sent;
    return {};
  }

 private:
  static constexpr int kMaxLod = 4;
  using Objects = std::vector<CityObject>;

  std::int64_t class_of(std::string_view name) const {
    const auto found = names_.find(fmt::format("class {}", name));
    return found == names_.end() ? 0 : found->second;
  }

  /// The building with what belongs to it, `members`, or one of those.
  void add_object(const CityObject& object, std::int64_t id, std::int64_t root,
                  std::string_view rung, GmlIds& gml_ids, Box3& box, const Objects* members) {
    const bool installation = object.kind == ObjectKind::BuildingInstallation;
    const auto class_id = class_of(installation ? "BuildingInstallation"
                                   : id == root ? "Building"
                                                : "BuildingPart");
    std::int64_t solid = 0;
    int lod = 0;
    std::optional<BodyIds> ids;
    std::optional<Boundaries> boundaries;
    if (object.body) {
      ids.emplace(gml_ids, std::to_string(id));
      boundaries = boundaries_of(CityGml::V2, object, *ids);
      lod = boundaries->lod;
      solid = add_solid(*object.body, *boundaries, id, *ids);
      const GeometryText text(object.body->mesh, stamp_.origin, stamp_.srid);
      for (std::size_t f = 0; f < object.body->mesh.faces.size(); ++f) text.extend(box, f);
    }
    auto& rows = installation ? installations_ : buildings_rows_;
    rows.number(id).number(class_id);
    if (installation) {
      rows.number(root);
    } else {
      id == root ? rows.null() : rows.number(root);
      rows.number(root);
    }
    for (int level = installation ? 2 : 1; level <= kMaxLod; ++level)
      level == lod&& solid != 0 ? rows.number(solid) : rows.null();
    rows.end();

    if (members)
      for (std::size_t i = 1; i < members->size(); ++i) {
        Box3 of_member;
        const CityObject& member = (*members)[i];
        add_object(member, object_ids_.take(), root, member.body->rung, gml_ids, of_member,
                   nullptr);
        box.add(of_member);
      }
    add_cityobject(id, class_id, stored_id(object), box, rung);
    if (!boundaries) return;
    for (const BoundarySurface& surface : boundaries->surfaces)
      if (!is_opening(surface.type))
        add_surface(*object.body, *boundaries, surface, id, installation);
  }

  void add_cityobject(std::int64_t id, std::int64_t class_id, std::string_view gml_id,
                      const Box3& box, std::string_view rung) {
    cityobjects_.number(id).number(class_id).text(gml_id);
    if (box.is_empty())
      cityobjects_.null();
    else
      cityobjects_.text(envelope_text(box, stamp_.srid));
    cityobjects_.text(stamp_.created)
        .text(stamp_.created)
        .text("citymesh")
        .text(fmt::format("{}: {}", stamp_.reason, rung))
        .text(stamp_.lineage)
        .end();
  }

  // ---- surface_geometry --------------------------------------------------------------------

  void add_inner(std::int64_t id, std::int64_t parent, std::int64_t root, std::string_view gml_id,
                 Flags flags, std::int64_t owner) {
    surfaces_.number(id).text(gml_id);
    id == root ? surfaces_.null() : surfaces_.number(parent);
    surfaces_.number(root).number(flags.solid ? 1 : 0).number(flags.composite ? 1 : 0);
    surfaces_.number(0).null().number(owner).end();
  }

  /// `copied`: the polygon is that of a boundary surface.
  void add_leaf(const Body& body, std::size_t face, std::string_view gml_id, std::int64_t parent,
                std::int64_t root, bool copied, std::int64_t owner) {
    constexpr int kLocal = 2;
    GeometryText text(body.mesh, stamp_.origin, stamp_.srid);
    text.polygon(face);
    surfaces_.number(surface_ids_.take()).text(gml_id).number(parent).number(root);
    surfaces_.number(0).number(0).number(copied ? kLocal : 0).text(text.take()).number(owner).end();
  }

  /// The root; 0 where there is no solid.
  std::int64_t add_solid(const Body& body, const Boundaries& boundaries, std::int64_t owner,
                         BodyIds& ids) {
    const auto solids = solids_of(body.mesh);
    if (solids.empty()) return 0;
    const std::int64_t root = surface_ids_.take();
    const bool several = solids.size() > 1;
    if (several)
      add_inner(root, 0, root, ids.generated('c', 0), {.solid = true, .composite = true}, owner);
    for (std::size_t s = 0; s < solids.size(); ++s) {
      const auto solid = several ? surface_ids_.take() : root;
      add_inner(solid, root, root, ids.generated('s', s), {.solid = true}, owner);
      const auto shell = surface_ids_.take();
      add_inner(shell, solid, root, ids.generated('k', s), {.composite = true}, owner);
      for (std::size_t f = solids[s].exterior.begin; f < solids[s].exterior.end; ++f)
        add_leaf(body, f, boundaries.polygon_ids[f], shell, root,
                 boundaries.surface_of_face[f] != kNoBoundary, owner);
      cavities_ += solids[s].interiors.size();
    }
    return root;
  }

  // ---- boundary surfaces -------------------------------------------------------------------

  std::int64_t add_multi_surface(const Body& body, const Boundaries& boundaries,
                                 const BoundarySurface& surface, std::int64_t owner) {
    if (surface.faces.empty()) return 0;
    const auto root = surface_ids_.take();
    add_inner(root, 0, root, fmt::format("cm.{}.m", owner), {}, owner);
    for (const std::size_t f : surface.faces)
      add_leaf(body, f, boundaries.polygon_ids[f], root, root, false, owner);
    return root;
  }

  std::int64_t add_thing(const Body& body, const BoundarySurface& surface) {
    const auto id = object_ids_.take();
    Box3 box;
    const GeometryText text(body.mesh, stamp_.origin, stamp_.srid);
    for (const std::size_t f : surface.faces) text.extend(box, f);
    add_cityobject(id, class_of(class_name_v4(surface.type)), surface.id, box,
                   surface.made_by.empty() ? std::string_view(body.rung) : surface.made_by);
    return id;
  }

  void add_surface(const Body& body, const Boundaries& boundaries, const BoundarySurface& surface,
                   std::int64_t owner, bool of_installation) {
    const auto id = add_thing(body, surface);
    const auto geometry = add_multi_surface(body, boundaries, surface, id);
    thematic_surfaces_.number(id).number(class_of(class_name_v4(surface.type)));
    of_installation ? thematic_surfaces_.null().number(owner)
                    : thematic_surfaces_.number(owner).null();
    for (int level = 2; level <= kMaxLod; ++level)
      level == boundaries.lod&& geometry != 0 ? thematic_surfaces_.number(geometry)
                                              : thematic_surfaces_.null();
    thematic_surfaces_.end();
    for (const std::size_t o : surface.openings) {
      const BoundarySurface& opening = boundaries.surfaces[o];
      const auto opening_id = add_thing(body, opening);
      const auto polygons = add_multi_surface(body, boundaries, opening, opening_id);
      openings_.number(opening_id).number(class_of(class_name_v4(opening.type)));
      for (int level = 3; level <= kMaxLod; ++level)
        level == boundaries.lod ? openings_.number(polygons) : openings_.null();
      openings_.end();
      opening_links_.number(opening_id).number(id).end();
    }
  }

  postgres::Connection& connection_;
  const NamedIds names_;
  const Stamp stamp_;
  Ids object_ids_{"SELECT nextval('cityobject_seq') FROM generate_series(1, $1::integer)"};
  Ids surface_ids_{"SELECT nextval('surface_geometry_seq') FROM generate_series(1, $1::integer)"};
  CopyRows cityobjects_{
      "COPY cityobject (id, objectclass_id, gmlid, envelope, creation_date,"
      " last_modification_date, updating_person, reason_for_update, lineage) FROM STDIN"};
  CopyRows surfaces_{
      "COPY surface_geometry (id, gmlid, parent_id, root_id, is_solid, is_composite, is_xlink,"
      " geometry, cityobject_id) FROM STDIN"};
  CopyRows buildings_rows_{
      "COPY building (id, objectclass_id, building_parent_id, building_root_id, lod1_solid_id,"
      " lod2_solid_id, lod3_solid_id, lod4_solid_id) FROM STDIN"};
  CopyRows installations_{
      "COPY building_installation (id, objectclass_id, building_id, lod2_brep_id, lod3_brep_id,"
      " lod4_brep_id) FROM STDIN"};
  CopyRows thematic_surfaces_{
      "COPY thematic_surface (id, objectclass_id, building_id, building_installation_id,"
      " lod2_multi_surface_id, lod3_multi_surface_id, lod4_multi_surface_id) FROM STDIN"};
  CopyRows openings_{
      "COPY opening (id, objectclass_id, lod3_multi_surface_id, lod4_multi_surface_id)"
      " FROM STDIN"};
  CopyRows opening_links_{
      "COPY opening_to_them_surface (opening_id, thematic_surface_id)"
      " FROM STDIN"};
};

constexpr ObjectTable kObjects{"cityobject", "gmlid"};

/// All objects of the buildings in `tops` (id, ended) get `to` for termination_date.
std::string end_of_buildings(std::string_view tops, std::string_view to, std::string_view which) {
  return fmt::format(
      "WITH tops(id, ended) AS ({}),"
      " houses AS (SELECT b.id, t.ended FROM tops t JOIN building b ON b.building_root_id = t.id),"
      " things AS (SELECT i.id, h.ended FROM houses h JOIN building_installation i"
      " ON i.building_id = h.id),"
      " walls AS (SELECT s.id, h.ended FROM houses h JOIN thematic_surface s"
      " ON s.building_id = h.id UNION SELECT s.id, i.ended FROM things i JOIN thematic_surface s"
      " ON s.building_installation_id = i.id),"
      " holes AS (SELECT o.opening_id AS id, w.ended FROM walls w JOIN opening_to_them_surface o"
      " ON o.thematic_surface_id = w.id),"
      " tree AS (SELECT * FROM houses UNION SELECT * FROM things UNION SELECT * FROM walls"
      " UNION SELECT * FROM holes)"
      " UPDATE cityobject c SET termination_date = {} FROM tree WHERE c.id = tree.id AND {}",
      tops, to, which);
}

}  // namespace

std::unique_ptr<VersionWriter> writer_v4(postgres::Connection& connection, NamedIds names,
                                         Stamp stamp) {
  return std::make_unique<WriterV4>(connection, std::move(names), std::move(stamp));
}

const VersionSql& sql_v4() {
  static const std::string restore =
      end_of_buildings(ended_by_lineage(kObjects), "NULL", "c.termination_date = tree.ended");
  static const std::string supersede =
      end_of_buildings(current_beside(kObjects), "tree.ended", "c.termination_date IS NULL");
  static const VersionSql sql{
      .names = "SELECT 'class ' || classname, id::bigint FROM objectclass WHERE ade_id IS NULL",
      .lock =
          "LOCK TABLE cityobject, surface_geometry, building, building_installation,"
          " thematic_surface, opening, opening_to_them_surface IN ROW EXCLUSIVE MODE",
      .in_place =
          "SELECT bool_and(coalesce(to_regclass(name) ="
          " to_regclass(quote_ident($1) || '.' || name), false))"
          " FROM unnest(ARRAY['cityobject', 'surface_geometry', 'building',"
          " 'building_installation', 'thematic_surface', 'opening',"
          " 'opening_to_them_surface', 'cityobject_seq', 'surface_geometry_seq'])"
          " AS names(name)",
      .withdraw =
          {restore.c_str(),
           "DELETE FROM opening_to_them_surface o USING cityobject c WHERE o.opening_id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM opening o USING cityobject c WHERE o.id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM thematic_surface s USING cityobject c WHERE s.id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM building_installation i USING cityobject c WHERE i.id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM building b USING cityobject c WHERE b.id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM surface_geometry g USING cityobject c WHERE g.cityobject_id = c.id"
           " AND c.lineage = $1 AND c.creation_date <> now()",
           "DELETE FROM cityobject WHERE lineage = $1 AND creation_date <> now()"},
      .supersede = supersede.c_str()};
  return sql;
}

}  // namespace citymesh::citydb
