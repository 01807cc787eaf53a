#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/write/bytes.h"
#include "core/write/sections.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

/// An array of the file; its bytes stand behind all XML, after their count.
struct Array {
  std::string_view name;
  std::string_view type;
  int components;
  std::uint64_t bytes;
};

/// VTK's XML unstructured grid with raw appended data. Texts of the field data are UTF-8 bytes in
/// UInt8 arrays: arrays of type String are refused by meshio.
class VtuContent {
 public:
  static constexpr std::size_t kSections = 5;

  explicit VtuContent(const Scene& scene) : scene_(scene) {}

  Result<void> append(const BuildingBodies& building, std::array<std::string, kSections>& to) {
    auto& [bodies, points, connectivity, body_numbers, surface_types] = to;
    for (const Body& body : building.bodies) {
      const TriangleMesh& mesh = body.mesh;
      bodies += body_record(static_cast<std::uint64_t>(bodies_), building, body) + '\n';
      for (const GridPoint& p : mesh.points) {
        const Point3 m = to_metres(p);
        append_bytes(points, m.x);
        append_bytes(points, m.y);
        append_bytes(points, m.z);
      }
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t corner : mesh.triangles[i])
          append_bytes(connectivity, static_cast<std::int64_t>(points_ + corner));
        append_bytes(body_numbers, bodies_);
        append_bytes(surface_types, static_cast<std::uint8_t>(mesh.surface_types[i]));
      }
      ++bodies_;
      points_ += mesh.points.size();
      triangles_ += mesh.triangles.size();
    }
    return {};
  }

  Result<void> join(const std::array<std::uint64_t, kSections>& sizes, SectionSink& sink) const {
    const std::string crs = crs_text(scene_), about = scene_text(scene_),
                      legend = surface_type_legend();
    // In the order in which their bytes follow.
    const std::array<Array, 10> arrays{{{"crs", "UInt8", 1, crs.size()},
                                        {"about", "UInt8", 1, about.size()},
                                        {"surface_types", "UInt8", 1, legend.size()},
                                        {"bodies", "UInt8", 1, sizes[0]},
                                        {"Points", "Float64", 3, sizes[1]},
                                        {"connectivity", "Int64", 1, sizes[2]},
                                        {"offsets", "Int64", 1, 8 * triangles_},
                                        {"types", "UInt8", 1, triangles_},
                                        {"body", "Int32", 1, sizes[3]},
                                        {"surface_type", "UInt8", 1, sizes[4]}}};
    if (auto r = sink.text(head(arrays)); !r) return r;
    for (const Array& array : arrays) {
      std::string count;
      append_bytes(count, array.bytes);
      if (auto r = sink.text(count); !r) return r;
      auto r = array.name == "crs"             ? sink.text(crs)
               : array.name == "about"         ? sink.text(about)
               : array.name == "surface_types" ? sink.text(legend)
               : array.name == "bodies"        ? sink.section(0)
               : array.name == "Points"        ? sink.section(1)
               : array.name == "connectivity"  ? sink.section(2)
               : array.name == "offsets"       ? offsets(sink)
               : array.name == "types"         ? types(sink)
               : array.name == "body"          ? sink.section(3)
                                               : sink.section(4);
      if (!r) return r;
    }
    return sink.text("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  static constexpr std::uint64_t kPiece = 1 << 16;  ///< triangles whose numbers are made at a time
  static constexpr std::uint8_t kTriangleCell = 5;  ///< VTK_TRIANGLE

  std::string head(const std::array<Array, 10>& arrays) const {
    std::uint64_t offset = 0;
    std::size_t next = 0;
    const auto data_array = [&](std::uint64_t tuples = 0) {
      const Array& array = arrays[next++];
      std::string xml = "<DataArray type=\"" + std::string(array.type) + "\" Name=\"" +
                        std::string(array.name) + "\" NumberOfComponents=\"" +
                        std::to_string(array.components) + '"';
      if (tuples > 0) xml += " NumberOfTuples=\"" + std::to_string(tuples) + '"';
      xml += " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
      offset += sizeof(std::uint64_t) + array.bytes;
      return xml;
    };
    std::string origin;
    append_exact(origin, scene_.origin.x);
    origin += ' ';
    append_exact(origin, scene_.origin.y);
    origin += ' ';
    append_exact(origin, scene_.origin.z);

    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n"
        "<DataArray type=\"Float64\" Name=\"origin\" NumberOfComponents=\"3\" "
        "NumberOfTuples=\"1\" format=\"ascii\">" +
        origin + "</DataArray>\n";
    for (int i = 0; i < 4; ++i) xml += data_array(arrays[next].bytes);
    xml += "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(points_) +
           "\" NumberOfCells=\"" + std::to_string(triangles_) + "\">\n<Points>\n" + data_array() +
           "</Points>\n<Cells>\n";
    for (int i = 0; i < 3; ++i) xml += data_array();
    xml += "</Cells>\n<CellData Scalars=\"surface_type\">\n";
    for (int i = 0; i < 2; ++i) xml += data_array();
    return xml + "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  }

  Result<void> offsets(SectionSink& sink) const {
    std::string bytes;
    for (std::uint64_t i = 0; i < triangles_;) {
      bytes.clear();
      for (const std::uint64_t end = std::min(triangles_, i + kPiece); i < end; ++i)
        append_bytes(bytes, static_cast<std::int64_t>(3 * (i + 1)));
      if (auto r = sink.text(bytes); !r) return r;
    }
    return {};
  }

  Result<void> types(SectionSink& sink) const {
    for (std::uint64_t i = 0; i < triangles_; i += kPiece)
      if (auto r = sink.text(std::string(static_cast<std::size_t>(std::min(kPiece, triangles_ - i)),
                                         static_cast<char>(kTriangleCell)));
          !r)
        return r;
    return {};
  }

  Scene scene_;
  std::int32_t bodies_ = 0;
  std::uint64_t points_ = 0, triangles_ = 0;
};

}  // namespace

WriterResult open_vtu(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene) {
  return SectionedWriter<VtuContent>::open(folder, format, scene);
}

}  // namespace citymesh
