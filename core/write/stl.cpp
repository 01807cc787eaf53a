#include <cmath>
#include <optional>

#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

void append_vector(std::string& text, std::int64_t x, std::int64_t y, std::int64_t z) {
  append_grid(text, x);
  text += ' ';
  append_grid(text, y);
  text += ' ';
  append_grid(text, z);
  text += '\n';
}

void append_facets(std::string& text, const TriangleMesh& mesh, const TrianglesByType& grouped,
                   std::size_t type) {
  for (std::size_t i = grouped.begin[type]; i < grouped.begin[type + 1]; ++i) {
    const Triangle& triangle = mesh.triangles[grouped.order[i]];
    const Point3 n =
        unit_normal(mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]]);
    text += "facet normal ";
    append_vector(text, std::llround(n.x * kGridStepsPerMetre),
                  std::llround(n.y * kGridStepsPerMetre), std::llround(n.z * kGridStepsPerMetre));
    text += "outer loop\n";
    for (const std::uint32_t corner : triangle) {
      text += "vertex ";
      const GridPoint& p = mesh.points[corner];
      append_vector(text, p.x, p.y, p.z);
    }
    text += "endloop\nendfacet\n";
  }
}

void append_solid(std::string& text, std::string_view name, std::string_view facets) {
  text += "solid ";
  text += name;
  text += '\n';
  text += facets;
  text += "endsolid ";
  text += name;
  text += '\n';
}

// The format has no place for comments: frame and unit of the scene stand in report.json. A file
// without any facet still holds one empty solid, so that readers see what it is.

/// One solid per body and surface type.
class StlWriter final : public BodyWriter {
 public:
  explicit StlWriter(AtomicFile file) : file_(std::move(file)) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    std::string text;
    append(text, building);
    if (text.empty()) append_solid(text, "citymesh", "");
    return text;
  }

  Result<void> add(const BuildingBodies& building) override {
    buffer_.clear();
    append(buffer_, building);
    empty_ = empty_ && buffer_.empty();
    return file_.write(buffer_);
  }

  Result<void> finish() override {
    if (empty_) {
      buffer_.clear();
      append_solid(buffer_, "citymesh", "");
      if (auto written = file_.write(buffer_); !written) return written;
    }
    return file_.commit();
  }

 private:
  static void append(std::string& text, const BuildingBodies& building) {
    std::string facets;
    for (const Body& body : building.bodies) {
      const TrianglesByType grouped = by_type(body.mesh);
      for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
        if (grouped.begin[type] == grouped.begin[type + 1]) continue;
        facets.clear();
        append_facets(facets, body.mesh, grouped, type);
        append_solid(text, patch_name(body, static_cast<SurfaceType>(type)), facets);
      }
    }
  }

  AtomicFile file_;
  std::string buffer_{};
  bool empty_ = true;
};

/// One solid per surface type for the whole scene: each type grows in a file of its own, joined at
/// the end.
class StlByTypeWriter final : public BodyWriter {
 public:
  StlByTypeWriter(AtomicFile file, std::filesystem::path folder, std::string_view file_name)
      : file_(std::move(file)), folder_(std::move(folder)), file_name_(file_name) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    std::string text;
    for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
      const std::string facets = facets_of(building, type);
      if (!facets.empty()) append_solid(text, to_string(static_cast<SurfaceType>(type)), facets);
    }
    if (text.empty()) append_solid(text, "citymesh", "");
    return text;
  }

  Result<void> add(const BuildingBodies& building) override {
    for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
      const std::string facets = facets_of(building, type);
      if (facets.empty()) continue;
      if (!spools_[type]) {
        auto spool = Spool::create(
            folder_,
            file_name_ + " (" + std::string(to_string(static_cast<SurfaceType>(type))) + ")");
        if (!spool) return spool.error();
        spools_[type].emplace(std::move(*spool));
      }
      if (auto written = spools_[type]->write(facets); !written) return written;
    }
    return {};
  }

  Result<void> finish() override {
    bool empty = true;
    for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
      if (!spools_[type]) continue;
      empty = false;
      const std::string name(to_string(static_cast<SurfaceType>(type)));
      if (auto r = file_.write("solid " + name + '\n'); !r) return r;
      if (auto r = file_.append(*spools_[type]); !r) return r;
      if (auto r = file_.write("endsolid " + name + '\n'); !r) return r;
      spools_[type].reset();
    }
    if (empty) {
      std::string text;
      append_solid(text, "citymesh", "");
      if (auto r = file_.write(text); !r) return r;
    }
    return file_.commit();
  }

 private:
  static std::string facets_of(const BuildingBodies& building, std::size_t type) {
    std::string facets;
    for (const Body& body : building.bodies)
      append_facets(facets, body.mesh, by_type(body.mesh), type);
    return facets;
  }

  AtomicFile file_;
  std::filesystem::path folder_;
  std::string file_name_;
  std::array<std::optional<Spool>, kSurfaceTypeCount> spools_{};
};

}  // namespace

WriterResult open_stl(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene) {
  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  if (scene.patches == Patches::ByType)
    return WriterResult(
        std::make_unique<StlByTypeWriter>(std::move(*file), folder, format.file_name));
  return WriterResult(std::make_unique<StlWriter>(std::move(*file)));
}

}  // namespace citymesh
