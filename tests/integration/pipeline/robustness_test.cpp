// Cities with defects through run(): threads and bad neighbours change nothing.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/pipeline/pipeline.h"
#include "tests/support/defects/bad_buildings.h"
#include "tests/support/defects/city_files.h"
#include "tests/unit/write/files.h"

namespace citymesh {
namespace {

using testing::DefectiveHouse;

/// Runs a city from a file of its own; the folder holds what came out.
void run_city(const std::vector<DefectiveHouse>& city, unsigned threads,
              const std::filesystem::path& folder) {
  const auto file = folder / "city.json", output = folder / "out";
  std::ofstream model(file);
  testing::write_city(city, model);
  model.close();
  std::filesystem::create_directories(output);
  auto source = open_files({file}, {});
  ASSERT_TRUE(source) << source.error().message;
  RunContext context;
  context.threads = threads;
  const auto outcome = run("export-for-simulation", R"({"formats":["obj","stl","cityjson"]})",
                           **source, output, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
}

std::vector<DefectiveHouse> small_city() {
  std::vector<DefectiveHouse> city =
      testing::make_city({.seed = 3, .sound = 1, .singles = 1, .pairs = 0});
  return city;
}

TEST(RobustnessOfRuns, OneAndFourThreadsWriteTheSameBytes) {
  test::TemporaryFolder one, four;
  run_city(small_city(), 1, one.path());
  run_city(small_city(), 4, four.path());
  for (const char* name :
       {"model.obj", "model.stl", "model.city.json", "report.json", "report.html", "picture.svg"})
    EXPECT_EQ(test::read_file(one.path() / "out" / name),
              test::read_file(four.path() / "out" / name))
        << name;
}

TEST(RobustnessOfRuns, BadBuildingsDoNotChangeWhatTheirNeighboursGet) {
  test::TemporaryFolder alone, together;
  std::vector<DefectiveHouse> city = small_city();
  run_city(city, 1, alone.path());
  const std::size_t houses = city.size();
  for (const testing::BadBuilding& bad : testing::bad_buildings()) {
    DefectiveHouse house;
    house.building = bad.make(1000);
    house.building.gml_id = bad.name;
    for (Point3& p : house.building.geometries[0].points) p = {p.x + 300, p.y + 300, p.z + 30};
    city.push_back(std::move(house));
  }
  run_city(city, 1, together.path());

  const auto report_of = [](const test::TemporaryFolder& folder) {
    return nlohmann::json::parse(test::read_file(folder.path() / "out" / "report.json"));
  };
  const auto before = report_of(alone), after = report_of(together);
  EXPECT_EQ(after["counts"]["requested"].get<std::size_t>(), city.size());
  EXPECT_EQ(before["origin"], after["origin"]);
  for (std::size_t i = 0; i < houses; ++i)
    EXPECT_EQ(before["buildings"][i], after["buildings"][i]) << city[i].building.gml_id;
  for (std::size_t i = houses; i < city.size(); ++i) {
    const auto& bad = after["buildings"][i];
    EXPECT_TRUE(bad["outcome"] == "delivered" ? bad["rung"].is_string() : bad["reason"].is_string())
        << city[i].building.gml_id;
  }
}

}  // namespace
}  // namespace citymesh
