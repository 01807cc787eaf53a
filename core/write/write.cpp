#include "core/write/write.h"

#include <array>
#include <cmath>

#include "core/base/version.h"
#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

constexpr std::array kFormats{
    Format{"obj", "model.obj", "model/obj", "",
           "Wavefront OBJ, an object per body, a group per surface type", false, 35},
    Format{"stl", "model.stl", "model/stl", "", "ASCII STL, a solid per body and surface type",
           false, 165},
    Format{"stl_binary", "model_binary.stl", "model/stl", "model_binary.patches.json",
           "Binary STL with a list of triangle ranges beside it", false, 62},
    Format{"ply", "model.ply", "application/ply", "",
           "Binary PLY, double coordinates, body and surface type of every triangle", false, 36},
    Format{"vtu", "model.vtu", "application/vnd.vtk.vtu+xml", "",
           "VTK unstructured grid, body and surface type of every triangle", false, 56},
    Format{"glb", "model.glb", "model/gltf-binary", "",
           "glTF 2.0 binary, a node per body, a material per surface type", false, 44},
    Format{"cityjson", "model.city.json", "application/city+json", "",
           "CityJSON 2.0 with ids, attributes, addresses and semantics", true, 60},
    Format{"cityjsonseq", "model.city.jsonl", "application/city+json-seq", "",
           "CityJSONSeq 2.0, a building per line", true, 58},
    Format{"citygml2", "model.gml", "application/gml+xml", "",
           "CityGML 2.0 with ids, attributes, addresses and semantics", true, 250},
    Format{"citygml3", "model.citygml3.gml", "application/gml+xml", "",
           "CityGML 3.0 with ids, attributes, addresses and semantics", true, 260},
};
constexpr std::array kOpen{open_obj, open_stl,      open_stl_binary,  open_ply,      open_vtu,
                           open_glb, open_cityjson, open_cityjsonseq, open_citygml2, open_citygml3};
static_assert(kFormats.size() == kOpen.size());

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format* find_format(std::string_view key) {
  for (const Format& format : kFormats)
    if (format.key == key) return &format;
  return nullptr;
}

std::string format_keys() {
  std::string keys;
  for (const Format& format : kFormats) {
    if (!keys.empty()) keys += ", ";
    keys += format.key;
  }
  return keys;
}

Result<std::unique_ptr<BodyWriter>> open_writer(const Format& format,
                                                const std::filesystem::path& folder,
                                                const Scene& scene) {
  for (std::size_t i = 0; i < kFormats.size(); ++i)
    if (kFormats[i].key == format.key) return kOpen[i](folder, kFormats[i], scene);
  return fail(ErrorCode::Unimplemented, "format \"" + std::string(format.key) +
                                            "\" is not available; available: " + format_keys());
}

std::string generator() { return "citymesh " + std::string(version()); }

std::string crs_text(const Scene& scene) {
  return scene.crs.id.empty() ? "unknown" : one_line(scene.crs.id);
}

std::string origin_text(const Scene& scene) {
  std::string text;
  append_number(text, scene.origin.x, 4);
  text += ' ';
  append_number(text, scene.origin.y, 4);
  text += ' ';
  append_number(text, scene.origin.z, 4);
  return text;
}

std::string scene_text(const Scene& scene) {
  std::string text = generator();
  if (!scene.process.empty()) text += ' ' + one_line(scene.process);
  return text + "; crs " + crs_text(scene) + "; unit metre; axes " + std::string(kAxes) +
         "; origin " + origin_text(scene);
}

TrianglesByType by_type(const TriangleMesh& mesh) {
  TrianglesByType grouped;
  for (const SurfaceType type : mesh.surface_types)
    ++grouped.begin[static_cast<std::size_t>(type) + 1];
  for (std::size_t i = 1; i <= kSurfaceTypeCount; ++i) grouped.begin[i] += grouped.begin[i - 1];
  auto next = grouped.begin;
  grouped.order.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    grouped.order[next[static_cast<std::size_t>(mesh.surface_types[i])]++] =
        static_cast<std::uint32_t>(i);
  return grouped;
}

Point3 unit_normal(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const auto minus = [](const GridPoint& p, const GridPoint& q) {
    return Point3{static_cast<double>(p.x - q.x), static_cast<double>(p.y - q.y),
                  static_cast<double>(p.z - q.z)};
  };
  const Point3 u = minus(b, a), v = minus(c, a);
  const Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (!(length > 0)) return {};
  return {n.x / length, n.y / length, n.z / length};
}

std::string patch_name(const Body& body, SurfaceType type) {
  return body.name + "__" + std::string(to_string(type));
}

Result<void> write_run_json(const std::filesystem::path& folder, const RunTimings& timings) {
  auto file = AtomicFile::create(folder / "run.json");
  if (!file) return file.error();
  std::string text = "{\n  \"stages_s\": {";
  for (std::size_t i = 0; i < timings.stages_s.size(); ++i) {
    text += i == 0 ? "\n    " : ",\n    ";
    append_json_string(text, timings.stages_s[i].first);
    text += ": ";
    append_number(text, timings.stages_s[i].second);
  }
  text += timings.stages_s.empty() ? "},\n  \"total_s\": " : "\n  },\n  \"total_s\": ";
  append_number(text, timings.total_s);
  text += ",\n  \"threads\": ";
  append_integer(text, timings.threads);
  text += ",\n  \"host\": ";
  append_json_string(text, timings.host);
  text += "\n}\n";
  if (auto written = file->write(text); !written) return written;
  return file->commit();
}

}  // namespace citymesh
