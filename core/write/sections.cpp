#include "core/write/sections.h"

#include "core/write/text.h"

namespace citymesh {

std::string body_record(std::uint64_t number, const BuildingBodies& building, const Body& body) {
  std::string json = "{\"body\":" + std::to_string(number) + ",\"name\":";
  append_json_string(json, body.name);
  json += ",\"gml_id\":";
  append_json_string(json, body.gml_id);
  json += ",\"kind\":";
  append_json_string(json, to_string(body.kind));
  json += ",\"lod\":";
  append_json_string(json, body.lod);
  json += ",\"rung\":";
  append_json_string(json, building.rung);
  json += ",\"points\":" + std::to_string(body.mesh.points.size());
  json += ",\"triangles\":" + std::to_string(body.mesh.triangles.size());
  return json + '}';
}

std::string surface_type_legend() {
  std::string text;
  for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
    if (type > 0) text += ' ';
    text += std::to_string(type) + ' ';
    text += to_string(static_cast<SurfaceType>(type));
  }
  return text;
}

}  // namespace citymesh
