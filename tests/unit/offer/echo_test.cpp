#include "services/offer/echo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "services/offer/offer.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Echo : public testing::Test {
 protected:
  /// Content of every output, by its id.
  std::map<std::string, std::string> echoed(const std::string& inputs) {
    const auto files = run_echo(inputs, folder_.path(), {});
    EXPECT_TRUE(files) << files.error().message;
    std::map<std::string, std::string> contents;
    if (files)
      for (const auto& file : *files)
        contents[std::string(file.name)] = read(folder_.path() / file.file_name);
    return contents;
  }
  static std::string refused(const std::string& inputs) {
    const auto checked = checked_inputs("echo", inputs);
    EXPECT_FALSE(checked) << inputs;
    if (checked) return {};
    EXPECT_EQ(checked.error().code, ErrorCode::InvalidArgument);
    return checked.error().message;
  }

  TempFolder folder_;
};

TEST_F(Echo, IsOfferedBesideTheProcessesOfCities) {
  EXPECT_EQ(offered_processes().size(), processes().size() + 1);
  ASSERT_NE(find_offered("echo"), nullptr);
  EXPECT_EQ(find_process("echo"), nullptr);
  EXPECT_NE(find_offered("heal"), nullptr);
  EXPECT_EQ(find_offered("sing"), nullptr);
  EXPECT_THAT(offered_ids(), HasSubstr("echo"));
}

TEST_F(Echo, HasAnOutputForEveryInputButThePause) {
  const auto& process = echo_process();
  ASSERT_EQ(process.inputs.size(), process.outputs.size() + 1);
  for (std::size_t i = 0; i < process.outputs.size(); ++i)
    EXPECT_EQ(process.inputs[i].name, process.outputs[i].id);
  EXPECT_EQ(process.inputs.front().kind, OptionKind::Text);
}

TEST_F(Echo, GivesBackWhatItWasGivenAndNothingElse) {
  const auto contents = echoed(R"({"text":"Straße","number":1.5,"integer":-7,"boolean":false,
      "list":["a","a"],"object":{"a":{"b":null}},"measure":{"measurement":10.3,"uom":"m"},
      "box":{"bbox":[345345345,345345345,345345345,345345345],"crs":"urn:ogc:def:crs:EPSG:6.6:4326"},
      "binary":"AAECAw=="})");
  EXPECT_EQ(contents.size(), 9U);
  EXPECT_EQ(contents.at("text"), "Straße");
  EXPECT_EQ(contents.at("number"), "1.5");
  EXPECT_EQ(contents.at("integer"), "-7");
  EXPECT_EQ(contents.at("boolean"), "false");
  EXPECT_EQ(json::parse(contents.at("list")), json({"a", "a"}));
  EXPECT_EQ(json::parse(contents.at("object")), json::parse(R"({"a":{"b":null}})"));
  EXPECT_EQ(json::parse(contents.at("measure"))["uom"], "m");
  EXPECT_EQ(json::parse(contents.at("box"))["crs"], "urn:ogc:def:crs:EPSG:6.6:4326");
  EXPECT_EQ(contents.at("binary"), std::string("\0\1\2\3", 4));
}

TEST_F(Echo, LeavesOutWhatItWasNotGiven) {
  EXPECT_TRUE(echoed("{}").empty());
  const auto contents = echoed(R"({"text":""})");
  ASSERT_EQ(contents.size(), 1U);
  EXPECT_EQ(contents.at("text"), "");
}

TEST_F(Echo, ChecksTheKindOfItsInputs) {
  EXPECT_THAT(refused(R"({"text":1})"), HasSubstr("`text`"));
  EXPECT_THAT(refused(R"({"integer":1.5})"), HasSubstr("whole number"));
  EXPECT_THAT(refused(R"({"list":1})"), HasSubstr("`list`"));
  EXPECT_THAT(refused(R"({"box":{"bbox":[1,2,3]}})"), HasSubstr("`box`"));
  EXPECT_THAT(refused(R"({"box":[1,2,3,4]})"), HasSubstr("`box`"));
  for (const auto* text : {"a", "====", "a===", "!!!!", "AAE"})
    EXPECT_THAT(refused(json{{"binary", text}}.dump()), HasSubstr("base64")) << text;
  EXPECT_THAT(refused(R"({"pause":61})"), HasSubstr("from 0 to 60"));
  EXPECT_THAT(refused(R"({"pause":-1})"), HasSubstr("from 0 to 60"));
  EXPECT_THAT(refused(R"({"sound":1})"), HasSubstr("`sound` does not exist for echo"));
}

TEST_F(Echo, CheckedInputsStayAsTheyAre) {
  const auto once = checked_inputs("echo", R"({"text":"a","list":"one"})");
  ASSERT_TRUE(once);
  EXPECT_EQ(checked_inputs("echo", once->json)->json, once->json);
  EXPECT_EQ(json::parse(once->json)["list"], json::array({"one"}));
}

TEST_F(Echo, ReportsItsPauseAndEndsItWhenStopped) {
  std::stop_source stop;
  RunContext context;
  context.stop = stop.get_token();
  std::vector<std::string> stages;
  context.on_progress = [&](const Progress& progress) {
    stages.emplace_back(progress.stage);
    EXPECT_EQ(progress.total, 60U);
    stop.request_stop();
  };
  const auto outcome = run_echo(R"({"text":"a","pause":60})", folder_.path(), context);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::Cancelled);
  EXPECT_THAT(stages, ElementsAre("pause"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace citymesh
