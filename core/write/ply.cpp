#include <cstdint>
#include <limits>

#include "core/write/bytes.h"
#include "core/write/sections.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

/// Binary little-endian PLY (Turk 1994). Points are double, numbered body by body; comments of the
/// header say where the model lies and which body is which.
class PlyContent {
 public:
  static constexpr std::size_t kSections = 3;

  explicit PlyContent(const Scene& scene) : scene_(scene) {}

  Result<void> append(const BuildingBodies& building, std::array<std::string, kSections>& to) {
    auto& [bodies, vertices, faces] = to;
    for (const Body& body : building.bodies) {
      const TriangleMesh& mesh = body.mesh;
      if (mesh.points.size() > kMaxIndex - points_)
        return fail(ErrorCode::FailedPrecondition,
                    "ply: more than 2147483647 points; take a smaller box, or format obj");
      bodies +=
          "comment body " + body_record(static_cast<std::uint64_t>(bodies_), building, body) + '\n';
      for (const GridPoint& p : mesh.points) {
        const Point3 m = to_metres(p);
        append_bytes(vertices, m.x);
        append_bytes(vertices, m.y);
        append_bytes(vertices, m.z);
      }
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        append_bytes(faces, std::uint8_t{3});
        for (const std::uint32_t corner : mesh.triangles[i])
          append_bytes(faces, static_cast<std::int32_t>(points_ + corner));
        append_bytes(faces, bodies_);
        append_bytes(faces, static_cast<std::uint8_t>(mesh.surface_types[i]));
      }
      ++bodies_;
      points_ += mesh.points.size();
      triangles_ += mesh.triangles.size();
    }
    return {};
  }

  Result<void> join(const std::array<std::uint64_t, kSections>&, SectionSink& sink) const {
    std::string head = "ply\nformat binary_little_endian 1.0\ncomment " + generator();
    if (!scene_.process.empty()) head += ' ' + one_line(scene_.process);
    head += "\ncomment crs " + crs_text(scene_);
    head += "\ncomment origin " + origin_text(scene_);
    head += "\ncomment unit metre";
    head += "\ncomment axes " + std::string(kAxes);
    head += "\ncomment absolute coordinates = origin + vertex";
    head += "\ncomment surface_type " + surface_type_legend() + '\n';
    if (auto r = sink.text(head); !r) return r;
    if (auto r = sink.section(0); !r) return r;
    const std::string elements =
        "element vertex " + std::to_string(points_) +
        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
        std::to_string(triangles_) +
        "\nproperty list uchar int vertex_indices\nproperty int body\nproperty uchar surface_type\n"
        "end_header\n";
    if (auto r = sink.text(elements); !r) return r;
    if (auto r = sink.section(1); !r) return r;
    return sink.section(2);
  }

 private:
  static constexpr std::uint64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();

  Scene scene_;
  std::int32_t bodies_ = 0;
  std::uint64_t points_ = 0, triangles_ = 0;
};

}  // namespace

WriterResult open_ply(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene) {
  return SectionedWriter<PlyContent>::open(folder, format, scene);
}

}  // namespace citymesh
