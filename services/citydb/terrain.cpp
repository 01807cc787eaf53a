#include "services/citydb/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "services/citydb/candidates.h"
#include "services/citydb/ewkb.h"
#include "services/citydb/row_index.h"

namespace citymesh::citydb {
namespace {

using postgres::Rows;
using postgres::Statement;
using source::Point2;

constexpr const char* kTin = "TINRelief";

// The end of a ReliefFeature is the end of its components, whether that was written down or not.
constexpr const char* kComponentsV4 =
    "SELECT c.id, c.gmlid, k.classname, coalesce(r.lod, 0)::int, t.surface_geometry_id"
    " FROM cityobject c JOIN objectclass k ON k.id = c.objectclass_id"
    " LEFT JOIN relief_component r ON r.id = c.id LEFT JOIN tin_relief t ON t.id = c.id"
    " WHERE k.classname IN ('TINRelief', 'MassPointRelief', 'BreaklineRelief', 'RasterRelief')"
    " AND c.termination_date IS NULL"
    " AND c.envelope && ST_MakeEnvelope($1::float8, $2::float8, $3::float8, $4::float8, $5::int)"
    " AND coalesce((SELECT bool_or(f.termination_date IS NULL) FROM relief_feat_to_rel_comp x"
    " JOIN cityobject f ON f.id = x.relief_feature_id WHERE x.relief_component_id = c.id), true)"
    " LIMIT $6::bigint";
// OFFSET 0: see chunk_v5.cpp.
constexpr const char* kComponentsV5 =
    "SELECT f.id, f.objectid, k.classname, coalesce(q.lod, 0), q.tin"
    " FROM feature f JOIN objectclass k ON k.id = f.objectclass_id"
    " JOIN namespace n ON n.id = k.namespace_id CROSS JOIN LATERAL"
    " (SELECT max(p.val_int) FILTER (WHERE p.name = 'lod') AS lod,"
    " max(p.val_geometry_id) FILTER (WHERE p.name = 'tin') AS tin FROM"
    " (SELECT p.name, p.namespace_id, p.val_int, p.val_geometry_id FROM property p"
    " WHERE p.feature_id = f.id OFFSET 0) p WHERE p.namespace_id = n.id) q"
    " WHERE k.classname IN ('TINRelief', 'MassPointRelief', 'BreaklineRelief', 'RasterRelief')"
    " AND n.alias = 'dem' AND f.termination_date IS NULL"
    " AND f.envelope && ST_MakeEnvelope($1::float8, $2::float8, $3::float8, $4::float8, $5::int)"
    " AND coalesce((SELECT bool_or(r.termination_date IS NULL) FROM (SELECT p.feature_id"
    " FROM property p WHERE p.val_feature_id = f.id AND p.val_relation_type = 1 OFFSET 0) p"
    " CROSS JOIN LATERAL (SELECT r.termination_date FROM feature r WHERE r.id = p.feature_id"
    " OFFSET 0) r), true) LIMIT $6::bigint";
enum ComponentColumn { kId, kGmlId, kClass, kLod, kGeometry };

// A triangle's ring has four points; what has more is no triangle, and may be large.
constexpr const char* kFacesV4 =
    "SELECT s.root_id, s.id, CASE WHEN ST_NPoints(s.geometry) <= 4 THEN s.geometry END"
    " FROM surface_geometry s WHERE s.root_id = ANY($6::bigint[])"
    " AND s.geometry && ST_MakeEnvelope($1::float8, $2::float8, $3::float8, $4::float8, $5::int)"
    " LIMIT $7::bigint";
constexpr const char* kFacesV5 =
    "SELECT g.id, d.number, CASE WHEN ST_NPoints(d.geom) <= 4 THEN d.geom END"
    " FROM geometry_data g CROSS JOIN LATERAL ST_Dump(g.geometry) WITH ORDINALITY"
    " AS d(path, geom, number) WHERE g.id = ANY($6::bigint[])"
    " AND d.geom && ST_MakeEnvelope($1::float8, $2::float8, $3::float8, $4::float8, $5::int)"
    " LIMIT $7::bigint";
enum FaceColumn { kFaceGeometry = 2 };

std::vector<std::string> parameters_of(const Instance& instance, const source::FlatBox& box) {
  return {fmt::format("{}", box.min.x), fmt::format("{}", box.min.y), fmt::format("{}", box.max.x),
          fmt::format("{}", box.max.y), std::to_string(instance.srid)};
}

struct Component {
  std::int64_t id = 0;
  std::string gml_id{};
  int lod = 0;
  std::int64_t geometry = 0;
};

using Corners = std::array<Point3, 3>;

struct PlaceHash {
  std::size_t operator()(const Point3& point) const {
    std::uint64_t hash = 0;
    for (const double value : {point.x, point.y, point.z})  // + 0.0: the zeros are one
      hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

/// Less high than coordinates of this size are rounded.
bool is_degenerate(const Corners& corners) {
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  const auto& [a, b, c] = corners;
  if (a == b || b == c || c == a) return true;
  double largest = 0;
  for (const auto& p : corners)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const auto length = [](const Point3& p, const Point3& q) {
    return std::hypot(q.x - p.x, q.y - p.y, q.z - p.z);
  };
  const Point3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  const double doubled =
      std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  return doubled <= kRounding * largest * std::max({length(a, b), length(b, c), length(c, a)});
}

bool touches(const source::Area& area, const Corners& corners) {
  std::array<Point2, 3> flat;
  for (std::size_t i = 0; i < flat.size(); ++i) flat[i] = {corners[i].x, corners[i].y};
  constexpr source::Footprints::Ring kRing{0, 3, true};
  return area.contains(flat.front()) || area.touches(flat, std::span(&kRing, 1));
}

/// Takes the faces that the database has of one component after another.
class Builder {
 public:
  Builder(const source::Area& area, Terrain& terrain) : area_(area), terrain_(terrain) {}

  /// Errors: why the component is left out.
  Result<void> add(const Component& component, const Rows& rows, std::span<const int> faces) {
    triangles_.clear();
    for (const int row : faces)
      if (auto read = add_face(rows, row); !read) return read;
    const auto first = terrain_.triangles.size();
    for (const auto& corners : triangles_) {
      if (!touches(area_, corners)) continue;
      if (is_degenerate(corners))
        ++terrain_.degenerate;
      else
        terrain_.triangles.push_back(
            {index_of(corners[0]), index_of(corners[1]), index_of(corners[2])});
    }
    if (const auto count = terrain_.triangles.size() - first; count > 0)
      terrain_.components.push_back({component.gml_id,
                                     {static_cast<std::int8_t>(component.lod)},
                                     static_cast<std::uint32_t>(first),
                                     static_cast<std::uint32_t>(count)});
    return {};
  }

 private:
  Result<void> add_face(const Rows& rows, int row) {
    const auto no_triangle = [] {
      return fail(ErrorCode::DataLoss, "has faces that are no triangles");
    };
    if (rows.null(row, kFaceGeometry)) return no_triangle();
    face_.clear();
    if (auto added = add_ewkb(rows.text(row, kFaceGeometry), face_); !added) return added;
    const auto& points = face_.points;
    if (face_.rings.size() != 1 || points.size() != 4) return no_triangle();
    for (const auto& p : points)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return fail(ErrorCode::DataLoss, "has coordinates that are no numbers");
    if (points.front() != points.back()) return no_triangle();
    triangles_.push_back({points[0], points[1], points[2]});
    return {};
  }

  std::uint32_t index_of(const Point3& place) {
    const auto next = static_cast<std::uint32_t>(terrain_.points.size());
    const auto [known, added] = indices_.emplace(place, next);
    if (added) terrain_.points.push_back(place);
    return known->second;
  }

  const source::Area& area_;
  Terrain& terrain_;
  StoredPolygons face_{};
  std::vector<Corners> triangles_{};  ///< of the component
  std::unordered_map<Point3, std::uint32_t, PlaceHash> indices_{};
};

/// The TINs among the components in the box, finest first; what is none is left out.
std::vector<Component> tins_of(const Rows& rows, Terrain& terrain) {
  std::vector<Component> tins;
  for (int row = 0; row < rows.size(); ++row) {
    std::string gml_id(rows.text(row, kGmlId));
    if (const auto name = rows.text(row, kClass); name != kTin)
      terrain.left_out[fmt::format("is a {}", name)].push_back(std::move(gml_id));
    else if (rows.null(row, kGeometry))
      terrain.left_out["has no geometry"].push_back(std::move(gml_id));
    else
      tins.push_back({rows.integer(row, kId), std::move(gml_id),
                      static_cast<int>(std::clamp<std::int64_t>(rows.integer(row, kLod), 0, 9)),
                      rows.integer(row, kGeometry)});
  }
  std::ranges::sort(tins, [](const Component& a, const Component& b) {
    return std::pair(-a.lod, a.id) < std::pair(-b.lod, b.id);
  });
  return tins;
}

Error too_much(std::uint32_t limit) {
  return fail(
      ErrorCode::ResourceExhausted,
      fmt::format("the terrain has more than {} triangles in the box: ask for a smaller box "
                  "or a coarser level of detail",
                  limit));
}

}  // namespace

Statement terrain_components(const Instance& instance, const source::FlatBox& box,
                             std::uint64_t limit) {
  auto parameters = parameters_of(instance, box);
  parameters.push_back(std::to_string(limit));
  return {instance.major == 5 ? kComponentsV5 : kComponentsV4, std::move(parameters)};
}

Statement terrain_faces(const Instance& instance, std::span<const std::int64_t> geometries,
                        const source::FlatBox& box, std::uint64_t limit) {
  auto parameters = parameters_of(instance, box);
  parameters.push_back(postgres::array_of(geometries));
  parameters.push_back(std::to_string(limit));
  return {instance.major == 5 ? kFacesV5 : kFacesV4, std::move(parameters)};
}

Result<Terrain> read_terrain(postgres::Connection& connection, const Instance& instance,
                             const TerrainQuery& query, const std::stop_token& stop) {
  Terrain terrain;
  auto crs = parse_crs(instance.srs_name);
  if (!crs) return crs.error();
  terrain.crs = *std::move(crs);
  const auto area = area_in_database(query.bbox, instance, AxisOrder::EastNorth);
  if (!area) return area.error();
  const source::FlatBox box{area->min(), area->max()};
  const std::uint64_t limit = std::uint64_t{query.max_triangles} + 1;  // one more than may be

  const auto found = connection.run(terrain_components(instance, box, limit), stop);
  if (!found) return found.error();
  if (static_cast<std::uint64_t>(found->size()) >= limit) return too_much(query.max_triangles);
  const auto tins = tins_of(*found, terrain);

  Builder builder(*area, terrain);
  for (auto first = tins.begin(), last = first; first != tins.end(); first = last) {
    const int lod = first->lod;
    last = std::find_if(first, tins.end(), [&](const Component& tin) { return tin.lod != lod; });
    if (lod > query.max_lod || !terrain.triangles.empty()) {
      auto& others = terrain.left_out[fmt::format("is of LoD {}", lod)];
      std::for_each(first, last, [&](const Component& tin) { others.push_back(tin.gml_id); });
      continue;
    }
    std::vector<std::int64_t> geometries;
    std::for_each(first, last, [&](const Component& tin) { geometries.push_back(tin.geometry); });
    const auto rows = connection.run(terrain_faces(instance, geometries, box, limit), stop);
    if (!rows) return rows.error();
    if (static_cast<std::uint64_t>(rows->size()) >= limit) return too_much(query.max_triangles);
    const RowIndex faces(*rows);
    for (auto tin = first; tin != last; ++tin)
      if (const auto added = builder.add(*tin, *rows, faces.of(tin->geometry)); !added)
        terrain.left_out[added.error().message].push_back(tin->gml_id);
  }
  for (auto& [reason, gml_ids] : terrain.left_out) std::ranges::sort(gml_ids);
  return terrain;
}

}  // namespace citymesh::citydb
