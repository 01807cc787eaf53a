// What citymesh wrote as a city model, citymesh reads as the same city model, and makes the same
// mesh of it, byte by byte.
#include <gtest/gtest.h>

#include <array>
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
  return run("export-for-simulation", R"({"lod":["3","2","1"],"formats":[)" + formats + "]}",
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

/// A mesh without the line that names the CRS: CityJSON has no form for a compound one.
std::string without_crs(std::string mesh) {
  const auto at = mesh.find("# crs ");
  return at == std::string::npos ? mesh : mesh.erase(at, mesh.find('\n', at) - at);
}

/// Type and id of the surface of every face, in order.
std::vector<std::pair<std::string, std::string>> surfaces_of(const nlohmann::json& geometry) {
  std::vector<std::pair<std::string, std::string>> faces;
  if (!geometry.contains("semantics")) return faces;
  for (const auto& value : geometry["semantics"]["values"].flatten()) {
    const auto& surface = geometry["semantics"]["surfaces"][value.get<std::size_t>()];
    faces.emplace_back(surface["type"], surface.value("id", ""));
  }
  return faces;
}

/// A surface that had no id may have got one, a repeated id a number.
void expect_same_geometry(const nlohmann::json& read, const nlohmann::json& written,
                          const std::string& where) {
  ASSERT_EQ(read.size(), written.size()) << where;
  for (std::size_t g = 0; g < read.size(); ++g) {
    EXPECT_EQ(read[g]["boundaries"], written[g]["boundaries"]) << where;
    EXPECT_EQ(read[g]["lod"].get<std::string>()[0], written[g]["lod"].get<std::string>()[0])
        << where;
    const auto after = surfaces_of(read[g]), before = surfaces_of(written[g]);
    ASSERT_EQ(after.size(), before.size()) << where;
    for (std::size_t f = 0; f < after.size(); ++f) {
      EXPECT_EQ(after[f].first, before[f].first) << where << " face " << f;
      EXPECT_TRUE(after[f].second.starts_with(before[f].second)) << where << " face " << f;
    }
  }
}

/// A file of tests/data, or of CITYMESH_EXTRA_DATA.
struct Case {
  std::string file;
  bool xml_ids = true;    ///< XML can hold the ids of its objects
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
    EXPECT_TRUE(without_crs(test::read_file(second.path() / "model.obj")) == without_crs(mesh))
        << key;
    const auto again = model_of(second.path());
    EXPECT_EQ(again["transform"], model["transform"]) << key;
    EXPECT_EQ(again["metadata"].value("referenceSystem", ""),
              model["metadata"].value("referenceSystem", ""))
        << key;
    ASSERT_EQ(again["CityObjects"].size(), model["CityObjects"].size()) << key;
    if (key.starts_with("citygml") && !GetParam().xml_ids) continue;
    for (const auto& [id, object] : model["CityObjects"].items()) {
      ASSERT_TRUE(again["CityObjects"].contains(id)) << key << " " << id;
      const auto& other = again["CityObjects"][id];
      for (const char* member : {"type", "attributes", "address", "parents", "children"})
        EXPECT_EQ(other.value(member, nlohmann::json()), object.value(member, nlohmann::json()))
            << key << " " << id << " " << member;
      if (object.contains("geometry"))
        expect_same_geometry(other["geometry"], object["geometry"], std::string(key) + " " + id);
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
                      Case{"cityjson/rotterdam_subset.json", false},
                      Case{"cityjson/building_with_innerring.city.json", false},
                      Case{"cityjson/lod2_buildings_v2.json"},
                      Case{"vienna-lod2/Fichtegasse.gml", true, true},
                      Case{"ingolstadt-lod3/4018106.xml", false, true}),
    test_name);

}  // namespace
}  // namespace citymesh
