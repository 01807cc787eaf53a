// What citymesh wrote as a city model, citymesh reads as the same city model, and makes the same
// mesh of it, byte by byte.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/pipeline/pipeline.h"
#include "core/write/write.h"
#include "tests/unit/write/files.h"

namespace citymesh {
namespace {

using Path = std::filesystem::path;

constexpr std::array<std::string_view, 4> kModelFormats{"cityjson", "cityjsonseq", "citygml2",
                                                        "citygml3"};

Result<RunOutcome> run_on(const Path& file, const Path& folder, const std::string& formats) {
  auto source = open_files({file}, {});
  if (!source) return source.error();
  return run("export-for-simulation",
             R"({"installations":"keep","lod":["3","2","1"],"formats":[)" + formats + "]}",
             **source, folder, {});
}

/// Attributes that formats hold as another type of the same value become its text.
void unify_attributes(nlohmann::json& object) {
  if (!object.contains("attributes")) return;
  for (auto& [name, value] : object["attributes"].items()) {
    if (value.is_boolean()) value = value.get<bool>() ? "true" : "false";
    if (value.is_number()) value = value.get<double>();
  }
}

/// The objects of a CityJSON file without what the format of a round trip cannot keep.
nlohmann::json model_of(const Path& folder) {
  auto model = nlohmann::json::parse(test::read_file(folder / "model.city.json"));
  for (auto& [id, object] : model["CityObjects"].items()) unify_attributes(object);
  return model;
}

struct Case {
  std::string file;
  bool has_ids = true;    ///< every surface and polygon has one: no format makes up any
  bool in_extra = false;  ///< below CITYMESH_EXTRA_DATA
};

class RoundTrip : public ::testing::TestWithParam<Case> {};

std::string test_name(const ::testing::TestParamInfo<Case>& info) {
  std::string name = info.param.file;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

TEST_P(RoundTrip, GivesTheSameCityModelAndTheSameMesh) {
  Path file = Path(CITYMESH_TEST_DATA) / GetParam().file;
  if (GetParam().in_extra) {
    const char* extra = std::getenv("CITYMESH_EXTRA_DATA");
    if (extra == nullptr) GTEST_SKIP() << "CITYMESH_EXTRA_DATA names no folder of data";
    file = Path(extra) / GetParam().file;
  }
  test::TemporaryFolder first;
  const auto written =
      run_on(file, first.path(), R"("obj","cityjson","cityjsonseq","citygml2","citygml3")");
  ASSERT_TRUE(written) << written.error().message;
  ASSERT_GT(written->report.counts.delivered, 0u);
  const std::string mesh = test::read_file(first.path() / "model.obj");
  const auto model = model_of(first.path());

  for (const std::string_view key : kModelFormats) {
    test::TemporaryFolder second;
    const auto read =
        run_on(first.path() / find_format(key)->file_name, second.path(), "\"obj\",\"cityjson\"");
    ASSERT_TRUE(read) << key << ": " << read.error().message;
    EXPECT_EQ(read->report.counts.delivered, written->report.counts.delivered) << key;
    for (const auto& [rung, count] : read->report.rungs) EXPECT_EQ(rung, "as_is") << key;
    EXPECT_TRUE(test::read_file(second.path() / "model.obj") == mesh) << key;
    const auto again = model_of(second.path());
    EXPECT_EQ(again["transform"], model["transform"]) << key;
    EXPECT_EQ(again["metadata"]["referenceSystem"], model["metadata"]["referenceSystem"]) << key;
    ASSERT_EQ(again["CityObjects"].size(), model["CityObjects"].size()) << key;
    for (const auto& [id, object] : model["CityObjects"].items()) {
      ASSERT_TRUE(again["CityObjects"].contains(id)) << key << " " << id;
      const auto& other = again["CityObjects"][id];
      for (const char* member : {"type", "attributes", "address", "parents", "children"})
        EXPECT_EQ(other.value(member, nlohmann::json()), object.value(member, nlohmann::json()))
            << key << " " << id << " " << member;
      if (!GetParam().has_ids || !object.contains("geometry")) continue;
      EXPECT_EQ(other["geometry"], object["geometry"]) << key << " " << id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Data, RoundTrip,
    ::testing::Values(Case{"berlin/3920_5820.gml"}, Case{"fzk-haus/fzk_haus_lod2_v2.gml"},
                      Case{"fzk-haus/fzk_haus_lod3_v2.gml"},
                      Case{"citygml2/building_and_garage_lod2.gml"},
                      Case{"citygml2/building_lod3.gml"}, Case{"citygml2/delft_lod1.gml"},
                      Case{"citygml1/saxony_lod2.gml.gz"}, Case{"citygml1/zurich_lod2.gml"},
                      Case{"cityjson/rotterdam_subset.json"},
                      Case{"cityjson/building_with_innerring.city.json"},
                      Case{"cityjson/lod2_buildings_v2.json"}),
    test_name);

}  // namespace
}  // namespace citymesh
