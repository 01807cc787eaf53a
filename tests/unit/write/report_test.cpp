#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>

#include <nlohmann/json.hpp>

#include "core/write/report_html.h"
#include "core/write/write.h"
#include "tests/unit/write/files.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunReport run_report() {
  RunReport report;
  report.process = "export-for-simulation";
  report.version = "0.1.0";
  report.options_json =
      R"({"formats":["obj","stl_binary"],"lod":["2","3"],"snap_tolerance_m":0.001})";
  report.crs = {"EPSG:25833"};
  report.origin = {391000, 5820000, 0};
  report.inputs = {{"tile.gml", "CityGML 2.0", "read", "", "EPSG:25833", 2},
                   {"broken.gml", "", "failed", "line 3: <b> is not closed", "", 0}};
  report.counts = {3, 1, 1, 1};
  report.part_counts = {2, 2, 0, 0};
  report.warnings = {"1 installation was left out"};
  report.rungs = {{"healed", 1}};
  report.drop_reasons = {{"no_geometry", 1}};
  report.bodies = 1;
  report.triangles = 16;
  report.extent.add(Point3{0, 0, 0});
  report.extent.add(Point3{10, 8, 9});
  return report;
}

BuildingReport delivered(const std::string& gml_id) {
  BuildingReport report;
  report.gml_id = gml_id;
  report.name = "b_1";
  report.outcome = "delivered";
  report.lod = "2";
  report.lane = "2.5d";
  report.rung = "healed";
  report.issues_before = {{302, "poly \"7\"", 0}, {203, "poly 8", 0.0345}};
  report.repairs = {{"close_hole", "poly 7", 0.001}};
  report.max_displacement_m = 0.001;
  report.volume_after_m3 = 560;
  report.triangles = 16;
  PartReport part;
  part.gml_id = "part";
  part.outcome = "delivered";
  part.rung = "as_is";
  report.parts = {part};
  return report;
}

BuildingReport dropped(const std::string& gml_id) {
  BuildingReport report;
  report.gml_id = gml_id;
  report.outcome = "dropped";
  report.reason = "no_geometry";
  return report;
}

struct Written {
  test::TemporaryFolder folder{};
  std::string json{}, html{}, svg{};
};

std::unique_ptr<Written> write_report(const std::string& hostile = "DE 1") {
  auto written = std::make_unique<Written>();
  auto writer = ReportWriter::create(written->folder.path(), {});
  EXPECT_TRUE(writer);
  const auto house = test::building("b_1", test::house(10, 8, 5, 9), "healed");
  BuildingReport merged = dropped("merged " + hostile);
  merged.outcome = "merged";
  merged.reason = "";
  merged.merged_into = hostile;
  EXPECT_TRUE(writer.value()->add(delivered(hostile), &house, {}));
  EXPECT_TRUE(writer.value()->add(merged, nullptr, {}));
  EXPECT_TRUE(writer.value()->add(dropped("dropped " + hostile), nullptr, {}));
  EXPECT_TRUE(writer.value()->finish(run_report()));
  written->json = test::read_file(written->folder.path() / "report.json");
  written->html = test::read_file(written->folder.path() / "report.html");
  written->svg = test::read_file(written->folder.path() / "picture.svg");
  return written;
}

TEST(ReportJson, HasTheFieldsOfTheContract) {
  const auto json = nlohmann::json::parse(write_report()->json);
  EXPECT_EQ(json["process"], "export-for-simulation");
  EXPECT_EQ(json["version"], "0.1.0");
  EXPECT_EQ(json["options"]["snap_tolerance_m"], 0.001);
  EXPECT_EQ(json["crs"], "EPSG:25833");
  EXPECT_EQ(json["origin"], nlohmann::json({391000, 5820000, 0}));
  EXPECT_EQ(json["inputs"][1]["state"], "failed");
  EXPECT_EQ(json["counts"]["requested"], 3);
  EXPECT_EQ(json["counts"]["merged"], 1);
  EXPECT_EQ(json["counts"]["parts"]["delivered"], 2);
  EXPECT_EQ(json["mesh"]["triangles"], 16);
  EXPECT_EQ(json["rungs"]["healed"], 1);
  EXPECT_EQ(json["drop_reasons"]["no_geometry"], 1);
  EXPECT_EQ(json["warnings"][0], "1 installation was left out");
  ASSERT_EQ(json["buildings"].size(), 3u);
  const auto& building = json["buildings"][0];
  for (const char* field :
       {"gml_id", "name", "outcome", "merged_into", "reason", "lod", "lane", "rung",
        "issues_before", "issues_after", "repairs", "max_displacement_m", "deviation_max_m",
        "deviation_mean_m", "volume_before_m3", "volume_after_m3", "parts"})
    EXPECT_TRUE(building.contains(field)) << field;
  EXPECT_EQ(building["issues_before"][0], (nlohmann::json{{"code", "302"},
                                                          {"name", "SHELL_NOT_CLOSED"},
                                                          {"where", "poly \"7\""},
                                                          {"measured", 0}}));
  EXPECT_EQ(building["issues_before"][1]["measured"], 0.0345);
  EXPECT_TRUE(building["volume_before_m3"].is_null());
  EXPECT_EQ(building["parts"][0]["outcome"], "delivered");
  EXPECT_EQ(building["parts"][0]["rung"], "as_is");
  EXPECT_EQ(json["buildings"][2]["reason"], "no_geometry");
}

TEST(ReportJson, IsCompleteWithoutAnyBuilding) {
  test::TemporaryFolder folder;
  auto writer = ReportWriter::create(folder.path(), {});
  ASSERT_TRUE(writer.value()->finish({}));
  const auto json = nlohmann::json::parse(test::read_file(folder.path() / "report.json"));
  EXPECT_TRUE(json["buildings"].empty());
  EXPECT_TRUE(json["mesh"]["extent"].is_null());
  EXPECT_THAT(test::read_file(folder.path() / "picture.svg"), HasSubstr("No building"));
}

TEST(Report, HasTheSameBytesEveryTime) {
  const auto first = write_report(), second = write_report();
  EXPECT_EQ(first->json, second->json);
  EXPECT_EQ(first->html, second->html);
  EXPECT_EQ(first->svg, second->svg);
  EXPECT_EQ(test::files_in(first->folder.path()), 3u) << "no temporary file stays";
}

TEST(Report, SurvivesHostileTexts) {
  const auto written = write_report("<script>alert('x')</script>\"&\x01\xFF</script><!-- ]]>");
  EXPECT_TRUE(nlohmann::json::accept(written->json));
  EXPECT_THAT(written->html, Not(HasSubstr("alert('x')")));
  EXPECT_THAT(written->html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(written->html, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)"));
  EXPECT_THAT(written->html, Not(HasSubstr("<b> is not closed")));
}

TEST(ReportHtml, LoadsNothingFromElsewhere) {
  const auto written = write_report();
  EXPECT_THAT(written->html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(written->html, Not(HasSubstr("src=")));
  EXPECT_THAT(written->html, Not(HasSubstr("<link")));
  EXPECT_THAT(written->html, Not(HasSubstr("url(http")));
}

TEST(ReportHtml, ShowsCountsFilesDefectsAndThePicture) {
  const auto written = write_report();
  EXPECT_THAT(written->html, HasSubstr("<b>3</b><span>requested"));
  EXPECT_THAT(written->html, HasSubstr("href=\"model.obj\""));
  EXPECT_THAT(written->html, HasSubstr("href=\"model_binary.patches.json\""));
  EXPECT_THAT(written->html, HasSubstr("<b>302</b> shell not closed"));
  EXPECT_THAT(written->html, HasSubstr("1 installation was left out"));
  EXPECT_THAT(written->html, HasSubstr("<svg xmlns"));
}

TEST(ReportHtml, LeavesRowsBeyondItsLimitToReportJson) {
  test::TemporaryFolder folder;
  auto writer = ReportWriter::create(folder.path(), {});
  for (std::uint64_t i = 0; i < kMaxHtmlRows + 7; ++i)
    ASSERT_TRUE(writer.value()->add(dropped("id_" + std::to_string(i)), nullptr, {}));
  ASSERT_TRUE(writer.value()->finish(run_report()));
  const std::string html = test::read_file(folder.path() / "report.html");
  EXPECT_THAT(html, HasSubstr("id_4999<"));
  EXPECT_THAT(html, Not(HasSubstr("id_5000<")));
  EXPECT_THAT(html, HasSubstr("report.json has all"));
  EXPECT_EQ(
      nlohmann::json::parse(test::read_file(folder.path() / "report.json"))["buildings"].size(),
      kMaxHtmlRows + 7);
}

TEST(RunJson, HasTimingsThreadsAndHost) {
  test::TemporaryFolder folder;
  ASSERT_TRUE(write_run_json(folder.path(), {{{"source", 0.5}, {"heal", 1.25}}, 2, 4, "here"}));
  const auto json = nlohmann::json::parse(test::read_file(folder.path() / "run.json"));
  EXPECT_EQ(json["stages_s"]["heal"], 1.25);
  EXPECT_EQ(json["total_s"], 2);
  EXPECT_EQ(json["threads"], 4);
  EXPECT_EQ(json["host"], "here");
}

}  // namespace
}  // namespace citymesh
