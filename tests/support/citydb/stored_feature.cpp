#include "tests/support/citydb/stored_feature.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <type_traits>
#include <utility>

namespace citymesh::citydb_support {
namespace {

std::uint64_t hash(std::string_view text, std::uint64_t seed) {
  std::uint64_t h = 0xcbf29ce484222325ull ^ seed;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  h = (h ^ (h >> 31)) * 0x9E3779B97F4A7C15ull;
  return h ^ (h >> 29);
}

bool is_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_inside(SurfaceType type) {
  return type == SurfaceType::InteriorWallSurface || type == SurfaceType::CeilingSurface ||
         type == SurfaceType::FloorSurface;
}

}  // namespace

std::string generated_id(const std::string& unique) {
  const std::uint64_t a = hash(unique, 1), b = hash(unique, 2);
  return fmt::format("ID_{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", a >> 32, (a >> 16) & 0xFFFF,
                     a & 0xFFFF, b >> 48, b & 0xFFFFFFFFFFFFull);
}

std::optional<Rings> StoredFeature::rings(const source::PolygonUse& use, Box3& box) const {
  const source::RawPolygon& polygon = feature_.polygons[use.polygon];
  if (!polygon.usable) return std::nullopt;
  const bool swap = polygon.srs < place_.swap_axes.size() && place_.swap_axes[polygon.srs];
  Rings rings;
  for (std::uint32_t r = 0; r < polygon.ring_count; ++r) {
    const source::RawRing raw = feature_.rings[polygon.first_ring + r];
    std::vector<Point3> ring(feature_.points.begin() + raw.first,
                             feature_.points.begin() + raw.first + raw.count);
    for (Point3& point : ring) {
      if (swap) std::swap(point.x, point.y);
      point.x += place_.dx;
      point.y += place_.dy;
    }
    if (use.reversed) std::reverse(ring.begin(), ring.end());
    if (!ring.empty() && !(ring.front() == ring.back())) ring.push_back(ring.front());
    if (ring.size() < 4) {
      ++report_.dropped_rings;
      if (r == 0) return std::nullopt;
      continue;
    }
    for (const Point3& point : ring) box.add(point);
    rings.push_back(std::move(ring));
  }
  ++report_.polygons;
  return rings;
}

std::string StoredFeature::id(const std::string& gml_id,
                              const std::string& otherwise_unique) const {
  if (!gml_id.empty()) return gml_id + place_.suffix;
  return generated_id(feature_.objects.front().gml_id + place_.suffix + otherwise_unique);
}

std::string StoredFeature::polygon_id(std::uint32_t polygon) const {
  return id(feature_.polygons[polygon].gml_id, " polygon " + std::to_string(polygon));
}

bool StoredFeature::is_borrowed(std::uint32_t polygon) const {
  return feature_.borrowed.contains(feature_.polygons[polygon].gml_id);
}

std::vector<StoredFeature::SurfaceGeometry> StoredFeature::surface_geometries(
    std::size_t object) const {
  std::map<std::pair<int, std::size_t>, std::vector<source::PolygonUse>> found;
  for (const source::RawShape& shape : feature_.objects[object].shapes) {
    if (!shape.assembled) continue;
    for (const source::PolygonUse& use : shape.uses)
      if (use.surface >= 0)
        found[{shape.lod.major, static_cast<std::size_t>(use.surface)}].push_back(use);
  }
  std::vector<SurfaceGeometry> all;
  all.reserve(found.size());
  for (auto& [key, uses] : found) all.push_back({key.second, key.first, std::move(uses)});
  add_inner_surfaces(object, all);
  return all;
}

// Walls, floors and ceilings inside are no part of a shell that the reader assembles: what they
// have is known by its polygons, the LoD by the solids that use them. Formats whose geometries
// state the surfaces of their polygons, as CityJSON, leave all surfaces to be found like this.
void StoredFeature::add_inner_surfaces(std::size_t object,
                                       std::vector<SurfaceGeometry>& all) const {
  const source::RawObject& raw = feature_.objects[object];
  std::vector<bool> has_geometry(raw.surfaces.size(), false);
  for (const SurfaceGeometry& geometry : all) has_geometry[geometry.surface] = true;
  std::map<std::pair<int, std::size_t>, std::vector<source::PolygonUse>> found;
  std::vector<bool> used(feature_.polygons.size(), false);
  const auto take = [&](int lod, source::PolygonUse use) {
    const source::RawPolygon& polygon = feature_.polygons[use.polygon];
    const std::int32_t surface = use.surface >= 0 ? use.surface : polygon.surface;
    if (surface < 0 || polygon.object != static_cast<std::int32_t>(object)) return;
    if (has_geometry[static_cast<std::size_t>(surface)]) return;
    used[use.polygon] = true;
    found[{lod, static_cast<std::size_t>(surface)}].push_back(use);
  };
  for (const source::RawShape& shape : raw.shapes)
    if (!shape.assembled)
      for (const source::PolygonUse& use : shape.uses) take(shape.lod.major, use);
  constexpr int kLodOfRooms = 4;
  for (std::uint32_t p = 0; p < feature_.polygons.size(); ++p) {
    const std::int32_t surface = feature_.polygons[p].surface;
    if (used[p] || surface < 0 || feature_.polygons[p].object != static_cast<std::int32_t>(object))
      continue;
    if (is_inside(raw.surfaces[static_cast<std::size_t>(surface)].type))
      take(place_.citygml3 ? kLodOfRooms - 1 : kLodOfRooms, {.polygon = p});
  }
  for (auto& [key, uses] : found) all.push_back({key.second, key.first, std::move(uses)});
}

std::optional<std::string> timestamp_from(const std::string& text) {
  constexpr std::size_t kDate = 10;
  if (text.size() < kDate || text[4] != '-' || text[7] != '-' || !is_digits(text.substr(0, 4)) ||
      !is_digits(text.substr(5, 2)) || !is_digits(text.substr(8, 2)))
    return std::nullopt;
  if (text.size() == kDate) return text + "T00:00:00Z";
  if (text[kDate] != 'T') return std::nullopt;
  const bool zoned = text.find_first_of("Z+-", kDate) != std::string::npos;
  return zoned ? text : text + "Z";
}

std::optional<std::string> new_year_of(const AttributeValue& value) {
  const std::string text = text_of(value);
  if (text.size() != 4 || !is_digits(text) || text == "0000") return std::nullopt;
  return text + "-01-01";
}

std::string text_of(const AttributeValue& value) {
  return std::visit(
      [](const auto& held) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
          return held;
        else
          return fmt::format("{}", held);
      },
      value);
}

std::pair<std::string, std::string> split_set(const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == name.size()) return {"", name};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = text.find(';', begin);
    values.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return values;
    begin = end + 1;
  }
}

}  // namespace citymesh::citydb_support
