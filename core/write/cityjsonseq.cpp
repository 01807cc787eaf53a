#include "core/write/cityjson_objects.h"
#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

/// A header line, then a CityJSONFeature per building and line, each with its own vertices. Blanks
/// behind the header keep room for the extent, which is known at the end.
class CityJsonSeqWriter final : public BodyWriter {
 public:
  CityJsonSeqWriter(AtomicFile file, Scene scene)
      : file_(std::move(file)), scene_(std::move(scene)), head_bytes_(head({}).size() + kRoom) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    CityJsonObjects objects("");
    std::string line = feature(objects, building);
    return padded_head(objects.extent()) + line;
  }

  Result<void> begin() { return file_.write(padded_head({})); }

  Result<void> add(const BuildingBodies& building) override {
    return file_.write(feature(objects_, building));
  }

  Result<void> finish() override {
    if (auto r = file_.overwrite(0, padded_head(objects_.extent())); !r) return r;
    return file_.commit();
  }

 private:
  // `,"geographicalExtent":[…]` with six numbers of at most 20 characters.
  static constexpr std::size_t kRoom = 24 + 6 * 21 + 1;

  std::string head(const GridExtent& extent) const {
    return "{" + cityjson_head(scene_) + ",\"metadata\":" + cityjson_metadata(scene_, extent) +
           ",\"CityObjects\":{},\"vertices\":[]}";
  }

  std::string padded_head(const GridExtent& extent) const {
    std::string line = head(extent);
    line.resize(head_bytes_, ' ');
    return line + '\n';
  }

  static std::string feature(CityJsonObjects& objects, const BuildingBodies& building) {
    objects.restart_vertices();
    const std::string id = objects.append(building);
    std::string line = "{\"type\":\"CityJSONFeature\",\"id\":";
    append_json_string(line, id);
    line += ",\"CityObjects\":{" + objects.objects() + "},\"vertices\":[" + objects.vertices();
    return line + "]}\n";
  }

  AtomicFile file_;
  Scene scene_;
  std::size_t head_bytes_;
  CityJsonObjects objects_{""};
};

}  // namespace

WriterResult open_cityjsonseq(const std::filesystem::path& folder, const Format& format,
                              const Scene& scene) {
  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  auto writer = std::make_unique<CityJsonSeqWriter>(std::move(*file), scene);
  if (auto begun = writer->begin(); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

}  // namespace citymesh
