#include "tests/integration/wfs/reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace citymesh::wfs_support {
namespace {

std::string text_of(const AttributeValue& value) {
  return std::visit([](const auto& plain) { return fmt::format("{}", plain); }, value);
}

void add_to(std::string& text, const Building& building) {
  text +=
      fmt::format("{} {} of '{}'\n", to_string(building.kind), building.gml_id, building.parent);
  for (const auto& surface : building.surfaces)
    text +=
        fmt::format("surface {} {} {}\n", to_string(surface.type), surface.gml_id, surface.parent);
  for (const auto& geometry : building.geometries) {
    text += fmt::format("geometry {} lod {} {} {}\n", static_cast<int>(geometry.type),
                        to_string(geometry.lod), geometry.assembled, geometry.footprint);
    for (const auto& point : geometry.points)
      text += fmt::format("{} {} {}\n", point.x, point.y, point.z);
    for (const auto& polygon : geometry.polygons)
      text += fmt::format("polygon {} {} {}\n", polygon.gml_id, polygon.surface, polygon.rings);
    for (const auto& solid : geometry.solids)
      text += fmt::format("solid {} {}\n", solid.exterior, solid.interiors);
  }
  for (const auto& [name, value] : building.attributes)
    text += fmt::format("{} = {}\n", name, text_of(value));
  for (const auto& address : building.addresses)
    text +=
        fmt::format("{} {} {} {} {} {} {}\n", address.street, address.house_number, address.po_box,
                    address.zip_code, address.city, address.state, address.country);
  for (const auto& issue : building.source_issues)
    text += fmt::format("issue {} {}\n", issue.code, issue.where);
  for (const auto& part : building.parts) add_to(text, part);
  for (const auto& installation : building.installations) add_to(text, installation);
}

}  // namespace

Reading read(CitySource& source, const BuildingQuery& query) {
  Reading reading;
  auto selection = source.select(query, {});
  if (!selection) {
    reading.error = selection.error();
    return reading;
  }
  reading.selection = std::move(*selection);
  const auto done = source.read(query, reading.selection,
                                [&](Building&& building) -> Result<void> {
                                  add_to(reading.buildings.emplace_back(), building);
                                  return {};
                                },
                                {});
  if (!done) reading.error = done.error();
  std::ranges::sort(reading.buildings);
  return reading;
}

Reading read_file(const std::filesystem::path& file, const BuildingQuery& query) {
  auto source = open_files({file}, {});
  if (!source) return {.error = source.error()};
  return read(**source, query);
}

WfsOptions options_for(const TestWfs& server) {
  return {.url = server.url(), .page = 7, .timeout_s = 60, .retry_pause_s = 0.01};
}

Reading read_wfs(const TestWfs& server, const BuildingQuery& query) {
  return read_wfs(options_for(server), query);
}

Reading read_wfs(const WfsOptions& options, const BuildingQuery& query) {
  const auto factory = open_wfs(options);
  if (!factory) return {.error = factory.error()};
  auto source = (*factory)(WfsUse::Reading);
  if (!source) return {.error = source.error()};
  return read(**source, query);
}

}  // namespace citymesh::wfs_support
