#include "tests/integration/citydb/canonical.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

namespace citymesh {
namespace {

/// Importers name what has no name.
std::string id(const std::string& gml_id) {
  for (const auto* made_up : {"ID_", "UUID_"})
    if (gml_id.starts_with(made_up)) return "";
  return gml_id;
}

std::string value(const AttributeValue& attribute) {
  return std::visit([](const auto& known) { return fmt::format("{}", known); }, attribute);
}

constexpr std::size_t kFewestCorners = 4;  // of a closed ring

bool is_closed(const Geometry& geometry, const Ring& ring) {
  return !ring.empty() && geometry.points[ring.front()] == geometry.points[ring.back()];
}

/// With the repeated first one.
std::size_t corners(const Geometry& geometry, const Ring& ring) {
  return ring.size() + (ring.empty() || is_closed(geometry, ring) ? 0 : 1);
}

std::string point_text(const Point3& point) {
  return fmt::format("{} {} {},", point.x, point.y, point.z);
}

std::string polygon_text(const Building& building, const Geometry& geometry,
                         const Polygon& polygon) {
  std::string surface = "-";
  if (polygon.surface >= 0) {
    const auto& of = building.surfaces[static_cast<std::size_t>(polygon.surface)];
    surface = fmt::format("{} {}", to_string(of.type), id(of.gml_id));
  }
  auto text = fmt::format("'{}' of {}:", id(polygon.gml_id), surface);
  for (const auto& ring : polygon.rings) {
    if (corners(geometry, ring) < kFewestCorners) continue;
    text += " (";
    for (const auto corner : ring) text += point_text(geometry.points[corner]);
    if (!is_closed(geometry, ring)) text += point_text(geometry.points[ring.front()]);
    text += ")";
  }
  return text;
}

/// Whether PostGIS takes a polygon at all.
bool is_polygon(const Geometry& geometry, const Polygon& polygon) {
  return !polygon.rings.empty() && corners(geometry, polygon.rings.front()) >= kFewestCorners;
}

std::string geometry_text(const Building& building, const Geometry& geometry) {
  const bool solid = geometry.type == GeometryType::Solid ||
                     geometry.type == GeometryType::MultiSolid ||
                     geometry.type == GeometryType::CompositeSolid;
  std::vector<std::string> lines;
  if (solid && !geometry.solids.empty()) {
    for (std::size_t s = 0; s < geometry.solids.size(); ++s)
      for (const auto p : geometry.solids[s].exterior)
        if (is_polygon(geometry, geometry.polygons[p]))
          lines.push_back(polygon_text(building, geometry, geometry.polygons[p]));
  } else {
    for (const auto& polygon : geometry.polygons)
      if (is_polygon(geometry, polygon)) lines.push_back(polygon_text(building, geometry, polygon));
  }
  std::ranges::sort(lines);
  return fmt::format("LoD {} {}{}{} of {}:\n      {}", geometry.lod.major,
                     solid ? "solids" : "surfaces", geometry.assembled ? ", assembled" : "",
                     geometry.footprint ? ", footprint" : "", solid ? geometry.solids.size() : 1,
                     fmt::join(lines, "\n      "));
}

void add(const Building& building, unsigned depth, std::string& text) {
  const std::string indent(2 * depth, ' ');
  text += fmt::format("{}{} '{}'\n", indent, to_string(building.kind), id(building.gml_id));
  const auto lines = [&](std::string_view title, std::vector<std::string> of) {
    std::ranges::sort(of);
    for (const auto& line : of) text += fmt::format("{}  {} {}\n", indent, title, line);
  };
  std::vector<std::string> attributes, addresses, surfaces, geometries;
  for (const auto& [name, attribute] : building.attributes)
    if (name == "yearOfConstruction" || name == "yearOfDemolition")  // version 5 has dates
      attributes.push_back(fmt::format("dateOf{} = {}-01-01", name.substr(6), value(attribute)));
    else if (name != "creationDate")
      attributes.push_back(fmt::format("{} = {}", name, value(attribute)));
  for (const auto& a : building.addresses)
    addresses.push_back(fmt::format("{}|{}|{}|{}|{}|{}|{}", a.street, a.house_number, a.po_box,
                                    a.zip_code, a.city, a.state, a.country));
  for (const auto& surface : building.surfaces) {
    std::string outer;
    if (surface.parent >= 0)
      outer = " in " + id(building.surfaces[static_cast<std::size_t>(surface.parent)].gml_id);
    surfaces.push_back(
        fmt::format("{} '{}'{}", to_string(surface.type), id(surface.gml_id), outer));
  }
  for (const auto& geometry : building.geometries)
    geometries.push_back(geometry_text(building, geometry));
  lines("attribute", std::move(attributes));
  lines("address", std::move(addresses));
  lines("surface", std::move(surfaces));
  lines("geometry", std::move(geometries));

  std::vector<std::string> members;
  for (const auto* list : {&building.parts, &building.installations})
    for (const auto& member : *list) add(member, depth + 1, members.emplace_back());
  std::ranges::sort(members);
  for (const auto& member : members) text += member;
}

}  // namespace

std::string canonical(const Building& building) {
  std::string text;
  add(building, 0, text);
  return text;
}

}  // namespace citymesh
