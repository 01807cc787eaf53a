#include "tests/support/defects/city_files.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

namespace citymesh::testing {
namespace {

constexpr double kEast_m = 392000, kNorth_m = 5820000;  ///< corner of the city in EPSG:25833
constexpr double kScale = 1e4;                          ///< steps of the file in a metre

/// Steps of all vertices of a file, each once.
class Vertices {
 public:
  std::size_t index_of(const Point3& p) {
    const std::array<long long, 3> key{std::llround(p.x * kScale), std::llround(p.y * kScale),
                                       std::llround(p.z * kScale)};
    const auto [at, added] = known_.emplace(key, known_.size());
    if (added)
      text_ += fmt::format("{}[{},{},{}]", text_.empty() ? "" : ",\n", key[0], key[1], key[2]);
    return at->second;
  }
  const std::string& text() const { return text_; }

 private:
  std::map<std::array<long long, 3>, std::size_t> known_;
  std::string text_;
};

std::string object_of(const DefectiveHouse& house, Vertices& vertices) {
  const Geometry& geometry = house.building.geometries[0];
  std::string faces, surfaces, values;
  for (std::size_t i = 0; i < geometry.polygons.size(); ++i) {
    const Polygon& polygon = geometry.polygons[i];
    const std::string_view comma = i ? "," : "";
    std::string rings;
    for (const Ring& ring : polygon.rings) {
      std::string corners;
      for (const std::uint32_t corner : ring)
        corners += fmt::format("{}{}", corners.empty() ? "" : ",",
                               vertices.index_of(geometry.points[corner]));
      rings += fmt::format("{}[{}]", rings.empty() ? "" : ",", corners);
    }
    const Surface& surface = house.building.surfaces[static_cast<std::size_t>(polygon.surface)];
    faces += fmt::format("{}[{}]", comma, rings);
    surfaces += fmt::format(R"({}{{"type":"{}","id":"{}"}})", comma, to_string(surface.type),
                            surface.gml_id);
    values += fmt::format("{}{}", comma, i);
  }
  const bool solid = geometry.type == GeometryType::Solid;
  return fmt::format(
      R"("{}":{{"type":"Building","geometry":[{{"type":"{}","lod":"2","boundaries":{}{}{},)"
      R"("semantics":{{"surfaces":[{}],"values":{}{}{}}}}}]}})",
      house.building.gml_id, solid ? "Solid" : "MultiSurface", solid ? "[[" : "[", faces,
      solid ? "]]" : "]", surfaces, solid ? "[[" : "[", values, solid ? "]]" : "]");
}

}  // namespace

void write_city(const std::vector<DefectiveHouse>& city, std::ostream& file) {
  Vertices vertices;
  file << R"({"type":"CityJSON","version":"2.0",)"
       << fmt::format(R"("transform":{{"scale":[{0},{0},{0}],"translate":[{1},{2},0]}},)",
                      1 / kScale, kEast_m, kNorth_m)
       << R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25833"},)"
       << "\n\"CityObjects\":{\n";
  for (std::size_t i = 0; i < city.size(); ++i)
    file << (i ? ",\n" : "") << object_of(city[i], vertices);
  file << "},\n\"vertices\":[\n" << vertices.text() << "]}\n";
}

void write_truth(const std::vector<DefectiveHouse>& city, std::ostream& file) {
  file << "# gml_id\tshape\tdefects\tvolume_m3\tundefined_m3\n";
  for (const DefectiveHouse& house : city) {
    std::string defects;
    for (const Defect defect : house.defects)
      defects += fmt::format("{}{}", defects.empty() ? "" : "+", to_string(defect));
    file << fmt::format("{}\t{}\t{}\t{:.4f}\t{:.4f}\n", house.building.gml_id, house.shape,
                        defects.empty() ? "-" : defects, house.volume_m3, house.undefined_m3);
  }
}

}  // namespace citymesh::testing
