#include "core/source/build.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "core/citymodel/issue.h"

namespace citymesh::source {
namespace {

constexpr double kMaxOffset_m = static_cast<double>(kGridLimit) * kGridStep_m;
constexpr std::uint32_t kFree = 0xFFFFFFFFu;

std::uint64_t hash(const Point3& point) {
  std::uint64_t h = std::bit_cast<std::uint64_t>(point.x) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 29) ^ std::bit_cast<std::uint64_t>(point.y)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 32) ^ std::bit_cast<std::uint64_t>(point.z)) * 0x94D049BB133111EBull;
  return h ^ (h >> 31);
}

std::string place_text(const RawPolygon& polygon, const Point3& point) {
  char text[96];
  std::snprintf(text, sizeof text, "' at %.10g, %.10g, %.10g", point.x, point.y, point.z);
  return "polygon '" + polygon.gml_id + text;
}

}  // namespace

bool BuildingMaker::place_polygon(Feature& feature, RawPolygon& polygon) {
  const auto report = [&](int code, std::string where, double measured = 0) {
    constexpr std::size_t kMaxIssues = 1000;
    auto& issues =
        feature.objects[polygon.object < 0 ? 0u : static_cast<std::size_t>(polygon.object)].issues;
    if (issues.size() < kMaxIssues) issues.push_back({code, std::move(where), measured});
    return false;
  };
  const SrsPlacement& srs = srs_[polygon.srs];
  if (!srs.transformer) return report(issue_code::kUnknownCrs, srs.problem);

  for (std::uint32_t r = 0; r < polygon.ring_count; ++r) {
    const RawRing ring = feature.rings[polygon.first_ring + r];
    const std::span points(feature.points.data() + ring.first, ring.count);
    if (srs.swap_axes)
      for (Point3& point : points) std::swap(point.x, point.y);
    if (!srs.transformer->is_identity())
      if (auto moved = srs.transformer->apply(points); !moved)
        return report(issue_code::kUntransformableCoordinate,
                      "polygon '" + polygon.gml_id + "': " + moved.error().message);
    for (Point3& point : points) {
      const Point3 absolute = point;
      // Adding zero turns -0.0 into 0.0: points are shared by their bits.
      point = {point.x - origin_.x + 0.0, point.y - origin_.y + 0.0, point.z - origin_.z + 0.0};
      const double offset = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
      if (!(offset <= kMaxOffset_m))
        return report(issue_code::kCoordinateOutOfRange, place_text(polygon, absolute), offset);
    }
  }
  return true;
}

void BuildingMaker::place(Feature& feature) {
  std::vector<bool> used(feature.polygons.size(), false);
  for (const RawObject& object : feature.objects)
    for (const RawShape& shape : object.shapes)
      for (const PolygonUse& use : shape.uses) used[use.polygon] = true;
  for (std::size_t p = 0; p < used.size(); ++p) {
    RawPolygon& polygon = feature.polygons[p];
    if (used[p] && polygon.usable) polygon.usable = place_polygon(feature, polygon);
  }
}

void BuildingMaker::share_points(const Feature& feature) {
  const std::size_t count = feature.points.size();
  const std::size_t size = std::bit_ceil(count * 2 + 1);
  table_.assign(size, kFree);
  same_point_.resize(count);
  seen_in_.assign(count, kFree);
  index_in_.resize(count);
  geometry_ = 0;
  for (std::uint32_t p = 0; p < count; ++p) {
    std::size_t slot = hash(feature.points[p]) & (size - 1);
    while (table_[slot] != kFree && !(feature.points[table_[slot]] == feature.points[p]))
      slot = (slot + 1) & (size - 1);
    if (table_[slot] == kFree) table_[slot] = p;
    same_point_[p] = table_[slot];
  }
}

Geometry BuildingMaker::make_geometry(const Feature& feature, const RawShape& shape,
                                      std::int32_t object) {
  const std::uint32_t number = geometry_++;
  Geometry geometry{.type = shape.type,
                    .lod = shape.lod,
                    .assembled = shape.assembled,
                    .footprint = shape.footprint,
                    .closed_rings = shape.closed_rings};
  geometry.polygons.reserve(shape.uses.size());
  std::vector<std::uint32_t> polygon_of_use(shape.uses.size(), kFree);
  for (std::size_t u = 0; u < shape.uses.size(); ++u) {
    const RawPolygon& raw = feature.polygons[shape.uses[u].polygon];
    if (!raw.usable) continue;
    polygon_of_use[u] = static_cast<std::uint32_t>(geometry.polygons.size());
    Polygon& polygon = geometry.polygons.emplace_back();
    polygon.gml_id = raw.gml_id;
    if (shape.uses[u].surface >= 0)
      polygon.surface = shape.uses[u].surface;
    else if (raw.object == object)
      polygon.surface = raw.surface;
    polygon.rings.resize(raw.ring_count);
    for (std::uint32_t r = 0; r < raw.ring_count; ++r) {
      const RawRing run = feature.rings[raw.first_ring + r];
      Ring& ring = polygon.rings[r];
      ring.resize(run.count);
      for (std::uint32_t i = 0; i < run.count; ++i) {
        const std::uint32_t point = same_point_[run.first + i];
        if (seen_in_[point] != number) {
          seen_in_[point] = number;
          index_in_[point] = static_cast<std::uint32_t>(geometry.points.size());
          geometry.points.push_back(feature.points[point]);
        }
        ring[i] = index_in_[point];
      }
      if (shape.uses[u].reversed) std::reverse(ring.begin(), ring.end());
    }
  }

  const auto shell = [&](const std::vector<std::uint32_t>& uses) {
    std::vector<std::uint32_t> polygons;
    polygons.reserve(uses.size());
    for (const std::uint32_t use : uses)
      if (polygon_of_use[use] != kFree) polygons.push_back(polygon_of_use[use]);
    return polygons;
  };
  for (const Solid& solid : shape.solids) {
    Solid& made = geometry.solids.emplace_back();
    made.exterior = shell(solid.exterior);
    for (const auto& interior : solid.interiors) made.interiors.push_back(shell(interior));
  }
  return geometry;
}

Building BuildingMaker::make(Feature& feature) {
  place(feature);
  share_points(feature);

  std::vector<Building> buildings(feature.objects.size());
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    RawObject& object = feature.objects[i];
    Building& building = buildings[i];
    building.gml_id = object.gml_id;
    building.kind = object.kind;
    if (object.parent >= 0)
      building.parent = feature.objects[static_cast<std::size_t>(object.parent)].gml_id;
    building.surfaces = std::move(object.surfaces);
    building.attributes = std::move(object.attributes);
    building.source_issues = std::move(object.issues);
    building.addresses = std::move(object.addresses);
    building.skipped_ade_elements = std::move(object.skipped_ade_elements);
    for (const RawShape& shape : object.shapes) {
      Geometry geometry = make_geometry(feature, shape, static_cast<std::int32_t>(i));
      if (!geometry.polygons.empty()) building.geometries.push_back(std::move(geometry));
    }
  }
  // Parents stand before their parts: from the back every part is complete when it is moved.
  const auto in_order = [](Building& building) {
    std::reverse(building.parts.begin(), building.parts.end());
    std::reverse(building.installations.begin(), building.installations.end());
  };
  for (std::size_t i = buildings.size() - 1; i > 0; --i) {
    if (feature.objects[i].inside) continue;
    in_order(buildings[i]);
    Building& parent = buildings[static_cast<std::size_t>(feature.objects[i].parent)];
    auto& members =
        buildings[i].kind == ObjectKind::BuildingInstallation ? parent.installations : parent.parts;
    members.push_back(std::move(buildings[i]));
  }
  in_order(buildings.front());
  return std::move(buildings.front());
}

}  // namespace citymesh::source
