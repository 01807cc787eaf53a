#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/pipeline/pipeline.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

struct Box {
  int x0, y0, x1, y1, height;
};

/// A building without a geometry of its own, whose parts p1, p2 … are boxes.
void write_parts(const std::filesystem::path& file, const std::vector<Box>& boxes) {
  nlohmann::json city{{"type", "CityJSON"},
                      {"version", "2.0"},
                      {"transform", {{"scale", {1, 1, 1}}, {"translate", {0, 0, 0}}}}};
  city["CityObjects"]["house"] = {{"type", "Building"}};
  int first = 0;
  for (const Box& box : boxes) {
    const std::string id = "p" + std::to_string(first / 8 + 1);
    city["CityObjects"]["house"]["children"].push_back(id);
    nlohmann::json shell;
    for (const auto& ring : std::vector<std::vector<int>>{
             {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
      nlohmann::json corners;
      for (const int corner : ring) corners.push_back(first + corner);
      shell.push_back({corners});
    }
    city["CityObjects"][id] = {
        {"type", "BuildingPart"},
        {"parents", {"house"}},
        {"geometry", {{{"type", "Solid"}, {"lod", "2"}, {"boundaries", {shell}}}}}};
    for (const int z : {0, box.height})
      for (const auto& [x, y] :
           {std::pair{box.x0, box.y0}, {box.x1, box.y0}, {box.x1, box.y1}, {box.x0, box.y1}})
        city["vertices"].push_back({x, y, z});
    first += 8;
  }
  std::ofstream(file) << city.dump();
}

struct Outcome {
  RunReport report{};
  nlohmann::json building{};
};

Outcome heal_file(const std::filesystem::path& file, const TempFolder& output) {
  auto source = open_files({file}, {});
  EXPECT_TRUE(source);
  auto done = run("heal", "{}", **source, output.path(), {});
  EXPECT_TRUE(done);
  if (!done) return {};
  std::ifstream text(output / "report.json");
  return {done->report, nlohmann::json::parse(text)["buildings"][0]};
}

Outcome heal_boxes(const std::vector<Box>& boxes) {
  const TempFolder folder, output;
  write_parts(folder / "parts.json", boxes);
  return heal_file(folder / "parts.json", output);
}

TEST(SeparateParts, WhatOverlapsTouchesAfterwards) {
  const Outcome outcome = heal_boxes({{0, 0, 10, 10, 10}, {8, 2, 14, 6, 5}});
  EXPECT_EQ(outcome.report.bodies, 2u);
  EXPECT_NEAR(outcome.building["volume_after_m3"].get<double>(), 1000 + 120 - 40, 1e-6);
  EXPECT_EQ(outcome.building["parts"][1]["volume_after_m3"], 120);
  EXPECT_TRUE(outcome.building["issues_after"].empty());
  const auto& repair = outcome.building["parts"][0]["repairs"].back();
  EXPECT_EQ(repair["kind"], "parts_separated");
  EXPECT_EQ(repair["where"], "40.000 m³ given to p2");
  EXPECT_TRUE(repair.contains("at"));
}

TEST(SeparateParts, HealingAgainChangesNothingMore) {
  const TempFolder folder, first, second;
  write_parts(folder / "parts.json", {{0, 0, 10, 10, 10}, {8, 2, 14, 6, 5}, {12, 3, 20, 9, 6}});
  heal_file(folder / "parts.json", first);
  const Outcome again = heal_file(first / "model.city.json", second);
  EXPECT_EQ(again.report.bodies, 3u);
  for (const auto& part : again.building["parts"]) {
    EXPECT_TRUE(part["repairs"].empty()) << part;
    EXPECT_EQ(part["rung"], "as_is");
  }
}

TEST(SeparateParts, APartOfWhichNothingIsLeftIsMerged) {
  const Outcome outcome = heal_boxes({{0, 0, 10, 10, 10}, {0, 0, 10, 10, 10}});
  EXPECT_EQ(outcome.report.bodies, 1u);
  EXPECT_EQ(outcome.building["outcome"], "delivered");
  EXPECT_EQ(outcome.building["volume_after_m3"], 1000);
  EXPECT_EQ(outcome.building["parts"][1]["outcome"], "merged");
  EXPECT_EQ(outcome.building["parts"][1]["merged_into"], "p1");
  EXPECT_EQ(outcome.report.part_counts.merged, 1u);
}

TEST(SeparateParts, PartsThatOnlyTouchStayAsTheyAre) {
  const Outcome outcome = heal_boxes({{0, 0, 10, 10, 10}, {10, 2, 14, 6, 5}, {0, 0, 9, 2, 4}});
  EXPECT_TRUE(outcome.building["parts"][1]["repairs"].empty());
  const Outcome touching = heal_boxes({{0, 0, 10, 10, 10}, {10, 2, 14, 6, 5}});
  for (const auto& part : touching.building["parts"]) {
    EXPECT_TRUE(part["repairs"].empty());
    EXPECT_EQ(part["rung"], "as_is");
    EXPECT_EQ(part["triangles"], 12);
  }
}

}  // namespace
}  // namespace citymesh
