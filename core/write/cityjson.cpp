#include "core/write/cityjson_objects.h"
#include "core/write/output.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

/// Vertices stand behind all objects: they wait in a spool.
class CityJsonWriter final : public BodyWriter {
 public:
  CityJsonWriter(AtomicFile file, Spool vertices, Scene scene)
      : file_(std::move(file)), vertices_(std::move(vertices)), scene_(std::move(scene)) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    CityJsonObjects objects("\n");
    objects.append(building);
    return head() + objects.objects() + middle(objects.extent()) + objects.vertices() +
           std::string(kTail);
  }

  Result<void> begin() { return file_.write(head()); }

  Result<void> add(const BuildingBodies& building) override {
    objects_.clear_text();
    objects_.append(building);
    if (auto written = file_.write(objects_.objects()); !written) return written;
    return vertices_.write(objects_.vertices());
  }

  Result<void> finish() override {
    if (auto r = file_.write(middle(objects_.extent())); !r) return r;
    if (auto r = file_.append(vertices_); !r) return r;
    if (auto r = file_.write(kTail); !r) return r;
    return file_.commit();
  }

 private:
  static constexpr std::string_view kTail = "\n]}\n";

  std::string head() const { return "{" + cityjson_head(scene_) + ",\n\"CityObjects\":{"; }

  /// From the end of the objects to the first vertex; the extent is known only here.
  std::string middle(const GridExtent& extent) const {
    return "\n},\n\"metadata\":" + cityjson_metadata(scene_, extent) + ",\n\"vertices\":[";
  }

  AtomicFile file_;
  Spool vertices_;
  Scene scene_;
  CityJsonObjects objects_{"\n"};
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
