#include "core/write/glb_parts.h"
#include "core/write/json_values.h"
#include "core/write/surface_colours.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

std::vector<GlbMaterial> surface_materials() {
  std::vector<GlbMaterial> materials;
  for (std::size_t type = 0; type < kSurfaceTypeCount; ++type)
    materials.push_back({to_string(static_cast<SurfaceType>(type)), kSurfaceColours[type]});
  return materials;
}

std::string extras_of(const BuildingBodies& building, const Body& body) {
  std::string json = "{\"gml_id\":";
  append_json_string(json, body.gml_id);
  json += ",\"building\":";
  append_json_string(json, building.gml_id);
  json += ",\"kind\":";
  append_json_string(json, to_string(body.kind));
  json += ",\"lod\":";
  append_json_string(json, body.lod);
  json += ",\"rung\":";
  append_json_string(json, building.rung);
  json += ",\"attributes\":{";
  append_attributes(json, body.attributes);
  json += "},\"addresses\":[";
  append_addresses(json, body.addresses);
  return json + "]}";
}

/// A node per body, a primitive per surface type.
class GlbContent {
 public:
  static constexpr std::size_t kSections = GlbParts::kSections;

  explicit GlbContent(const Scene& scene) : parts_(scene, surface_materials()) {}

  Result<void> append(const BuildingBodies& building, std::array<std::string, kSections>& to) {
    for (const Body& body : building.bodies) {
      std::array<std::vector<Triangle>, kSurfaceTypeCount> triangles;
      for (std::size_t i = 0; i < body.mesh.triangles.size(); ++i)
        triangles[static_cast<std::size_t>(body.mesh.surface_types[i])].push_back(
            body.mesh.triangles[i]);
      const std::string extras = extras_of(building, body);
      if (auto r = parts_.append({body.name, extras, body.mesh.points, triangles}, to); !r)
        return r;
    }
    return {};
  }

  Result<void> join(const std::array<std::uint64_t, kSections>& sizes, SectionSink& sink) const {
    return parts_.join(sizes, sink);
  }

 private:
  GlbParts parts_;
};

}  // namespace

WriterResult open_glb(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene) {
  return SectionedWriter<GlbContent>::open(folder, format, scene);
}

}  // namespace citymesh
