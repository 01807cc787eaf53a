#include <libxml/xmlreader.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/gates/parse.h"
#include "core/gates/polygons.h"

namespace citymesh {
namespace {

using Reader = std::unique_ptr<xmlTextReader, void (*)(xmlTextReaderPtr)>;

std::string_view view_of(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view();
}

struct Polygon {
  std::string patch{};
  std::vector<std::vector<Point3>> rings{};
  bool used = false;
};

/// A building, part or installation that is being read.
struct Object {
  std::string id{};
  std::vector<Polygon> polygons{};
  std::unordered_map<std::string, std::size_t> by_id{};
  std::vector<std::size_t> inline_members{};
  std::vector<std::string> members{};  ///< of the solid; "" for one of `inline_members`
};

/// The types of boundary surfaces and openings of both versions; "" for other elements.
std::string_view surface_type(std::string_view name) {
  if (name == "Window" || name == "WindowSurface") return "Window";
  if (name == "Door" || name == "DoorSurface") return "Door";
  constexpr std::array<std::string_view, 9> kTypes{
      "GroundSurface",       "WallSurface",         "RoofSurface",
      "ClosureSurface",      "OuterCeilingSurface", "OuterFloorSurface",
      "InteriorWallSurface", "CeilingSurface",      "FloorSurface"};
  for (const std::string_view type : kTypes)
    if (name == type) return type;
  return {};
}

class CityGmlParser {
 public:
  CityGmlParser(Reader reader, const ParsedBodySink& sink)
      : reader_(std::move(reader)), sink_(sink) {}

  Result<void> parse() {
    int status = 0;
    while ((status = xmlTextReaderRead(reader_.get())) == 1) {
      const int type = xmlTextReaderNodeType(reader_.get());
      const std::string name(view_of(xmlTextReaderConstLocalName(reader_.get())));
      if (type == XML_READER_TYPE_ELEMENT) {
        const bool empty = xmlTextReaderIsEmptyElement(reader_.get()) == 1;
        if (auto r = start(name); !r) return r;
        if (!empty) continue;
        if (auto r = end(name); !r) return r;
      } else if (type == XML_READER_TYPE_END_ELEMENT) {
        if (auto r = end(name); !r) return r;
      }
    }
    if (status != 0) return refuse("no well-formed XML");
    if (!model_) return refuse("expected a CityModel");
    return {};
  }

 private:
  Error refuse(std::string_view what) const {
    return line_error(
        static_cast<std::uint64_t>(std::max(0, xmlTextReaderGetParserLineNumber(reader_.get()))),
        what);
  }

  std::string attribute(const char* name) const {
    const std::unique_ptr<xmlChar, void (*)(void*)> value(
        xmlTextReaderGetAttribute(reader_.get(), reinterpret_cast<const xmlChar*>(name)), xmlFree);
    return std::string(view_of(value.get()));
  }

  std::string text() const {
    const std::unique_ptr<xmlChar, void (*)(void*)> value(xmlTextReaderReadString(reader_.get()),
                                                          xmlFree);
    return std::string(view_of(value.get()));
  }

  Result<void> start(std::string_view name) {
    if (name == "CityModel") {
      model_ = true;
    } else if (name == "description" && objects_.empty() && !origin_) {
      return read_origin();
    } else if (name == "Building" || name == "BuildingPart" || name == "BuildingInstallation") {
      if (!origin_ || in_polygon_) return refuse("a building before the origin or in a polygon");
      objects_.emplace_back().id = attribute("gml:id");
      if (objects_.back().id.empty()) return refuse("an object without gml:id");
    } else if (objects_.empty()) {
      return {};
    } else if (name == "Solid") {
      ++solids_;
    } else if (const auto type = surface_type(name); !type.empty()) {
      types_.emplace_back(type);
    } else if (name == "surfaceMember") {
      return start_member();
    } else if (name == "Polygon") {
      return start_polygon();
    } else if (in_polygon_ && name == "name") {
      polygon().patch = text();
    } else if (in_polygon_ && name == "posList") {
      return read_ring();
    }
    return {};
  }

  Result<void> end(std::string_view name) {
    if (objects_.empty()) return {};
    if (name == "Building" || name == "BuildingPart" || name == "BuildingInstallation") {
      Object object = std::move(objects_.back());
      objects_.pop_back();
      return finish(object);
    }
    if (name == "Solid") --solids_;
    if (name == "Polygon") in_polygon_ = false;
    if (!surface_type(name).empty()) types_.pop_back();
    return {};
  }

  /// The description ends with "; origin 391000 5820000 0".
  Result<void> read_origin() {
    const std::string description = text();
    constexpr std::string_view kKey = "; origin ";
    const auto at = description.rfind(kKey);
    if (at == std::string::npos) return refuse("expected the origin in the description");
    const auto point = parse_point(std::string_view(description).substr(at + kKey.size()), 0);
    if (!point) return point.error();
    origin_ = *point;
    return {};
  }

  Result<void> start_member() {
    const std::string href = attribute("xlink:href");
    if (href.empty()) return {};
    if (solids_ == 0 || href[0] != '#') return refuse("a reference " + in_quotes(href));
    objects_.back().members.push_back(href.substr(1));
    return {};
  }

  Result<void> start_polygon() {
    Object& object = objects_.back();
    const std::string id = attribute("gml:id");
    if (in_polygon_ || id.empty() || !object.by_id.emplace(id, object.polygons.size()).second)
      return refuse("polygon " + in_quotes(id) + " has no id of its own");
    in_polygon_ = true;
    if (solids_ > 0) {
      object.inline_members.push_back(object.polygons.size());
      object.members.emplace_back();
    }
    object.polygons.push_back({types_.empty() ? "" : types_.back(), {}, false});
    return {};
  }

  Polygon& polygon() { return objects_.back().polygons.back(); }

  Result<void> read_ring() {
    std::vector<Point3>& ring = polygon().rings.emplace_back();
    const std::string list = text();
    std::string_view rest = list;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      Point3 p;
      for (double* value : {&p.x, &p.y, &p.z}) {
        if (value != &p.x) word = next_word(rest);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
        if (word.empty() || error != std::errc{} || end != word.data() + word.size())
          return refuse("expected a number instead of " + in_quotes(word));
      }
      ring.push_back({p.x - origin_->x, p.y - origin_->y, p.z - origin_->z});
    }
    if (ring.size() < 4 || !(ring.front() == ring.back())) return refuse("a ring is not closed");
    ring.pop_back();
    return {};
  }

  Result<void> finish(Object& object) {
    if (object.members.empty() && object.polygons.empty()) return {};
    PolygonBody body(object.id);
    std::size_t next_inline = 0;
    for (const std::string& member : object.members) {
      std::size_t index = 0;
      if (member.empty()) {
        index = object.inline_members[next_inline++];
      } else {
        const auto found = object.by_id.find(member);
        if (found == object.by_id.end())
          return refuse("object " + in_quotes(object.id) + " has no polygon " + in_quotes(member));
        index = found->second;
      }
      Polygon& polygon = object.polygons[index];
      if (std::exchange(polygon.used, true))
        return refuse("the solid of " + in_quotes(object.id) + " has a polygon twice");
      std::vector<std::vector<std::uint32_t>> rings;
      for (const auto& ring : polygon.rings) {
        auto& corners = rings.emplace_back();
        for (const Point3& p : ring) {
          const auto corner = body.point(p);
          if (!corner) return corner.error();
          corners.push_back(*corner);
        }
      }
      if (auto added = body.add(rings, polygon.patch); !added) return added;
    }
    for (const Polygon& polygon : object.polygons)
      if (!polygon.used) return refuse("the solid of " + in_quotes(object.id) + " lacks a polygon");
    return sink_(body.take());
  }

  Reader reader_;
  const ParsedBodySink& sink_;
  std::optional<Point3> origin_{};
  std::vector<Object> objects_{};  ///< the innermost last
  std::vector<std::string> types_{};
  int solids_ = 0;
  bool model_ = false;
  bool in_polygon_ = false;
};

constexpr int kOptions =
    XML_PARSE_NONET | XML_PARSE_HUGE | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_COMPACT;

}  // namespace

Result<void> parse_citygml_text(std::string_view text, const ParsedBodySink& sink) {
  Reader reader(
      xmlReaderForMemory(text.data(), static_cast<int>(text.size()), nullptr, nullptr, kOptions),
      xmlFreeTextReader);
  if (!reader) return fail(ErrorCode::DataLoss, "no XML");
  return CityGmlParser(std::move(reader), sink).parse();
}

Result<void> parse_citygml_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  std::error_code error;
  const bool there = std::filesystem::exists(file, error);
  if (error || !there) return file_error(file, error ? error.value() : ENOENT);
  Reader reader(xmlReaderForFile(file.c_str(), nullptr, kOptions), xmlFreeTextReader);
  if (!reader) return file_error(file, EIO);
  return CityGmlParser(std::move(reader), sink).parse();
}

}  // namespace citymesh
