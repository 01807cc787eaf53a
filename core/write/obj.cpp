#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

class ObjWriter final : public BodyWriter {
 public:
  ObjWriter(AtomicFile file, std::string header)
      : file_(std::move(file)), header_(std::move(header)) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    std::string text = header_;
    std::uint64_t next_vertex = 1;
    append(text, building, next_vertex);
    return text;
  }

  Result<void> add(const BuildingBodies& building) override {
    buffer_.clear();
    append(buffer_, building, next_vertex_);
    return file_.write(buffer_);
  }

  Result<void> finish() override { return file_.commit(); }

 private:
  static void append(std::string& text, const BuildingBodies& building,
                     std::uint64_t& next_vertex) {
    for (const Body& body : building.bodies) {
      const TriangleMesh& mesh = body.mesh;
      text += "o ";
      text += body.name;
      text += '\n';
      for (const GridPoint& p : mesh.points) {
        text += "v ";
        append_grid(text, p.x);
        text += ' ';
        append_grid(text, p.y);
        text += ' ';
        append_grid(text, p.z);
        text += '\n';
      }
      const TrianglesByType grouped = by_type(mesh);
      for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
        if (grouped.begin[type] == grouped.begin[type + 1]) continue;
        text += "g ";
        text += patch_name(body, static_cast<SurfaceType>(type));
        text += '\n';
        for (std::size_t i = grouped.begin[type]; i < grouped.begin[type + 1]; ++i) {
          text += 'f';
          for (const std::uint32_t corner : mesh.triangles[grouped.order[i]]) {
            text += ' ';
            append_integer(text, static_cast<std::int64_t>(next_vertex + corner));
          }
          text += '\n';
        }
      }
      next_vertex += mesh.points.size();
    }
  }

  AtomicFile file_;
  std::string header_;
  std::string buffer_{};
  std::uint64_t next_vertex_ = 1;  // OBJ counts from 1 through the whole file
};

}  // namespace

WriterResult open_obj(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene) {
  std::string header = "# " + generator();
  if (!scene.process.empty()) header += ' ' + one_line(scene.process);
  header += "\n# crs " + crs_text(scene);
  header += "\n# origin " + origin_text(scene);
  header += "\n# unit metre";
  header += "\n# axes " + std::string(kAxes);
  header += "\n# absolute coordinates = origin + v\n";

  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  if (auto written = file->write(header); !written) return written.error();
  return WriterResult(std::make_unique<ObjWriter>(std::move(*file), std::move(header)));
}

}  // namespace citymesh
