#include <simdjson.h>

#include <array>
#include <string>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/source/json_features.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

bool read_vertices(dom::object geometry, std::vector<Point3>& vertices) {
  vertices.clear();
  dom::array list;
  if (geometry["vertices"].get(list) != simdjson::SUCCESS) return false;
  for (const dom::element element : list) {
    dom::array triple;
    if (element.get(triple) != simdjson::SUCCESS || triple.size() != 3) return false;
    std::array<double, 3> values{};
    std::size_t i = 0;
    for (const dom::element value : triple)
      if (value.get(values[i++]) != simdjson::SUCCESS) return false;
    vertices.push_back({values[0], values[1], values[2]});
  }
  return true;
}

void read_geometry(dom::object object, std::vector<Point3>& vertices, JsonShapes& shapes) {
  dom::object geometry;
  if (object["geometry"].get(geometry) != simdjson::SUCCESS)
    return shapes.unreadable("member 'geometry' is missing or no object");
  std::string_view name;
  if (geometry["type"].get(name) != simdjson::SUCCESS)
    return shapes.unreadable("member 'type' of the geometry is missing or no text");
  const auto type = geometry_type_from(name);
  if (!type)
    return shapes.unreadable("geometry type '" + std::string(name.substr(0, 60)) + "' is not read");
  dom::array boundaries;
  if (geometry["boundaries"].get(boundaries) != simdjson::SUCCESS)
    return shapes.unreadable("member 'boundaries' is missing or no list");
  if (!read_vertices(geometry, vertices))
    return shapes.unreadable("member 'vertices' is no list of three numbers each");
  const ReadCorner corner = [&](const dom::element& element, Point3& point, double& stated) {
    std::int64_t index = 0;
    if (element.get(index) != simdjson::SUCCESS) return CornerState::Malformed;
    stated = static_cast<double>(index);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices.size())
      return CornerState::OutOfRange;
    point = vertices[static_cast<std::size_t>(index)];
    return CornerState::Ok;
  };
  shapes.add(*type, boundaries, corner, 0);
}

}  // namespace

Result<void> read_tu3djson(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "tu3djson";
  JsonFeatures features(file, options, facts);
  if (!features.open({})) return {};
  Feature feature;
  std::vector<Point3> vertices;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (options.stop.stop_requested()) return reading_stopped();
    const dom::object* const object = features.feature(i);
    if (!object) continue;  // the features are independent of each other
    begin_feature(*object, i, options, feature);
    JsonShapes shapes(feature, options.limits.max_points_per_building, false);
    read_geometry(*object, vertices, shapes);
    shapes.finish();
    if (auto taken = sink(feature); !taken) return taken;
  }
  return {};
}

}  // namespace citymesh::source
