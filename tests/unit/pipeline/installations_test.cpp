#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/pipeline/pipeline.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  return content.str();
}

/// A box as a CityJSON solid over vertices that start at `first`.
std::string box(int first) {
  const auto ring = [&](int a, int b, int c, int d) {
    return "[[" + std::to_string(first + a) + "," + std::to_string(first + b) + "," +
           std::to_string(first + c) + "," + std::to_string(first + d) + "]]";
  };
  return R"({"type":"Solid","lod":"2","boundaries":[[)" + ring(0, 3, 2, 1) + "," +
         ring(4, 5, 6, 7) + "," + ring(0, 1, 5, 4) + "," + ring(1, 2, 6, 5) + "," +
         ring(2, 3, 7, 6) + "," + ring(3, 0, 4, 7) + "]]}";
}

std::string corners(int x, int y, int z, int size) {
  std::string text;
  for (const int dz : {0, size})
    for (const auto& [dx, dy] : {std::pair{0, 0}, {size, 0}, {size, size}, {0, size}}) {
      text += (text.empty() ? "[" : ",[") + std::to_string(x + dx) + "," + std::to_string(y + dy) +
              "," + std::to_string(z + dz) + "]";
    }
  return text;
}

/// A house with a chimney on it and a balcony that is a single sheet.
const std::string kHouse =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
    R"("CityObjects":{"house":{"type":"Building","children":["chimney","sheet"],"geometry":[)" +
    box(0) + R"(]},"chimney":{"type":"BuildingInstallation","parents":["house"],"geometry":[)" +
    box(8) +
    R"(]},"sheet":{"type":"BuildingInstallation","parents":["house"],"geometry":[)"
    R"({"type":"MultiSurface","lod":"2","boundaries":[[[8,9,10,11]]]}]}},"vertices":[)" +
    corners(0, 0, 0, 10) + "," + corners(3, 3, 12, 2) + "]}";

struct Outcome {
  Result<RunOutcome> run;
  nlohmann::json report{};
  std::string obj{};
};

Outcome run_house(const std::string& inputs) {
  const TempFolder folder, output;
  const auto path = folder / "house.json";
  std::ofstream(path) << kHouse;
  auto source = open_files({path}, {});
  EXPECT_TRUE(source);
  Outcome outcome{run("export-for-simulation", inputs, **source, output.path(), {})};
  if (!outcome.run) return outcome;
  outcome.report = nlohmann::json::parse(text_of(output / "report.json"));
  outcome.obj = text_of(output / "model.obj");
  return outcome;
}

TEST(Installations, AreLeftOutAndCountedByDefault) {
  const Outcome outcome = run_house("{}");
  ASSERT_TRUE(outcome.run) << outcome.run.error().message;
  EXPECT_EQ(outcome.run->report.bodies, 1u);
  EXPECT_THAT(outcome.run->report.warnings,
              Contains(HasSubstr("2 building installations were left out")));
  EXPECT_TRUE(outcome.report["buildings"][0]["parts"].empty());
}

TEST(Installations, KeptOnesAreBodiesOfTheirOwn) {
  const Outcome outcome = run_house(R"({"installations":"keep"})");
  ASSERT_TRUE(outcome.run) << outcome.run.error().message;
  EXPECT_EQ(outcome.run->report.bodies, 2u);
  EXPECT_THAT(outcome.obj, HasSubstr("o chimney\n"));
  const auto& building = outcome.report["buildings"][0];
  EXPECT_EQ(building["outcome"], "delivered");
  EXPECT_EQ(building["kind"], "Building");
  ASSERT_EQ(building["parts"].size(), 2u);
  EXPECT_EQ(building["parts"][0]["gml_id"], "chimney");
  EXPECT_EQ(building["parts"][0]["kind"], "BuildingInstallation");
  EXPECT_EQ(building["parts"][0]["outcome"], "delivered");
  EXPECT_NEAR(building["volume_after_m3"].get<double>(), 1008, 1e-6);
  EXPECT_EQ(outcome.report["counts"]["parts"]["requested"], 0) << "installations are no parts";
}

TEST(Installations, OneThatCannotBeHealedIsDroppedAlone) {
  const Outcome outcome = run_house(R"({"installations":"keep"})");
  ASSERT_TRUE(outcome.run);
  const auto& sheet = outcome.report["buildings"][0]["parts"][1];
  EXPECT_EQ(sheet["gml_id"], "sheet");
  EXPECT_EQ(sheet["outcome"], "dropped");
  EXPECT_FALSE(sheet["reason"].is_null());
  EXPECT_EQ(outcome.report["counts"]["delivered"], 1);
}

}  // namespace
}  // namespace citymesh
