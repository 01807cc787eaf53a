#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tests/integration/apps/big_city.h"
#include "tests/integration/apps/program.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kTile = CITYMESH_TEST_DATA "/berlin/3920_5820.gml";

struct Outcome {
  int code = 0;
  std::string out, err;
};

Outcome citymesh(std::vector<std::string> arguments) {
  Program program(std::move(arguments));
  const auto code = program.wait();
  return {code, program.out(), program.err()};
}

Outcome export_to(const std::filesystem::path& folder, std::vector<std::string> more,
                  const std::string& input = kTile) {
  std::vector<std::string> arguments{"run",      "export-for-simulation", "--input", input,
                                     "--output", folder.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return citymesh(arguments);
}

TEST(CommandLine, HelpAndVersionAreOnStdoutEverywhere) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"run", "--help"},
                                                    {"validate", "--help"},
                                                    {"heal", "--help"},
                                                    {"index", "--help"},
                                                    {"serve", "--help"},
                                                    {"processes", "--help"},
                                                    {"openapi", "--help"}}) {
    const auto outcome = citymesh(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("--help"));
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_THAT(citymesh({"--version"}).out, HasSubstr("citymesh "));
}

TEST(CommandLine, ListsProcessesWithTheirInputs) {
  const auto outcome = citymesh({"processes"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("export-for-simulation"), HasSubstr("validate"),
                                 HasSubstr("snap_tolerance_m = 0.001")));
}

TEST(CommandLine, AnEstimateSaysWhatWouldBeProcessedAndWritesNothing) {
  const auto outcome = citymesh({"run", "export-for-simulation", "--input", kTile, "--format",
                                 "obj,ply", "--set", "mode=estimate"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto expected = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(expected["buildings"], 6);
  EXPECT_TRUE(expected["expected"]["outputs"].contains("ply"));
  const auto missing =
      citymesh({"heal", kTile, "--set", "mode=estimate", "--set", "object_ids=nobody"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.out, HasSubstr("`nobody` is in none of the inputs"));
  const auto nowhere = citymesh({"heal", kTile});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--output is missing"));
}

TEST(CommandLine, PrintsTheDescriptionOfTheRestApi) {
  const auto outcome = citymesh({"openapi", "--server", "https://maps.example/citymesh"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("\"openapi\": \"3.0.3\""), HasSubstr("https://maps.example/citymesh"),
                    HasSubstr("max_hole_area_m2")));
}

TEST(CommandLine, WhatCannotRunIsExitCodeTwoAndSaysWhy) {
  const TempFolder folder;
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    const auto outcome = citymesh(arguments);
    EXPECT_EQ(outcome.code, 2) << why;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  const auto out = (folder / "out").string();
  refused({}, "subcommand");
  refused({"fly"}, "fly");
  refused({"run", "export-for-simulation", "--output", out}, "--input");
  refused({"run", "fly", "--input", kTile, "--output", out}, "export-for-simulation");
  refused({"run", "export-for-simulation", "--input", kTile, "--output", out, "--format", "step"},
          "stl_binary");
  refused({"run", "export-for-simulation", "--input", "missing.gml", "--output", out},
          "missing.gml");
  refused({"run", "export-for-simulation", "--input", kTile, "--output", out, "--bbox", "1,2"},
          "expected minx,miny");
  refused({"run", "export-for-simulation", "--input", kTile, "--output", out, "--set", "a=1"}, "a");
  refused({"validate", "missing.gml"}, "missing.gml");
  refused({"heal", kTile}, "--output");
  refused({"heal", "missing.gml", "--output", out}, "missing.gml");
  refused({"heal", kTile, "--output", out, "--set", "parts=split"}, "merge");
  refused({"serve", "--data", "missing"}, "missing");
  refused({"serve", "--data", folder.path().string(), "--listen", "here"}, "HOST:PORT");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(CommandLine, ExportsAndSaysWhatWasDelivered) {
  const TempFolder folder;
  const auto outcome = export_to(folder / "out", {"--format", "obj,stl"});
  EXPECT_LE(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("6 buildings selected"), HasSubstr("delivered"),
                                 HasSubstr((folder / "out" / "model.obj").string())));
  for (const auto* name :
       {"model.obj", "model.stl", "report.json", "report.html", "picture.svg", "run.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  const auto report = nlohmann::json::parse(std::ifstream(folder / "out" / "report.json"));
  const auto& counts = report.at("counts");
  EXPECT_EQ(counts.at("requested"), 6);
  EXPECT_EQ(outcome.code, counts.at("dropped") == 0 ? 0 : 1);
}

TEST(CommandLine, AFolderWithFilesIsNotTouchedWithoutOverwrite) {
  const TempFolder folder;
  ASSERT_LE(export_to(folder / "out", {"--format", "stl"}).code, 1);
  const auto refused = export_to(folder / "out", {});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_LE(export_to(folder / "out", {"--overwrite"}).code, 1);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "model.obj"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "model.stl"));
}

TEST(CommandLine, NoBuildingInTheBoxIsASuccessWithAWarning) {
  const TempFolder folder;
  const auto outcome = export_to(folder / "out", {"--bbox", "1,1,1.001,1.001"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning"));
  const auto report = nlohmann::json::parse(std::ifstream(folder / "out" / "report.json"));
  EXPECT_EQ(report.at("counts").at("requested"), 0);
}

TEST(CommandLine, AnInputThatCannotBeReadIsExitCodeOne) {
  const TempFolder folder;
  std::ofstream(folder / "broken.gml") << "<core:CityModel";
  const auto outcome =
      citymesh({"run", "export-for-simulation", "--input", kTile, (folder / "broken.gml").string(),
                "--output", (folder / "out").string()});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("broken.gml"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "model.obj"));
}

/// Does the report name something that is a defect, and no remark on buildings that are sound?
bool has_defects(const nlohmann::json& report) {
  const std::set<std::string> remarks{"C117", "C118", "C119"};
  for (const auto& building : report.at("buildings"))
    for (const auto& issue : building.at("issues_before"))
      if (!remarks.contains(issue.at("code").get<std::string>())) return true;
  return false;
}

TEST(CommandLine, ValidatePrintsTheReportToStdout) {
  const auto outcome = citymesh({"validate", kTile});
  ASSERT_LE(outcome.code, 1) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report.at("process"), "validate");
  EXPECT_EQ(outcome.code, has_defects(report) ? 1 : 0);
}

TEST(CommandLine, HealWritesTheCityModelAgain) {
  const TempFolder folder;
  const auto outcome = citymesh({"heal", kTile, "--output", (folder / "out").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("heal: 6 buildings selected"), HasSubstr("delivered")));
  const auto model = nlohmann::json::parse(std::ifstream(folder / "out" / "model.city.json"));
  const auto report = nlohmann::json::parse(std::ifstream(folder / "out" / "report.json"));
  EXPECT_EQ(report.at("process"), "heal");
  for (const auto& building : report.at("buildings"))
    EXPECT_TRUE(model.at("CityObjects").contains(building.at("gml_id").get<std::string>()));

  const auto run = citymesh({"run", "heal", "--input", kTile, "--output",
                             (folder / "long").string(), "--format", "cityjson"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(folder / "long" / "model.city.json")), model);
}

TEST(CommandLine, ASettingTakesOneValueAndLeavesTheFilesAlone) {
  const auto outcome = citymesh({"validate", "--set", "lod=1", "--set", "crs=EPSG:25833", kTile});
  ASSERT_LE(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(R"("lod":["1"])"));
}

TEST(CommandLine, AFullDiskIsAClearErrorThatLeavesNothingBehind) {
  const TempFolder folder;
  Program program("ulimit -f 16", {"run", "export-for-simulation", "--input", kTile, "--output",
                                   (folder / "out").string()});
  EXPECT_EQ(program.wait(), 2) << program.err();
  EXPECT_THAT(program.err(), HasSubstr("too large"));
  EXPECT_TRUE(std::filesystem::is_empty(folder / "out"));
}

TEST(CommandLine, CtrlCStopsCleanly) {
  const TempFolder folder;
  make_big_city(folder / "city", 10);
  Program program({"run", "export-for-simulation", "--input", (folder / "city").string(),
                   "--output", (folder / "out").string()});
  // The output folder is made before the work starts.
  while (program.runs() && !std::filesystem::exists(folder / "out"))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(program.err(), HasSubstr("stopped"));
  EXPECT_TRUE(std::filesystem::is_empty(folder / "out"));
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(CommandLine, AnIndexedFolderGivesTheSameResultsAsItsFiles) {
  const TempFolder folder;
  const auto tiles = folder / "tiles";
  std::filesystem::create_directory(tiles);
  for (const char* tile : {"3920_5820.gml", "3900_5819.gml", "3920_5818.gml.gz"})
    std::filesystem::copy_file(std::filesystem::path(CITYMESH_TEST_DATA "/berlin") / tile,
                               tiles / tile);
  const std::vector<std::string> box{"--bbox", "391950,5818000,392400,5820200@EPSG:25833"};

  ASSERT_EQ(export_to(folder / "files", box, tiles.string()).code, 0);
  const auto indexed = citymesh({"index", tiles.string()});
  EXPECT_EQ(indexed.code, 0) << indexed.err;
  EXPECT_THAT(indexed.out, AllOf(HasSubstr("3 files, 82 buildings"), HasSubstr("indexed   3")));
  EXPECT_THAT(citymesh({"index", tiles.string()}).out, HasSubstr("unchanged 3"));
  ASSERT_EQ(export_to(folder / "catalogue", box, tiles.string()).code, 0);
  for (const char* file : {"model.obj", "report.json", "picture.svg"})
    EXPECT_EQ(bytes_of(folder / "files" / file), bytes_of(folder / "catalogue" / file)) << file;
}

TEST(CommandLine, IndexingWhatIsNoFolderIsExitCodeTwo) {
  const auto outcome = citymesh({"index", "/nonexistent/folder"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/nonexistent/folder"));
  EXPECT_EQ(citymesh({"index", kTile}).code, 2);
}

}  // namespace
}  // namespace citymesh
