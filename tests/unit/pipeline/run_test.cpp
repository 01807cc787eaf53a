#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/gates/gates.h"
#include "core/pipeline/pipeline.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Path = std::filesystem::path;

/// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    static int number = 0;
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("citymesh_" + std::string(info->name()) + "_" + std::to_string(::getpid()) + "_" +
             std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const Path& path() const { return path_; }
  std::string text(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    std::stringstream content;
    content << file.rdbuf();
    return content.str();
  }
  Path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  Path path_;
};

Path data(const std::string& name) { return Path(CITYMESH_TEST_DATA) / name; }

Result<RunOutcome> run_on(std::vector<Path> files, const Folder& folder,
                          const std::string& inputs = "{}", RunContext context = {},
                          std::string_view process = "export-for-simulation") {
  auto source = open_files(std::move(files), {});
  if (!source) return source.error();
  return run(process, inputs, **source, folder.path(), context);
}

/// Every body of a file, judged by the gates after reading it back.
void expect_gates_hold(const std::string& format, const Path& file, std::uint64_t bodies) {
  std::uint64_t count = 0;
  const auto parsed = parse_file(format, file, [&](ParsedBody&& body) -> Result<void> {
    const auto welded = weld(body);
    EXPECT_TRUE(welded) << body.name;
    for (const GateFailure& f : check_shell(welded->points, welded->triangles, {}))
      ADD_FAILURE() << format << " " << body.name << " " << f.gate << " " << f.where;
    ++count;
    return {};
  });
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(count, bodies);
}

std::string all_formats(const std::string& more = "") {
  std::string keys;
  for (const Format& format : formats())
    keys += (keys.empty() ? "\"" : ",\"") + std::string(format.key) + '"';
  return "{" + more + "\"formats\":[" + keys + "]}";
}

TEST(Run, DeliversAHouseInAllFormats) {
  Folder folder;
  const auto outcome = run_on({data("fzk-haus/fzk_haus_lod2_v2.gml")}, folder, all_formats());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(outcome->complete);
  EXPECT_EQ(outcome->report.counts.requested, 1u);
  EXPECT_EQ(outcome->report.counts.delivered, 1u);
  for (const Format& format : formats())
    expect_gates_hold(std::string(format.key), folder.path() / format.file_name, 1);
  for (const OutputFile& file : outcome->files)
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file.file_name));

  const auto report = nlohmann::json::parse(folder.text("report.json"));
  ASSERT_EQ(report["buildings"].size(), 1u);
  const auto& house = report["buildings"][0];
  EXPECT_EQ(house["outcome"], "delivered");
  EXPECT_EQ(house["rung"], "as_is");
  EXPECT_EQ(house["lane"], "2.5d");
  EXPECT_GT(house["volume_after_m3"].get<double>(), 500.0);
}

TEST(Run, EveryBuildingOfATileIsAccountedFor) {
  Folder folder;
  const auto outcome =
      run_on({data("berlin/3910_5817.gml")}, folder, R"({"formats":["obj","stl"]})");
  ASSERT_TRUE(outcome) << outcome.error().message;
  const Counts& counts = outcome->report.counts;
  EXPECT_EQ(counts.requested, 166u);
  EXPECT_EQ(counts.requested, counts.delivered + counts.merged + counts.dropped);
  EXPECT_EQ(outcome->report.part_counts.requested, 15u);
  expect_gates_hold("obj", folder.path() / "model.obj", outcome->report.bodies);
  expect_gates_hold("stl", folder.path() / "model.stl", outcome->report.bodies);
}

TEST(Run, SameBytesForAnyNumberOfThreads) {
  Folder one, many;
  RunContext parallel;
  parallel.threads = 4;
  const std::string inputs = R"({"formats":["obj","stl","cityjson"]})";
  ASSERT_TRUE(run_on({data("berlin/3910_5819.gml.gz")}, one, inputs));
  ASSERT_TRUE(run_on({data("berlin/3910_5819.gml.gz")}, many, inputs, parallel));
  for (const char* name :
       {"model.obj", "model.stl", "model.city.json", "report.json", "report.html", "picture.svg"})
    EXPECT_EQ(one.text(name), many.text(name)) << name;
}

TEST(Run, ItsOwnCityJsonGoesThroughUnchanged) {
  Folder first, second;
  ASSERT_TRUE(run_on({data("berlin/3900_5819.gml")}, first, R"({"formats":["cityjson"]})"));
  const auto again =
      run_on({first.path() / "model.city.json"}, second, R"({"formats":["cityjson"]})");
  ASSERT_TRUE(again) << again.error().message;
  for (const auto& [rung, count] : again->report.rungs) EXPECT_EQ(rung, "as_is");
  EXPECT_EQ(first.text("model.city.json"), second.text("model.city.json"));
}

TEST(Run, AnEmptyBoxIsASuccessWithAWarning) {
  Folder folder;
  const auto outcome = run_on({data("berlin/3900_5819.gml")}, folder,
                              all_formats(R"("bbox":{"bbox":[13.0,52.0,13.01,52.01]},)"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(outcome->complete);
  EXPECT_EQ(outcome->report.counts.requested, 0u);
  EXPECT_THAT(outcome->report.warnings, ::testing::Not(IsEmpty()));
}

TEST(Run, BinaryStlBeyondItsRangeIsRefusedNamingAscii) {
  Folder folder;
  const auto outcome = run_on({data("berlin/3900_5819.gml"), data("berlin/3920_5820.gml")}, folder,
                              R"({"formats":["stl_binary"]})");
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(outcome.error().message, HasSubstr("ASCII"));
  EXPECT_THAT(outcome.error().message, HasSubstr("1024"));
  EXPECT_THAT(outcome.error().message, HasSubstr("body \"BLDG_"));
}

TEST(Run, ARepeatedIdKeepsTheFirst) {
  Folder folder;
  const auto outcome = run_on(
      {data("fzk-haus/fzk_haus_lod2_v2.gml"), data("fzk-haus/fzk_haus_lod2_v2.gml")}, folder);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->report.counts.requested, 2u);
  EXPECT_EQ(outcome->report.counts.delivered, 1u);
  ASSERT_EQ(outcome->report.drop_reasons.size(), 1u);
  EXPECT_EQ(outcome->report.drop_reasons[0].first, "duplicate_id");
  EXPECT_FALSE(outcome->complete);
}

TEST(Run, ABrokenFileDoesNotTakeTheOthersDown) {
  Folder folder, inputs;
  const Path broken =
      inputs.write("broken.gml", "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\"><oops>");
  const auto outcome = run_on({broken, data("fzk-haus/fzk_haus_lod2_v2.gml")}, folder);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->report.counts.delivered, 1u);
  EXPECT_FALSE(outcome->complete);
  const auto report = nlohmann::json::parse(folder.text("report.json"));
  EXPECT_EQ(report["inputs"][0]["state"], "failed");
  EXPECT_EQ(report["inputs"][1]["state"], "read");
}

TEST(Run, StopsWhenAsked) {
  Folder folder;
  std::stop_source stop;
  RunContext context;
  context.stop = stop.get_token();
  context.on_progress = [&](const Progress& progress) {
    if (progress.stage == "heal") stop.request_stop();
  };
  const auto outcome = run_on({data("berlin/3910_5817.gml")}, folder, "{}", context);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::Cancelled);
}

TEST(Run, ProgressEndsAtTheTotal) {
  Folder folder;
  std::uint64_t last = 0, total = 0;
  RunContext context;
  context.on_progress = [&](const Progress& progress) {
    if (progress.stage != "heal") return;
    EXPECT_GE(progress.done, last);
    last = progress.done;
    total = progress.total;
  };
  ASSERT_TRUE(run_on({data("berlin/3920_5820.gml")}, folder, "{}", context));
  EXPECT_EQ(last, 6u);
  EXPECT_EQ(total, 6u);
}

TEST(Run, ValidateChangesNothingAndCountsDefects) {
  Folder folder;
  const auto outcome = run_on({data("berlin/3910_5817.gml")}, folder, "{}", {}, "validate");
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GT(outcome->invalid_buildings, 0u);
  EXPECT_LT(outcome->invalid_buildings, 166u);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "model.obj"));
  Folder clean;
  const auto valid = run_on({data("fzk-haus/fzk_haus_lod2_v2.gml")}, clean, "{}", {}, "validate");
  ASSERT_TRUE(valid);
  EXPECT_EQ(valid->invalid_buildings, 0u);
}

TEST(Run, OnFailureDropDropsWithTheReason) {
  Folder folder;
  const auto outcome =
      run_on({data("cityjson/rotterdam_subset.json")}, folder, R"({"on_failure":"drop"})");
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->report.counts.requested, 16u);
  for (const auto& [rung, count] : outcome->report.rungs) EXPECT_NE(rung, "lod1_block");
}

}  // namespace
}  // namespace citymesh
