// What users see of healing: the model comes back, new surfaces say so, the report says what was
// done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/pipeline/pipeline.h"
#include "core/write/write.h"
#include "tests/support/open_box.h"
#include "tests/unit/write/files.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Path = std::filesystem::path;

constexpr std::array<std::string_view, 4> kModelFormats{"cityjson", "cityjsonseq", "citygml2",
                                                        "citygml3"};

/// A process run on one file, with its results.
struct Results {
  test::TemporaryFolder folder{};
  Result<RunOutcome> outcome;

  Results(const Path& file, std::string_view format, std::string_view process = "heal")
      : outcome(run_on(file, format, process)) {
    EXPECT_TRUE(outcome) << outcome.error().message;
  }
  Path file(std::string_view format) const {
    return folder.path() / find_format(format)->file_name;
  }
  std::string text(const Path& name) const { return test::read_file(folder.path() / name); }
  nlohmann::json building() const {
    return nlohmann::json::parse(text("report.json"))["buildings"][0];
  }

 private:
  Result<RunOutcome> run_on(const Path& from, std::string_view format, std::string_view process) {
    auto source = open_files({from}, {});
    if (!source) return source.error();
    const std::string inputs =
        process == "validate" ? "{}" : R"({"formats":[")" + std::string(format) + "\"]}";
    return run(process, inputs, **source, folder.path(), {});
  }
};

struct Surface {
  std::string type{}, rung{};
};

/// Semantic surfaces of the open box by their id, "" for one without.
std::map<std::string, Surface> surfaces_of(const Results& results) {
  const auto model = nlohmann::json::parse(results.text("model.city.json"));
  std::map<std::string, Surface> all;
  for (const auto& surface :
       model["CityObjects"]["open_box"]["geometry"][0]["semantics"]["surfaces"]) {
    EXPECT_EQ(surface.contains("citymesh_new"), surface.contains("citymesh_rung"));
    all[surface.value("id", "")] = {surface["type"], surface.value("citymesh_rung", "")};
  }
  return all;
}

class Healing : public ::testing::Test {
 protected:
  Healing() { std::ofstream(box_) << test::open_box_cityjson(); }

  test::TemporaryFolder folder_;
  Path box_ = folder_.path() / "box.city.json";
};

TEST_F(Healing, ClosesAWallAndSaysThatItIsNew) {
  const Results healed(box_, "cityjson");
  EXPECT_EQ(healed.building()["rung"], "healed");
  const auto surfaces = surfaces_of(healed);
  ASSERT_EQ(surfaces.size(), 6u);
  for (const auto& [id, surface] : surfaces) EXPECT_EQ(surface.rung, id.empty() ? "healed" : "");
  EXPECT_EQ(surfaces.at("ground").type, "GroundSurface");
  EXPECT_EQ(surfaces.at("south").type, "WallSurface");
  EXPECT_EQ(surfaces.at("roof").type, "RoofSurface");
  const auto object =
      nlohmann::json::parse(healed.text("model.city.json"))["CityObjects"]["open_box"];
  EXPECT_EQ(object["attributes"]["owner"], "A & B");
  EXPECT_EQ(object["address"][0]["ThoroughfareName"], "Main Street");
  EXPECT_EQ(object["geometry"][0]["type"], "Solid");
}

TEST_F(Healing, TheMarkIsInEveryModelFormatAndIsReadAgain) {
  for (const std::string_view key : kModelFormats) {
    const Results healed(box_, key);
    EXPECT_THAT(healed.text(find_format(key)->file_name), HasSubstr("citymesh_rung")) << key;
    const Results again(healed.file(key), "cityjson");
    EXPECT_EQ(again.building()["rung"], "as_is") << key;
    std::size_t marked = 0;
    for (const auto& [id, surface] : surfaces_of(again)) {
      marked += surface.rung == "healed" ? 1u : 0u;
      EXPECT_TRUE(surface.rung.empty() || surface.type == "ClosureSurface" ||
                  surface.type == "WallSurface")
          << key << " " << surface.type;
    }
    EXPECT_EQ(marked, 1u) << key;
    const auto object =
        nlohmann::json::parse(again.text("model.city.json"))["CityObjects"]["open_box"];
    EXPECT_FALSE(object["attributes"].contains("citymesh_rung")) << key;
  }
}

TEST_F(Healing, TwiceGivesTheSameBytes) {
  for (const std::string_view key : kModelFormats) {
    const Results once(box_, key);
    const Results twice(once.file(key), key);
    const Results thrice(twice.file(key), key);
    EXPECT_EQ(test::read_file(twice.file(key)), test::read_file(thrice.file(key))) << key;
    if (key.starts_with("cityjson")) {
      EXPECT_EQ(test::read_file(once.file(key)), test::read_file(twice.file(key))) << key;
    }
    const Results mesh(box_, "obj"), mesh_again(once.file(key), "obj");
    EXPECT_EQ(test::read_file(mesh.file("obj")), test::read_file(mesh_again.file("obj"))) << key;
  }
}

TEST_F(Healing, TheReportHasDefectsAndVolumesBeforeAndAfter) {
  const Results healed(box_, "cityjson");
  const auto building = healed.building();
  EXPECT_EQ(building["issues_before"][0]["code"], "302");
  EXPECT_TRUE(building["issues_after"].empty());
  EXPECT_FALSE(building["repairs"].empty());
  EXPECT_TRUE(building["volume_before_m3"].is_null());
  EXPECT_TRUE(building["volume_change_m3"].is_null());
  EXPECT_NEAR(building["volume_after_m3"].get<double>(), 24, 1e-9);

  const Results again(healed.file("cityjson"), "cityjson");
  EXPECT_TRUE(again.building()["issues_before"].empty());
  EXPECT_EQ(again.building()["volume_change_m3"], 0);
}

TEST_F(Healing, ThePageShowsABuildingBeforeAndAfterOnlyWhereItChanged) {
  const Results healed(box_, "cityjson");
  EXPECT_THAT(healed.text("report.html"), HasSubstr("before and after: open_box"));
  const Results again(healed.file("cityjson"), "cityjson");
  EXPECT_THAT(again.text("report.html"), Not(HasSubstr("before and after")));
}

TEST_F(Healing, ValidateShowsTheModelAsItCame) {
  std::ofstream(box_) << test::open_solid_cityjson();
  const Results checked(box_, "", "validate");
  EXPECT_THAT(checked.text("picture.svg"), HasSubstr("1 building checked"));
  EXPECT_THAT(checked.text("picture.svg"), HasSubstr("defects of shells"));
  EXPECT_THAT(checked.text("report.html"), HasSubstr("citymesh-picture"));
}

TEST_F(Healing, ValidateDoesNotAskOfAMultiSurfaceThatItIsClosed) {
  const Results checked(box_, "", "validate");
  EXPECT_TRUE(checked.building()["issues_before"].empty());
  EXPECT_THAT(checked.text("picture.svg"), HasSubstr("without defects"));
}

}  // namespace
}  // namespace citymesh
