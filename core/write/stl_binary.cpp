#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "core/write/bytes.h"
#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

// Layout: 80 bytes of text, uint32 triangle count, then 50 bytes per triangle (normal and three
// corners as float32, uint16 0), all little-endian. Names stand in the sidecar.
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kTriangleBytes = 50;

// Up to here the nearest float32 is nearer to its grid point than to any other.
constexpr std::int64_t kFloat32Limit_m = 1024;
constexpr auto kFloat32Limit = kFloat32Limit_m * static_cast<std::int64_t>(kGridStepsPerMetre);

void append_point(std::string& bytes, const Point3& p) {
  append_bytes(bytes, static_cast<float>(p.x));
  append_bytes(bytes, static_cast<float>(p.y));
  append_bytes(bytes, static_cast<float>(p.z));
}

void append_triangles(std::string& bytes, const TriangleMesh& mesh, const TrianglesByType& grouped,
                      std::size_t type) {
  for (std::size_t i = grouped.begin[type]; i < grouped.begin[type + 1]; ++i) {
    const Triangle& triangle = mesh.triangles[grouped.order[i]];
    append_point(bytes, unit_normal(mesh.points[triangle[0]], mesh.points[triangle[1]],
                                    mesh.points[triangle[2]]));
    for (const std::uint32_t corner : triangle) append_point(bytes, to_metres(mesh.points[corner]));
    bytes.append(2, '\0');
  }
}

Result<void> check_range(const BuildingBodies& building) {
  for (const Body& body : building.bodies) {
    std::int64_t reach = 0;
    for (const GridPoint& p : body.mesh.points)
      reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (reach <= kFloat32Limit) continue;
    std::string message = "stl_binary: body ";
    append_json_string(message, body.name);
    message += " reaches ";
    append_grid(message, reach);
    message +=
        " m from the origin; float32 holds the 0.1 mm grid only up to 1024 m: use format "
        "stl (ASCII), or a smaller box";
    return fail(ErrorCode::FailedPrecondition, std::move(message));
  }
  return {};
}

void append_range(std::string& json, std::uint64_t first, std::uint64_t count) {
  json += ", \"first_triangle\": ";
  append_integer(json, static_cast<std::int64_t>(first));
  json += ", \"triangle_count\": ";
  append_integer(json, static_cast<std::int64_t>(count));
}

void append_body(std::string& json, const Body& body) {
  json += "\"body\": ";
  append_json_string(json, body.name);
  json += ", \"gml_id\": ";
  append_json_string(json, body.gml_id);
}

/// The head of the sidecar up to the opening of `patches`.
std::string sidecar_head(const Scene& scene, std::string_view file_name) {
  std::string json = "{\n\"generator\": ";
  append_json_string(json, generator());
  json += ",\n\"process\": ";
  append_json_string(json, scene.process);
  json += ",\n\"file\": ";
  append_json_string(json, file_name);
  json += ",\n\"crs\": ";
  append_json_string(json, scene.crs.id);
  json += ",\n\"origin\": [";
  append_exact(json, scene.origin.x);
  json += ", ";
  append_exact(json, scene.origin.y);
  json += ", ";
  append_exact(json, scene.origin.z);
  json += "],\n\"unit\": \"metre\",\n\"axes\": ";
  append_json_string(json, kAxes);
  json += ",\n\"patches\": [";
  return json;
}

std::string sidecar_tail(std::uint64_t triangles) {
  std::string json = "\n],\n\"triangles\": ";
  append_integer(json, static_cast<std::int64_t>(triangles));
  json += "\n}\n";
  return json;
}

std::string stl_header(const Scene& scene) {
  std::string header = generator() + ", " + crs_text(scene) + ", origin " + origin_text(scene) +
                       ", metre, east north up";
  header.resize(kHeaderBytes, ' ');
  return header;
}

/// Triangles and ranges under construction: of one building, or of the whole file.
struct Pieces {
  std::string triangles{};
  std::string ranges{};
  std::uint64_t first = 0;  ///< number of the next triangle
  bool any = false;         ///< a range was written before
};

/// One range per body and surface type.
void append_by_object(Pieces& pieces, const BuildingBodies& building) {
  for (const Body& body : building.bodies) {
    const TrianglesByType grouped = by_type(body.mesh);
    for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
      const std::size_t count = grouped.begin[type + 1] - grouped.begin[type];
      if (count == 0) continue;
      append_triangles(pieces.triangles, body.mesh, grouped, type);
      pieces.ranges += std::exchange(pieces.any, true) ? ",\n{\"name\": " : "\n{\"name\": ";
      append_json_string(pieces.ranges, patch_name(body, static_cast<SurfaceType>(type)));
      pieces.ranges += ", ";
      append_body(pieces.ranges, body);
      pieces.ranges += ", \"surface_type\": ";
      append_json_string(pieces.ranges, to_string(static_cast<SurfaceType>(type)));
      append_range(pieces.ranges, pieces.first, count);
      pieces.ranges += '}';
      pieces.first += count;
    }
  }
}

/// The triangles of one surface type; ranges say which body they belong to, counted from the first
/// of the type.
void append_one_type(Pieces& pieces, const BuildingBodies& building, std::size_t type) {
  for (const Body& body : building.bodies) {
    const TrianglesByType grouped = by_type(body.mesh);
    const std::size_t count = grouped.begin[type + 1] - grouped.begin[type];
    if (count == 0) continue;
    append_triangles(pieces.triangles, body.mesh, grouped, type);
    pieces.ranges += std::exchange(pieces.any, true) ? ",\n  {" : "\n  {";
    append_body(pieces.ranges, body);
    append_range(pieces.ranges, pieces.first, count);
    pieces.ranges += '}';
    pieces.first += count;
  }
}

std::string type_entry_head(std::size_t type, std::uint64_t first, std::uint64_t count,
                            bool leading) {
  const std::string_view name = to_string(static_cast<SurfaceType>(type));
  std::string json = leading ? "\n{\"name\": " : ",\n{\"name\": ";
  append_json_string(json, name);
  json += ", \"surface_type\": ";
  append_json_string(json, name);
  append_range(json, first, count);
  json += ", \"bodies\": [";
  return json;
}

class BinaryStlWriter final : public BodyWriter {
 public:
  BinaryStlWriter(AtomicFile file, AtomicFile sidecar, Scene scene, std::filesystem::path folder,
                  const Format& format)
      : file_(std::move(file)),
        sidecar_(std::move(sidecar)),
        scene_(std::move(scene)),
        folder_(std::move(folder)),
        format_(format) {}

  /// The triangles, and behind them the sidecar.
  Result<std::string> encode(const BuildingBodies& building) const override {
    if (auto fits = check_range(building); !fits) return fits.error();
    Pieces whole;
    if (scene_.patches == Patches::ByObject) {
      append_by_object(whole, building);
    } else {
      for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
        Pieces pieces;
        append_one_type(pieces, building, type);
        if (pieces.first == 0) continue;
        whole.ranges += type_entry_head(type, whole.first, pieces.first, !whole.any);
        whole.ranges += pieces.ranges + "]}";
        whole.triangles += pieces.triangles;
        whole.first += pieces.first;
        whole.any = true;
      }
    }
    std::string bytes = stl_header(scene_);
    append_bytes(bytes, static_cast<std::uint32_t>(whole.first));
    return bytes + whole.triangles + sidecar_head(scene_, format_.file_name) + whole.ranges +
           sidecar_tail(whole.first);
  }

  Result<void> add(const BuildingBodies& building) override {
    if (auto fits = check_range(building); !fits) return fits;
    return scene_.patches == Patches::ByObject ? add_by_object(building) : add_by_type(building);
  }

  Result<void> finish() override {
    std::uint64_t total = first_;
    if (scene_.patches == Patches::ByType) {
      for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
        if (!types_[type]) continue;
        PerType& entry = *types_[type];
        const std::string head = type_entry_head(type, total, entry.first, total == 0);
        if (auto r = sidecar_.write(head); !r) return r;
        if (auto r = sidecar_.append(entry.ranges); !r) return r;
        if (auto r = sidecar_.write("]}"); !r) return r;
        if (auto r = file_.append(entry.triangles); !r) return r;
        total += entry.first;
        types_[type].reset();
      }
    }
    if (total > std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorCode::FailedPrecondition,
                  "stl_binary: the scene has " + std::to_string(total) +
                      " triangles; the format counts up to 4294967295: use format stl (ASCII)");
    if (auto r = sidecar_.write(sidecar_tail(total)); !r) return r;
    std::string count;
    append_bytes(count, static_cast<std::uint32_t>(total));
    if (auto r = file_.overwrite(kHeaderBytes, count); !r) return r;
    if (auto r = sidecar_.commit(); !r) return r;
    return file_.commit();
  }

 private:
  struct PerType {
    Spool triangles;
    Spool ranges;
    std::uint64_t first = 0;
  };

  Result<void> add_by_object(const BuildingBodies& building) {
    Pieces pieces{.first = first_, .any = first_ > 0};
    append_by_object(pieces, building);
    first_ = pieces.first;
    if (auto written = file_.write(pieces.triangles); !written) return written;
    return sidecar_.write(pieces.ranges);
  }

  Result<void> add_by_type(const BuildingBodies& building) {
    for (std::size_t type = 0; type < kSurfaceTypeCount; ++type) {
      const std::uint64_t before = types_[type] ? types_[type]->first : 0;
      Pieces pieces{.first = before, .any = before > 0};
      append_one_type(pieces, building, type);
      if (pieces.first == before) continue;
      if (!types_[type]) {
        const std::string name(format_.file_name);
        auto triangles = Spool::create(folder_, name);
        if (!triangles) return triangles.error();
        auto ranges = Spool::create(folder_, name + " (patches)");
        if (!ranges) return ranges.error();
        types_[type].emplace(PerType{std::move(*triangles), std::move(*ranges)});
      }
      types_[type]->first = pieces.first;
      if (auto r = types_[type]->triangles.write(pieces.triangles); !r) return r;
      if (auto r = types_[type]->ranges.write(pieces.ranges); !r) return r;
    }
    return {};
  }

  AtomicFile file_;
  AtomicFile sidecar_;
  Scene scene_;
  std::filesystem::path folder_;
  Format format_;
  std::uint64_t first_ = 0;
  std::array<std::optional<PerType>, kSurfaceTypeCount> types_{};
};

}  // namespace

WriterResult open_stl_binary(const std::filesystem::path& folder, const Format& format,
                             const Scene& scene) {
  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  auto sidecar = AtomicFile::create(folder / format.sidecar);
  if (!sidecar) return sidecar.error();
  std::string head = stl_header(scene);
  append_bytes(head, std::uint32_t{0});  // replaced when the file is complete
  if (auto written = file->write(head); !written) return written.error();
  if (auto written = sidecar->write(sidecar_head(scene, format.file_name)); !written)
    return written.error();
  return WriterResult(std::make_unique<BinaryStlWriter>(std::move(*file), std::move(*sidecar),
                                                        scene, folder, format));
}

}  // namespace citymesh
