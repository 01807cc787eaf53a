#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/pipeline/pipeline.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using Path = std::filesystem::path;

/// A building in two encodings that hold the same geometry.
struct Pair {
  const char *name, *first, *second;
  const char* first_inputs = "{}";
  const char* second_inputs = "{}";
  bool extra = false;  ///< beside the repository, in CITYMESH_EXTRA_DATA
};

void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

/// model.obj without its comments, which name versions and ids of the run.
std::string mesh_of(const Path& file, const std::string& inputs) {
  const TempFolder output;
  auto source = open_files({file}, {});
  if (!source) return source.error().message;
  const auto outcome = run("export-for-simulation", inputs, **source, output.path(), {});
  if (!outcome) return outcome.error().message;
  EXPECT_GT(outcome->report.bodies, 0u) << file;
  std::ifstream obj(output / "model.obj");
  std::string text;
  for (std::string line; std::getline(obj, line);)
    if (!line.starts_with("#")) text += line + "\n";
  return text;
}

std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream first(a), second(b);
  std::string x, y;
  for (int line = 1;; ++line) {
    const bool more_x = static_cast<bool>(std::getline(first, x));
    const bool more_y = static_cast<bool>(std::getline(second, y));
    if (!more_x && !more_y) return "";
    if (more_x != more_y || x != y)
      return "line " + std::to_string(line) + ": '" + x + "' and '" + y + "'";
  }
}

class SameBuilding : public ::testing::TestWithParam<Pair> {};

TEST_P(SameBuilding, InTwoEncodingsGivesTheSameMesh) {
  const Pair& pair = GetParam();
  Path folder = CITYMESH_TEST_DATA;
  if (pair.extra) {
    const char* extra = std::getenv("CITYMESH_EXTRA_DATA");
    if (!extra) GTEST_SKIP() << "CITYMESH_EXTRA_DATA is not set: no data outside of the repository";
    folder = extra;
  }
  const std::string first = mesh_of(folder / pair.first, pair.first_inputs);
  const std::string second = mesh_of(folder / pair.second, pair.second_inputs);
  EXPECT_EQ(first_difference(first, second), "");
}

INSTANTIATE_TEST_SUITE_P(
    Versions, SameBuilding,
    ::testing::Values(Pair{"lod1", "citygml2/building_lod1.gml", "citygml3/building_lod1.gml"},
                      Pair{"lod2", "citygml2/building_lod2.gml", "citygml3/building_lod2.gml"},
                      Pair{"garage", "citygml2/building_and_garage_lod2.gml",
                           "citygml3/building_and_garage_lod2.gml"},
                      Pair{"dome", "plateau/53394517_bldg_6697_2_op_CityGML2.gml",
                           "plateau/53394517_bldg_6697_2_op_CityGML3.gml", "{}", "{}", true},
                      // CityGML 3.0 has no LoD4: what was the outside of LoD4 is LoD3.
                      Pair{"lod4", "ogc-examples/v2/Building_LOD4-EPSG25832.gml",
                           "ogc-examples/v3/Building_LOD3-EPSG25832.gml", R"({"lod":["4"]})",
                           R"({"lod":["3"]})", true},
                      Pair{"block", "citygml4j-samples/lod2_buildings_v3.gml",
                           "citygml4j-samples/lod2_buildings_v2.json", "{}", "{}", true}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace citymesh
