#include <simdjson.h>

#include <array>
#include <optional>
#include <string>

#include "core/citymodel/crs.h"
#include "core/source/json_features.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

// "http://…/EPSG/0/25832", "[EPSG:25832]", {"type": "Reference", "href": …}
std::string one_crs_name(dom::element element) {
  std::string_view text;
  dom::object reference;
  if (element.get(reference) == simdjson::SUCCESS &&
      reference["href"].get(text) != simdjson::SUCCESS)
    return {};
  if (text.empty() && element.get(text) != simdjson::SUCCESS) return {};
  if (text.size() > 2 && text.front() == '[' && text.back() == ']')
    text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// The name of a `coordRefSys`; a list is a compound of a horizontal and a vertical one.
std::optional<std::string> crs_name(dom::object object) {
  dom::element element;
  if (object["coordRefSys"].get(element) != simdjson::SUCCESS || element.is_null())
    return std::nullopt;
  dom::array list;
  if (element.get(list) != simdjson::SUCCESS) return one_crs_name(element);
  std::string compound;
  for (const dom::element part : list) {
    const std::string name = one_crs_name(part);
    const auto crs = parse_crs(name);
    constexpr std::string_view kAuthority = "EPSG:";
    if (!crs || !crs->id.starts_with(kAuthority)) return compound.empty() ? name : compound;
    compound += compound.empty() ? crs->id : "+" + crs->id.substr(kAuthority.size());
  }
  return compound;
}

CornerState read_position(const dom::element& element, Point3& point, double&) {
  dom::array position;
  if (element.get(position) != simdjson::SUCCESS || position.size() != 3)
    return CornerState::Malformed;
  std::array<double, 3> values{};
  std::size_t i = 0;
  for (const dom::element value : position)
    if (value.get(values[i++]) != simdjson::SUCCESS) return CornerState::Malformed;
  point = {values[0], values[1], values[2]};
  return CornerState::Ok;
}

/// Reads the places of features.
class PlaceReader {
 public:
  PlaceReader(DocumentFacts& facts, unsigned max_depth, JsonShapes& shapes)
      : facts_(facts), max_depth_(max_depth), shapes_(shapes) {}

  void read(dom::object place, std::uint32_t srs, unsigned depth = 0) {
    if (const auto own = crs_name(place)) srs = facts_.intern_srs(*own);
    std::string_view name;
    if (place["type"].get(name) != simdjson::SUCCESS)
      return shapes_.unreadable("member 'type' of the place is missing or no text");
    if (name == "GeometryCollection") return read_collection(place, srs, depth);
    dom::array coordinates;
    if (place["coordinates"].get(coordinates) != simdjson::SUCCESS)
      return shapes_.unreadable("place of type '" + std::string(name.substr(0, 60)) +
                                "' has no coordinates");
    if (name == "Polyhedron") return add(GeometryType::Solid, coordinates, srs);
    if (name == "MultiPolyhedron") return add(GeometryType::MultiSolid, coordinates, srs);
    if (name == "MultiPolygon") return add(GeometryType::MultiSurface, coordinates, srs);
    shapes_.unreadable("place of type '" + std::string(name.substr(0, 60)) + "' is not read");
  }

 private:
  void add(GeometryType type, dom::array coordinates, std::uint32_t srs) {
    shapes_.add(type, coordinates, read_position, srs);
  }

  void read_collection(dom::object place, std::uint32_t srs, unsigned depth) {
    dom::array geometries;
    if (depth >= max_depth_ || place["geometries"].get(geometries) != simdjson::SUCCESS)
      return shapes_.unreadable("member 'geometries' of the place is missing or no list");
    for (const dom::element geometry : geometries) {
      dom::object object;
      if (geometry.get(object) == simdjson::SUCCESS)
        read(object, srs, depth + 1);
      else
        shapes_.unreadable("a geometry of the place is no object");
    }
  }

  DocumentFacts& facts_;
  unsigned max_depth_;
  JsonShapes& shapes_;
};

std::optional<dom::object> place_of(dom::object feature) {
  dom::object place;
  if (feature["place"].get(place) != simdjson::SUCCESS) return std::nullopt;
  return place;
}

}  // namespace

Result<void> read_json_fg(const RandomReader& file, const DocumentOptions& options,
                          DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "JSON-FG";
  JsonFeatures features(file, options, facts);
  if (!features.open("Feature")) return {};

  bool any_place = false;
  for (std::size_t i = 0; i < features.size() && !any_place; ++i) {
    if (options.stop.stop_requested()) return reading_stopped();
    const dom::object* const object = features.feature(i);
    any_place = object && place_of(*object);
  }
  if (!any_place) {
    facts.not_a_city_model = facts.failure.empty();
    fail_reading(facts, "no feature has a 'place': GeoJSON is not read, JSON-FG is");
    return {};
  }

  std::uint32_t document_srs = 0;
  if (const dom::object* const head = features.head("coordRefSys"))
    if (const auto name = crs_name(*head)) document_srs = facts.intern_srs(*name);
  Feature feature;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (options.stop.stop_requested()) return reading_stopped();
    const dom::object* const object = features.feature(i);
    if (!object) continue;  // the features are independent of each other
    begin_feature(*object, i, options, feature);
    feature.srs = document_srs;
    if (const auto own = crs_name(*object)) feature.srs = facts.intern_srs(*own);
    JsonShapes shapes(feature, options.limits.max_points_per_building, true);
    if (const auto place = place_of(*object))
      PlaceReader(facts, options.limits.max_depth, shapes).read(*place, feature.srs);
    else
      shapes.unreadable("member 'place' is missing");
    shapes.finish();
    if (auto taken = sink(feature); !taken) return taken;
  }
  return {};
}

}  // namespace citymesh::source
