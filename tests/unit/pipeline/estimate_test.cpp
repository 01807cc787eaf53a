#include "core/pipeline/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/pipeline/pipeline.h"
#include "core/write/write.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Path = std::filesystem::path;

Path data(const std::string& name) { return Path(CITYMESH_TEST_DATA) / name; }

Result<Estimate> estimated(std::vector<Path> files, const std::string& inputs = "{}",
                           std::string_view process = "export-for-simulation") {
  auto source = open_files(std::move(files), {});
  if (!source) return source.error();
  return estimate(process, inputs, **source, {});
}

std::uint64_t bytes_of(const Estimate& estimate, const std::string& output) {
  for (const auto& expected : estimate.outputs)
    if (expected.output == output) return expected.bytes;
  ADD_FAILURE() << output;
  return 0;
}

TEST(EstimateTest, CountsTheBuildingsThatTheRunWillProcess) {
  const auto whole = estimated({data("berlin/3920_5820.gml")});
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(whole->buildings, 6u);
  EXPECT_EQ(whole->crs, "EPSG:25833");
  EXPECT_THAT(whole->problems, IsEmpty());
  const auto none = estimated({data("berlin/3920_5820.gml")}, R"({"bbox":{"bbox":[0,0,1,1]}})");
  ASSERT_TRUE(none);
  EXPECT_EQ(none->buildings, 0u);
  EXPECT_THAT(none->problems, ElementsAre(HasSubstr("no building is selected")));
}

TEST(EstimateTest, SizesAreRightWithinAFactorOfThree) {
  const std::string formats =
      R"({"formats":["obj","stl","ply","vtu","glb","cityjson","citygml2"]})";
  for (const auto* name : {"berlin/3900_5819.gml", "berlin/3920_5820.gml",
                           "citygml1/saxony_lod2.gml.gz", "citygml1/nrw_lod2.gml.gz"}) {
    const TempFolder folder;
    auto source = open_files({data(name)}, {});
    ASSERT_TRUE(source);
    const auto expected = estimate("export-for-simulation", formats, **source, {});
    ASSERT_TRUE(expected) << expected.error().message;
    const auto done = run("export-for-simulation", formats, **source, folder.path(), {});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(expected->buildings, done->report.counts.requested);
    const auto near = [&](double told, double real, const std::string& what) {
      EXPECT_LT(told, 3 * real) << name << ' ' << what;
      EXPECT_GT(told, real / 3) << name << ' ' << what;
    };
    near(static_cast<double>(expected->triangles), static_cast<double>(done->report.triangles),
         "triangles");
    for (const auto& file : done->files)
      if (find_format(file.output) != nullptr)
        near(static_cast<double>(bytes_of(*expected, file.output)),
             static_cast<double>(std::filesystem::file_size(folder / file.file_name)), file.output);
  }
}

TEST(EstimateTest, OutputsAreThoseThatAreAskedFor) {
  const auto outputs = [](const std::string& inputs, std::string_view process) {
    std::vector<std::string> ids;
    const auto expected = estimated({data("berlin/3900_5819.gml")}, inputs, process);
    EXPECT_TRUE(expected) << expected.error().message;
    if (expected)
      for (const auto& output : expected->outputs) ids.push_back(output.output);
    return ids;
  };
  EXPECT_THAT(outputs(R"({"formats":["ply"]})", "export-for-simulation"),
              ElementsAre("report", "ply"));
  EXPECT_THAT(outputs("{}", "heal"), ElementsAre("report", "cityjson", "errors_glb"));
  EXPECT_THAT(outputs("{}", "validate"), ElementsAre("report", "errors_glb"));
}

TEST(EstimateTest, SaysWhatIsWrongAlready) {
  const TempFolder folder;
  std::ofstream(folder / "broken.gml") << "<CityModel xmlns='http://www.opengis.net/citygml/2.0'>";
  const auto expected = estimated({data("berlin/3900_5819.gml"), folder / "broken.gml"},
                                  R"({"object_ids":["nobody"]})");
  ASSERT_TRUE(expected) << expected.error().message;
  EXPECT_THAT(expected->problems,
              ElementsAre(HasSubstr("broken.gml cannot be read"), HasSubstr("`nobody`"),
                          HasSubstr("no building is selected")));
  EXPECT_FALSE(estimated({data("berlin/3900_5819.gml")}, R"({"lod":["high"]})"));
}

TEST(EstimateTest, IsAJsonDocument) {
  const auto expected = estimated({data("berlin/3900_5819.gml")});
  ASSERT_TRUE(expected);
  const auto document = nlohmann::json::parse(to_json(*expected));
  EXPECT_EQ(document["process"], "export-for-simulation");
  EXPECT_EQ(document["buildings"], 4);
  EXPECT_EQ(document["expected"]["triangles"], expected->triangles);
  EXPECT_EQ(document["expected"]["bytes"], expected->bytes);
  EXPECT_EQ(document["expected"]["outputs"]["obj"], bytes_of(*expected, "obj"));
  EXPECT_EQ(document["problems"], nlohmann::json::array());
}

TEST(EstimateTest, IsNoRun) {
  const TempFolder folder;
  auto source = open_files({data("berlin/3900_5819.gml")}, {});
  ASSERT_TRUE(source);
  const auto refused = run("validate", R"({"mode":"estimate"})", **source, folder.path(), {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("makes no files"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace citymesh
