#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

/// "EPSG:25833" as OGC's https URI. Of a compound CRS the horizontal part: CityJSON has no form for
/// more; the title names it in full. Empty when there is none to state.
std::string crs_uri(const Crs& crs) {
  if (!crs.known()) return {};
  const auto colon = crs.id.find(':');
  if (colon == std::string::npos) return {};
  const std::string authority = crs.id.substr(0, colon);
  const std::string code = crs.id.substr(colon + 1, crs.id.find('+', colon) - colon - 1);
  const std::string version = authority == "OGC" ? "1.3" : "0";
  return "https://www.opengis.net/def/crs/" + authority + '/' + version + '/' + code;
}

void append_attributes(std::string& json, const Attributes& attributes) {
  std::unordered_set<std::string_view> written;  // a repeated name keeps the first value
  bool leading = true;
  for (const auto& [name, value] : attributes) {
    if (!written.insert(name).second) continue;
    if (!leading) json += ',';
    leading = false;
    append_json_string(json, name);
    json += ':';
    if (const auto* flag = std::get_if<bool>(&value)) {
      json += *flag ? "true" : "false";
    } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      append_integer(json, *integer);
    } else if (const auto* number = std::get_if<double>(&value)) {
      append_exact(json, *number);
    } else {
      append_json_string(json, std::get<std::string>(value));
    }
  }
}

/// Semantic surfaces of a mesh: one for each (type, source surface), in order of first appearance.
struct Semantics {
  struct Surface {
    SurfaceType type;
    std::uint32_t source;
  };
  std::vector<Surface> surfaces{};
  std::vector<std::int32_t> values{};  ///< per triangle; -1: no semantics
};

Semantics semantics_of(const TriangleMesh& mesh) {
  Semantics semantics;
  semantics.values.reserve(mesh.triangles.size());
  std::unordered_map<std::uint64_t, std::int32_t> known;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const SurfaceType type = mesh.surface_types[i];
    if (type == SurfaceType::Unknown) {
      semantics.values.push_back(-1);
      continue;
    }
    const std::uint64_t key = (static_cast<std::uint64_t>(type) << 32) | mesh.source_surfaces[i];
    const auto [entry, is_new] =
        known.try_emplace(key, static_cast<std::int32_t>(semantics.surfaces.size()));
    if (is_new) semantics.surfaces.push_back({type, mesh.source_surfaces[i]});
    semantics.values.push_back(entry->second);
  }
  return semantics;
}

/// A Solid whose one exterior shell has a face for each triangle.
void append_solid(std::string& json, const Body& body, std::uint64_t first_vertex) {
  const TriangleMesh& mesh = body.mesh;
  json += "{\"type\":\"Solid\",\"lod\":";
  append_json_string(json, body.lod.empty() ? "2" : body.lod);
  json += ",\"boundaries\":[[";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    json += i == 0 ? "[[" : ",[[";
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (corner > 0) json += ',';
      append_integer(json, static_cast<std::int64_t>(first_vertex + mesh.triangles[i][corner]));
    }
    json += "]]";
  }
  json += "]]";

  const Semantics semantics = semantics_of(mesh);
  if (!semantics.surfaces.empty()) {
    json += ",\"semantics\":{\"surfaces\":[";
    for (std::size_t i = 0; i < semantics.surfaces.size(); ++i) {
      const auto& surface = semantics.surfaces[i];
      json += i == 0 ? "{\"type\":" : ",{\"type\":";
      append_json_string(json, to_string(surface.type));
      if (surface.source < mesh.surface_ids.size() && !mesh.surface_ids[surface.source].empty()) {
        json += ",\"id\":";
        append_json_string(json, mesh.surface_ids[surface.source]);
      }
      json += '}';
    }
    json += "],\"values\":[[";
    for (std::size_t i = 0; i < semantics.values.size(); ++i) {
      if (i > 0) json += ',';
      if (semantics.values[i] < 0) {
        json += "null";
      } else {
        append_integer(json, semantics.values[i]);
      }
    }
    json += "]]}";
  }
  json += '}';
}

/// A city object: the building itself, or one of its parts, with the bodies that are its geometry.
struct CityObject {
  std::string id{};
  const Attributes* attributes = nullptr;
  std::vector<const Body*> bodies{};
};

/// Ids of city objects are keys, each may be there once.
using UsedIds = std::unordered_set<std::string>;

std::string unused_id(UsedIds& used, const std::string& gml_id, const std::string& fallback) {
  if (!gml_id.empty() && used.insert(gml_id).second) return gml_id;
  std::string id = fallback;
  for (int n = 2; !used.insert(id).second; ++n) id = fallback + '_' + std::to_string(n);
  return id;
}

/// What grows with every building.
struct Growing {
  std::string objects{};
  std::string vertices{};
  std::uint64_t next_vertex = 0;
  bool any_object = false;
  UsedIds used{};
  GridPoint min{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
                std::numeric_limits<std::int64_t>::max()};
  GridPoint max{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min(),
                std::numeric_limits<std::int64_t>::min()};
};

void append_vertices(Growing& growing, const Body& body) {
  for (const GridPoint& p : body.mesh.points) {
    growing.vertices += growing.next_vertex++ == 0 ? "\n[" : ",\n[";
    append_integer(growing.vertices, p.x);
    growing.vertices += ',';
    append_integer(growing.vertices, p.y);
    growing.vertices += ',';
    append_integer(growing.vertices, p.z);
    growing.vertices += ']';
    growing.min = {std::min(growing.min.x, p.x), std::min(growing.min.y, p.y),
                   std::min(growing.min.z, p.z)};
    growing.max = {std::max(growing.max.x, p.x), std::max(growing.max.y, p.y),
                   std::max(growing.max.z, p.z)};
  }
}

void append_object(Growing& growing, const CityObject& object, std::string_view type,
                   std::string_view relations) {
  std::string& json = growing.objects;
  json += std::exchange(growing.any_object, true) ? ",\n" : "\n";
  append_json_string(json, object.id);
  json += ":{\"type\":";
  append_json_string(json, type);
  if (!object.attributes->empty()) {
    json += ",\"attributes\":{";
    append_attributes(json, *object.attributes);
    json += '}';
  }
  json += relations;
  if (!object.bodies.empty()) {
    json += ",\"geometry\":[";
    for (std::size_t i = 0; i < object.bodies.size(); ++i) {
      if (i > 0) json += ',';
      append_solid(json, *object.bodies[i], growing.next_vertex);
      append_vertices(growing, *object.bodies[i]);
    }
    json += ']';
  }
  json += '}';
}

void append_building(Growing& growing, const BuildingBodies& building) {
  CityObject whole{.attributes = &building.attributes};
  std::vector<CityObject> parts;
  std::string fallback = "building";
  for (const Body& body : building.bodies) {
    if (body.kind == ObjectKind::Building) {
      whole.bodies.push_back(&body);
      continue;
    }
    const auto same = std::find_if(parts.begin(), parts.end(), [&body](const CityObject& part) {
      return part.bodies.front()->gml_id == body.gml_id;
    });
    if (same != parts.end()) {
      same->bodies.push_back(&body);
    } else {
      parts.push_back({.attributes = &body.attributes, .bodies = {&body}});
    }
  }
  if (!building.bodies.empty()) fallback = building.bodies.front().name;
  whole.id = unused_id(growing.used, building.gml_id, fallback);
  for (CityObject& part : parts)
    part.id = unused_id(growing.used, part.bodies.front()->gml_id, part.bodies.front()->name);

  std::string relations;
  if (!parts.empty()) {
    relations = ",\"children\":[";
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) relations += ',';
      append_json_string(relations, parts[i].id);
    }
    relations += ']';
  }
  append_object(growing, whole, "Building", relations);

  std::string parent = ",\"parents\":[";
  append_json_string(parent, whole.id);
  parent += ']';
  for (const CityObject& part : parts) append_object(growing, part, "BuildingPart", parent);
}

class CityJsonWriter final : public BodyWriter {
 public:
  CityJsonWriter(AtomicFile file, Spool vertices, Scene scene)
      : file_(std::move(file)), vertices_(std::move(vertices)), scene_(std::move(scene)) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    Growing growing;
    append_building(growing, building);
    return head(scene_) + growing.objects + middle(growing) + growing.vertices + std::string(kTail);
  }

  Result<void> begin() { return file_.write(head(scene_)); }

  Result<void> add(const BuildingBodies& building) override {
    growing_.objects.clear();
    growing_.vertices.clear();
    append_building(growing_, building);
    if (auto written = file_.write(growing_.objects); !written) return written;
    return vertices_.write(growing_.vertices);
  }

  Result<void> finish() override {
    if (auto r = file_.write(middle(growing_)); !r) return r;
    if (auto r = file_.append(vertices_); !r) return r;
    if (auto r = file_.write(kTail); !r) return r;
    return file_.commit();
  }

 private:
  static constexpr std::string_view kTail = "\n]}\n";

  static std::string head(const Scene& scene) {
    std::string json =
        "{\"type\":\"CityJSON\",\"version\":\"2.0\",\n"
        "\"transform\":{\"scale\":[0.0001,0.0001,0.0001],\"translate\":[";
    append_exact(json, scene.origin.x);
    json += ',';
    append_exact(json, scene.origin.y);
    json += ',';
    append_exact(json, scene.origin.z);
    json += "]},\n\"CityObjects\":{";
    return json;
  }

  /// From the end of the objects to the first vertex; the extent is known only here.
  std::string middle(const Growing& growing) const {
    std::string json = "\n},\n\"metadata\":{\"title\":";
    append_json_string(json, title());
    if (growing.next_vertex > 0) {
      json += ",\"geographicalExtent\":[";
      append_absolute(json, growing.min);
      json += ',';
      append_absolute(json, growing.max);
      json += ']';
    }
    if (const std::string uri = crs_uri(scene_.crs); !uri.empty()) {
      json += ",\"referenceSystem\":";
      append_json_string(json, uri);
    }
    json += "},\n\"vertices\":[";
    return json;
  }

  std::string title() const {
    std::string text = generator();
    if (!scene_.process.empty()) text += ' ' + scene_.process;
    return text + "; crs " + crs_text(scene_) + "; unit metre; axes " + std::string(kAxes) +
           "; origin " + origin_text(scene_);
  }

  void append_absolute(std::string& json, const GridPoint& p) const {
    const auto steps = [](double origin, std::int64_t relative) {
      return static_cast<std::int64_t>(std::llround(origin * kGridStepsPerMetre)) + relative;
    };
    append_grid(json, steps(scene_.origin.x, p.x));
    json += ',';
    append_grid(json, steps(scene_.origin.y, p.y));
    json += ',';
    append_grid(json, steps(scene_.origin.z, p.z));
  }

  AtomicFile file_;
  Spool vertices_;
  Scene scene_;
  Growing growing_{};
};

}  // namespace

WriterResult open_cityjson(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene) {
  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  auto vertices = Spool::create(folder, std::string(format.file_name) + " (vertices)");
  if (!vertices) return vertices.error();
  auto writer = std::make_unique<CityJsonWriter>(std::move(*file), std::move(*vertices), scene);
  if (auto begun = writer->begin(); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

}  // namespace citymesh
