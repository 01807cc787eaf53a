#include "core/source/json_features.h"

#include <simdjson.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/citymodel/issue.h"
#include "core/source/positions.h"
#include "core/source/soup.h"

namespace citymesh::source {

namespace dom = simdjson::dom;

struct JsonFeatures::Parser {
  dom::parser parser{};
  simdjson::padded_string text{};
  dom::object object{};
};

JsonFeatures::JsonFeatures(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts)
    : facts_(facts),
      max_bytes_(options.limits.max_building_bytes),
      json_(file, options.limits.max_depth),
      parser_(std::make_unique<Parser>()) {
  // The smallest capacity; it grows with the features.
  if (parser_->parser.allocate(1u << 16, options.limits.max_depth) != simdjson::SUCCESS)
    fail_reading(facts_, "no memory for a JSON parser");
}

JsonFeatures::~JsonFeatures() = default;

const dom::object* JsonFeatures::parse(const std::string& text, std::uint64_t line,
                                       const std::string& what) {
  parser_->text = simdjson::padded_string(text);
  const auto code = parser_->parser.parse(parser_->text).get(parser_->object);
  if (code == simdjson::SUCCESS) return &parser_->object;
  fail_at_line(facts_, line, what + ": " + simdjson::error_message(code));
  return nullptr;
}

bool JsonFeatures::open(std::string_view lone_type) {
  if (!facts_.failure.empty()) return false;
  if (auto split = json_.members(json_.all(), members_); !split) {
    fail_reading(facts_, split.error().message);
    return false;
  }
  for (const JsonMember& member : members_) {
    if (member.raw_key != "features") continue;
    if (auto split = json_.elements(member.value, features_); !split)
      fail_reading(facts_, "member 'features': " + split.error().message);
    return facts_.failure.empty();
  }
  const dom::object* const type = head("type");
  std::string_view name;
  if (!type || (*type)["type"].get(name) != simdjson::SUCCESS) name = "";
  if (name.empty() || name != lone_type) {
    fail_reading(facts_, "a document of type '" + std::string(name.substr(0, 60)) +
                             "' needs a member 'features'");
    return false;
  }
  features_.push_back(json_.all());
  return true;
}

const dom::object* JsonFeatures::head(std::string_view name) {
  for (const JsonMember& member : members_) {
    if (member.raw_key != name) continue;
    const auto text = json_.text(member.value, max_bytes_);
    if (!text) {
      fail_reading(facts_, text.error().message);
      return nullptr;
    }
    return parse("{\"" + member.raw_key + "\":" + *text + "}", member.value.line,
                 "member '" + member.raw_key + "'");
  }
  return nullptr;
}

const dom::object* JsonFeatures::feature(std::size_t i) {
  const auto text = json_.text(features_[i], max_bytes_);
  if (text) return parse(*text, features_[i].line, "feature " + std::to_string(i));
  fail_reading(facts_, text.error().message);
  return nullptr;
}

Attributes attributes_from(const dom::object& members) {
  Attributes attributes;
  for (const auto& [key, value] : members) {
    const std::string name(key);
    switch (value.type()) {
      case dom::element_type::BOOL:
        attributes.emplace_back(name, bool(value));
        break;
      case dom::element_type::INT64:
        attributes.emplace_back(name, std::int64_t(value));
        break;
      case dom::element_type::UINT64:
      case dom::element_type::DOUBLE:
        attributes.emplace_back(name, double(value));
        break;
      case dom::element_type::STRING:
        attributes.emplace_back(name, std::string(std::string_view(value)));
        break;
      case dom::element_type::ARRAY:
      case dom::element_type::OBJECT:
        attributes.emplace_back(name, simdjson::minify(value));
        break;
      case dom::element_type::NULL_VALUE:
        break;
    }
  }
  return attributes;
}

namespace {

std::string id_from(dom::object object) {
  dom::element id;
  if (object["id"].get(id) != simdjson::SUCCESS) return {};
  std::string_view text;
  if (id.get(text) == simdjson::SUCCESS) return std::string(text);
  return id.is_number() ? simdjson::minify(id) : std::string();
}

}  // namespace

void begin_feature(const dom::object& object, std::size_t number, const DocumentOptions& options,
                   Feature& feature) {
  feature.clear();
  RawObject& building = feature.objects.emplace_back();
  building.gml_id = id_from(object);
  if (building.gml_id.empty()) building.gml_id = numbered_id(options.stem, number + 1);
  dom::object properties;
  if (object["properties"].get(properties) == simdjson::SUCCESS)
    building.attributes = attributes_from(properties);
}

void JsonShapes::finish() {
  if (!too_large()) return;
  feature_.objects.front().shapes.clear();
  report(issue_code::kReadLimitExceeded,
         "more than max_points_per_building = " + std::to_string(max_points_) + " points");
}

void JsonShapes::report(int code, const std::string& what, double measured) {
  constexpr std::size_t kMaxIssues = 1000;
  auto& issues = feature_.objects.front().issues;
  if (issues.size() < kMaxIssues) issues.push_back({code, what, measured});
}

void JsonShapes::unreadable(const std::string& what) {
  report(issue_code::kUnreadableGeometry, what);
}

void JsonShapes::add(GeometryType type, const dom::array& boundaries, const ReadCorner& corner,
                     std::uint32_t srs) {
  constexpr Lod kLod{2, -1};  // the formats state none
  corner_ = &corner;
  srs_ = srs;
  RawShape shape{.type = type, .lod = kLod, .closed_rings = closed_rings_};
  const std::size_t polygons_before = feature_.polygons.size();
  bool readable = true;
  if (type == GeometryType::Solid) {
    readable = add_solid(boundaries, shape);
  } else if (type == GeometryType::MultiSolid || type == GeometryType::CompositeSolid) {
    for (const dom::element solid : boundaries) {
      dom::array shells;
      readable = readable && solid.get(shells) == simdjson::SUCCESS && add_solid(shells, shape);
    }
  } else {
    readable = add_surfaces(boundaries, shape);
  }
  if (!readable) {
    feature_.polygons.resize(polygons_before);
    return unreadable("the lists of its geometry are not nested as the type requires");
  }
  if (!shape.uses.empty()) feature_.objects.front().shapes.push_back(std::move(shape));
}

bool JsonShapes::add_solid(const dom::array& shells, RawShape& shape) {
  Solid solid;
  bool first = true;
  for (const dom::element shell : shells) {
    dom::array surfaces;
    if (shell.get(surfaces) != simdjson::SUCCESS) return false;
    const std::size_t before = shape.uses.size();
    if (!add_surfaces(surfaces, shape)) return false;
    std::vector<std::uint32_t> uses;
    for (std::size_t u = before; u < shape.uses.size(); ++u)
      uses.push_back(static_cast<std::uint32_t>(u));
    if (std::exchange(first, false))
      solid.exterior = std::move(uses);
    else
      solid.interiors.push_back(std::move(uses));
  }
  shape.solids.push_back(std::move(solid));
  return true;
}

bool JsonShapes::add_surfaces(const dom::array& surfaces, RawShape& shape) {
  for (const dom::element surface : surfaces) {
    if (too_large()) return true;
    dom::array rings;
    if (surface.get(rings) != simdjson::SUCCESS) return false;
    RawPolygon polygon{
        .first_ring = static_cast<std::uint32_t>(feature_.rings.size()), .object = 0, .srs = srs_};
    for (const dom::element ring : rings) {
      dom::array corners;
      if (ring.get(corners) != simdjson::SUCCESS || !add_ring(corners, polygon)) return false;
    }
    if (polygon.ring_count == 0) {
      report(issue_code::kUnreadableRing,
             "polygon " + std::to_string(feature_.polygons.size()) + ": no exterior ring");
      polygon.usable = false;
    }
    if (polygon.usable)
      shape.uses.push_back({static_cast<std::uint32_t>(feature_.polygons.size()), false});
    feature_.polygons.push_back(std::move(polygon));
  }
  return true;
}

bool JsonShapes::add_ring(const dom::array& corners, RawPolygon& polygon) {
  const auto unusable = [&](int code, const std::string& what, double measured) {
    if (polygon.usable)
      report(code,
             "polygon " + std::to_string(feature_.polygons.size()) + " ring " +
                 std::to_string(polygon.ring_count) + ": " + what,
             measured);
    polygon.usable = false;
  };
  RawRing ring{static_cast<std::uint32_t>(feature_.points.size()), 0};
  for (const dom::element element : corners) {
    Point3 point;
    double stated = 0;
    const CornerState state = (*corner_)(element, point, stated);
    if (state == CornerState::Malformed) return false;
    const double largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    if (state == CornerState::OutOfRange)
      unusable(issue_code::kVertexIndexOutOfRange, "vertex " + std::to_string(std::lround(stated)),
               stated);
    else if (!(largest <= kMaxCoordinate))
      unusable(issue_code::kCoordinateOutOfRange, "corner " + std::to_string(ring.count), largest);
    if (!polygon.usable || too_large()) continue;
    feature_.points.push_back(point);
    ++ring.count;
  }
  if (ring.count == 0) unusable(issue_code::kUnreadableRing, "no corners", 0);
  feature_.rings.push_back(ring);
  ++polygon.ring_count;
  return true;
}

std::optional<GeometryType> geometry_type_from(std::string_view name) {
  if (name == "Solid") return GeometryType::Solid;
  if (name == "MultiSolid") return GeometryType::MultiSolid;
  if (name == "CompositeSolid") return GeometryType::CompositeSolid;
  if (name == "MultiSurface") return GeometryType::MultiSurface;
  if (name == "CompositeSurface") return GeometryType::CompositeSurface;
  return std::nullopt;
}

}  // namespace citymesh::source
