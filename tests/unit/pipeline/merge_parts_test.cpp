#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/pipeline/pipeline.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Merged {
  Result<RunOutcome> run;
  nlohmann::json building{};
  std::string obj{};
};

Merged run_parts(const std::filesystem::path& file, const std::string& inputs) {
  const TempFolder output;
  auto source = open_files({file}, {});
  EXPECT_TRUE(source);
  Merged merged{run("export-for-simulation", inputs, **source, output.path(), {})};
  if (!merged.run) return merged;
  merged.building = nlohmann::json::parse(content(output / "report.json"))["buildings"][0];
  merged.obj = content(output / "model.obj");
  return merged;
}

const std::filesystem::path kGarage =
    std::filesystem::path(CITYMESH_TEST_DATA) / "citygml2" / "building_and_garage_lod2.gml";

/// Two boxes of 10 m as parts of a building without a geometry of its own; the second stands at
/// `x`, `y`.
std::filesystem::path two_parts(const TempFolder& folder, int x, int y) {
  nlohmann::json city{{"type", "CityJSON"},
                      {"version", "2.0"},
                      {"transform", {{"scale", {1, 1, 1}}, {"translate", {0, 0, 0}}}}};
  city["CityObjects"]["house"] = {{"type", "Building"}, {"children", {"p1", "p2"}}};
  for (int part = 0; part < 2; ++part) {
    const int first = 8 * part;
    nlohmann::json shell;
    for (const auto& ring : std::vector<std::vector<int>>{
             {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
      nlohmann::json corners;
      for (const int corner : ring) corners.push_back(first + corner);
      shell.push_back({corners});
    }
    city["CityObjects"]["p" + std::to_string(part + 1)] = {
        {"type", "BuildingPart"},
        {"parents", {"house"}},
        {"geometry", {{{"type", "Solid"}, {"lod", "2"}, {"boundaries", {shell}}}}}};
    for (const int z : {0, 10})
      for (const auto& [dx, dy] : {std::pair{0, 0}, {10, 0}, {10, 10}, {0, 10}})
        city["vertices"].push_back({part * x + dx, part * y + dy, z});
  }
  std::ofstream(folder / "parts.json") << city.dump();
  return folder / "parts.json";
}

TEST(MergeParts, AreKeptAsBodiesByDefault) {
  const Merged kept = run_parts(kGarage, "{}");
  ASSERT_TRUE(kept.run) << kept.run.error().message;
  EXPECT_EQ(kept.run->report.bodies, 2u);
}

TEST(MergeParts, HouseAndGarageBecomeOneBodyOfTheSameVolume) {
  const Merged kept = run_parts(kGarage, "{}");
  const Merged merged = run_parts(kGarage, R"({"parts":"merge"})");
  ASSERT_TRUE(merged.run) << merged.run.error().message;
  EXPECT_EQ(merged.run->report.bodies, 1u);
  EXPECT_NEAR(merged.building["volume_after_m3"].get<double>(),
              kept.building["volume_after_m3"].get<double>(), 0.01);
  EXPECT_LT(merged.run->report.area_m2, kept.run->report.area_m2) << "the party wall is gone";
  EXPECT_EQ(merged.building["parts"][0]["outcome"], "delivered");
  EXPECT_EQ(merged.run->report.counts.merged, 0u);
}

TEST(MergeParts, WhatOverlapsCountsOnce) {
  const TempFolder folder;
  const Merged merged = run_parts(two_parts(folder, 5, 5), R"({"parts":"merge"})");
  ASSERT_TRUE(merged.run) << merged.run.error().message;
  EXPECT_EQ(merged.run->report.bodies, 1u);
  EXPECT_NEAR(merged.building["volume_after_m3"].get<double>(), 1750, 1e-6);
  EXPECT_THAT(merged.obj, HasSubstr("o house\n"));
  EXPECT_THAT(merged.obj, Not(HasSubstr("o p1\n")));
}

TEST(MergeParts, WhatTouchesAlongALineOnlyIsDrawnApart) {
  const TempFolder folder;
  const Merged merged = run_parts(two_parts(folder, 10, 10), R"({"parts":"merge"})");
  ASSERT_TRUE(merged.run) << merged.run.error().message;
  EXPECT_EQ(merged.run->report.bodies, 1u);
  EXPECT_NEAR(merged.building["volume_after_m3"].get<double>(), 2000, 2);
  EXPECT_TRUE(merged.building["issues_after"].empty());
}

TEST(MergeParts, WhatLiesApartIsOneBodyOfTwoShells) {
  const TempFolder folder;
  const Merged merged = run_parts(two_parts(folder, 30, 0), R"({"parts":"merge"})");
  ASSERT_TRUE(merged.run) << merged.run.error().message;
  EXPECT_EQ(merged.run->report.bodies, 1u);
  EXPECT_NEAR(merged.building["volume_after_m3"].get<double>(), 2000, 1e-6);
}

}  // namespace
}  // namespace citymesh
