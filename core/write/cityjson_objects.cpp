#include "core/write/cityjson_objects.h"

#include <map>
#include <tuple>
#include <utility>

#include "core/write/json_values.h"
#include "core/write/solids.h"
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

/// Semantic surfaces of a mesh: one for each (type, source surface, rung that made it), in order of
/// first appearance.
struct Semantics {
  using Surface = std::tuple<SurfaceType, std::uint32_t, std::string_view>;
  std::vector<Surface> surfaces{};
  std::vector<std::int32_t> values{};  ///< per face; -1: no semantics
};

Semantics semantics_of(const TriangleMesh& mesh) {
  Semantics semantics;
  semantics.values.reserve(mesh.faces.size());
  std::map<Semantics::Surface, std::int32_t> known;
  for (const Face& face : mesh.faces) {
    if (face.type == SurfaceType::Unknown) {
      semantics.values.push_back(-1);
      continue;
    }
    const auto [entry, is_new] =
        known.try_emplace({face.type, face.source, face.made_by},
                          static_cast<std::int32_t>(semantics.surfaces.size()));
    if (is_new) semantics.surfaces.push_back(entry->first);
    semantics.values.push_back(entry->second);
  }
  return semantics;
}

/// Writes the nesting of a body's shells; `append_shell` writes what is in a shell's brackets.
template <class AppendShell>
void append_nested(std::string& json, const std::vector<SolidFaces>& solids,
                   AppendShell&& append_shell) {
  if (solids.size() > 1) json += '[';
  for (std::size_t i = 0; i < solids.size(); ++i) {
    json += i == 0 ? "[[" : ",[[";
    append_shell(solids[i].exterior);
    for (const FaceRange& interior : solids[i].interiors) {
      json += "],[";
      append_shell(interior);
    }
    json += "]]";
  }
  if (solids.size() > 1) json += ']';
}

}  // namespace

void CityJsonObjects::clear_text() {
  objects_.clear();
  vertices_.clear();
}

void CityJsonObjects::restart_vertices() {
  clear_text();
  next_vertex_ = 0;
  any_object_ = false;
}

std::string CityJsonObjects::unused_id(const std::string& gml_id, const std::string& fallback) {
  if (!gml_id.empty() && used_.insert(gml_id).second) return gml_id;
  std::string id = fallback;
  for (int n = 2; !used_.insert(id).second; ++n) id = fallback + '_' + std::to_string(n);
  return id;
}

void CityJsonObjects::append_vertices(const Body& body) {
  for (const GridPoint& p : body.mesh.points) {
    if (next_vertex_++ > 0) vertices_ += ',';
    vertices_ += line_break_;
    vertices_ += '[';
    append_integer(vertices_, p.x);
    vertices_ += ',';
    append_integer(vertices_, p.y);
    vertices_ += ',';
    append_integer(vertices_, p.z);
    vertices_ += ']';
  }
  extent_.add(body.mesh);
}

void CityJsonObjects::append_geometry(const Body& body) {
  const TriangleMesh& mesh = body.mesh;
  const std::vector<SolidFaces> solids = solids_of(mesh);
  objects_ += solids.size() > 1 ? R"({"type":"MultiSolid","lod":)" : R"({"type":"Solid","lod":)";
  append_json_string(objects_, solid_lod(body));
  objects_ += ",\"boundaries\":";
  append_nested(objects_, solids, [&](const FaceRange& faces) {
    for (std::size_t f = faces.begin; f < faces.end; ++f) {
      objects_ += f == faces.begin ? "[" : ",[";
      for (std::size_t r = 0; r < mesh.faces[f].rings.size(); ++r) {
        const Ring& ring = mesh.faces[f].rings[r];
        for (std::size_t i = 0; i < ring.size(); ++i) {
          objects_ += i > 0 ? "," : r > 0 ? ",[" : "[";
          append_integer(objects_, static_cast<std::int64_t>(next_vertex_ + ring[i]));
        }
        objects_ += ']';
      }
      objects_ += ']';
    }
  });

  const Semantics semantics = semantics_of(mesh);
  if (!semantics.surfaces.empty()) {
    objects_ += ",\"semantics\":{\"surfaces\":[";
    for (std::size_t i = 0; i < semantics.surfaces.size(); ++i) {
      const auto& [type, source, made_by] = semantics.surfaces[i];
      objects_ += i == 0 ? "{\"type\":" : ",{\"type\":";
      append_json_string(objects_, to_string(type));
      if (source < mesh.surface_ids.size() && !mesh.surface_ids[source].empty()) {
        objects_ += ",\"id\":";
        append_json_string(objects_, mesh.surface_ids[source]);
      }
      if (!made_by.empty()) {
        objects_ += ",\"citymesh_new\":true,\"citymesh_rung\":";
        append_json_string(objects_, made_by);
      }
      objects_ += '}';
    }
    objects_ += "],\"values\":";
    append_nested(objects_, solids, [&](const FaceRange& faces) {
      for (std::size_t f = faces.begin; f < faces.end; ++f) {
        if (f > faces.begin) objects_ += ',';
        if (semantics.values[f] < 0) {
          objects_ += "null";
        } else {
          append_integer(objects_, semantics.values[f]);
        }
      }
    });
    objects_ += '}';
  }
  objects_ += '}';
}

void CityJsonObjects::append_object(const CityObject& object, const std::string& id,
                                    std::string_view relations) {
  if (std::exchange(any_object_, true)) objects_ += ',';
  objects_ += line_break_;
  append_json_string(objects_, id);
  objects_ += ":{\"type\":";
  append_json_string(objects_, to_string(object.kind));
  if (!object.attributes->empty()) {
    objects_ += ",\"attributes\":{";
    append_attributes(objects_, *object.attributes);
    objects_ += '}';
  }
  if (!object.addresses->empty()) {
    objects_ += ",\"address\":[";
    append_addresses(objects_, *object.addresses);
    objects_ += ']';
  }
  objects_ += relations;
  if (object.body) {
    objects_ += ",\"geometry\":[";
    append_geometry(*object.body);
    append_vertices(*object.body);
    objects_ += ']';
  }
  objects_ += '}';
}

std::string CityJsonObjects::append(const BuildingBodies& building) {
  const std::vector<CityObject> objects = city_objects(building);
  std::vector<std::string> ids;
  ids.reserve(objects.size());
  for (const CityObject& object : objects)
    ids.push_back(unused_id(object.gml_id, object.body ? object.body->name : "building"));

  std::string children;
  for (std::size_t i = 1; i < objects.size(); ++i) {
    children += children.empty() ? ",\"children\":[" : ",";
    append_json_string(children, ids[i]);
  }
  if (!children.empty()) children += ']';
  append_object(objects[0], ids[0], children);

  std::string parents = ",\"parents\":[";
  append_json_string(parents, ids[0]);
  parents += ']';
  for (std::size_t i = 1; i < objects.size(); ++i) append_object(objects[i], ids[i], parents);
  return ids[0];
}

std::string cityjson_head(const Scene& scene) {
  std::string json =
      "\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":"
      "{\"scale\":[0.0001,0.0001,0.0001],\"translate\":[";
  append_exact(json, scene.origin.x);
  json += ',';
  append_exact(json, scene.origin.y);
  json += ',';
  append_exact(json, scene.origin.z);
  return json + "]}";
}

std::string cityjson_metadata(const Scene& scene, const GridExtent& extent) {
  std::string json = "{\"title\":";
  append_json_string(json, scene_text(scene));
  if (!extent.empty) {
    json += ",\"geographicalExtent\":[";
    for (const GridPoint* p : {&extent.min, &extent.max}) {
      if (p == &extent.max) json += ',';
      append_grid(json, absolute_steps(scene.origin.x, p->x));
      json += ',';
      append_grid(json, absolute_steps(scene.origin.y, p->y));
      json += ',';
      append_grid(json, absolute_steps(scene.origin.z, p->z));
    }
    json += ']';
  }
  if (const std::string uri = crs_uri(scene.crs); !uri.empty()) {
    json += ",\"referenceSystem\":";
    append_json_string(json, uri);
  }
  return json + '}';
}

}  // namespace citymesh
