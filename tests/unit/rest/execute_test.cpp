#include "services/rest/execute.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

const ProcessSpec& export_process() { return *find_process("export-for-simulation"); }

std::string message_for(std::string_view body) {
  const auto spec = decode_execute(export_process(), body);
  return spec ? "accepted" : spec.error().message;
}

TEST(ExecuteRequest, PassesPlainValuesAndBoxesThroughUnchanged) {
  const auto spec = decode_execute(
      export_process(),
      R"({"inputs":{"bbox":{"bbox":[13.4,52.5,13.5,52.6],"crs":"http://www.opengis.net/def/crs/EPSG/0/25833"},
                    "formats":["obj","stl"],"unite_neighbours":false}})");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->process, "export-for-simulation");
  EXPECT_EQ(
      nlohmann::json::parse(spec->inputs_json),
      nlohmann::json::parse(
          R"({"bbox":{"bbox":[13.4,52.5,13.5,52.6],"crs":"http://www.opengis.net/def/crs/EPSG/0/25833"},
                    "formats":["obj","stl"],"unite_neighbours":false})"));
  EXPECT_TRUE(spec->outputs.empty());
  EXPECT_FALSE(spec->response_document);
}

TEST(ExecuteRequest, UnwrapsQualifiedValuesAlsoInsideArrays) {
  const auto spec = decode_execute(
      export_process(),
      R"({"inputs":{"bbox":{"value":{"bbox":[1,2,3,4]},"mediaType":"application/json"},
                    "formats":[{"value":"obj"},"stl"],"on_failure":{"value":"drop"}}})");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(nlohmann::json::parse(spec->inputs_json),
            nlohmann::json::parse(
                R"({"bbox":{"bbox":[1,2,3,4]},"formats":["obj","stl"],"on_failure":"drop"})"));
}

TEST(ExecuteRequest, TakesOutputsWithTheStandardsDefaults) {
  const auto spec = decode_execute(
      export_process(),
      R"({"outputs":{"obj":{"transmissionMode":"reference","format":{"mediaType":"model/obj"}},"report":{}}})");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_THAT(spec->outputs, ElementsAre(Pair("obj", Transmission::Reference),
                                         Pair("report", Transmission::Value)));
  EXPECT_FALSE(spec->response_document);
}

TEST(ExecuteRequest, WithAResponseFormButNoOutputsMeansAllOfThemByValue) {
  const auto spec =
      decode_execute(export_process(), R"({"inputs":{"formats":["stl"]},"response":"document"})");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_THAT(spec->outputs,
              ElementsAre(Pair("report", Transmission::Value), Pair("stl", Transmission::Value)));
  EXPECT_TRUE(spec->response_document);
}

TEST(ExecuteRequest, NamesWhereTheJsonIsMalformed) {
  EXPECT_THAT(message_for("{\"inputs\": {\n  \"bbox\": }"), HasSubstr("line 2, column 11"));
  EXPECT_THAT(message_for(""), HasSubstr("not valid JSON"));
  EXPECT_THAT(message_for("{} trailing"), HasSubstr("not valid JSON"));
  EXPECT_THAT(message_for("{\"inputs\":{\"crs\":\"\xff\"}}"), HasSubstr("not valid JSON"));
  EXPECT_THAT(message_for("{\"inputs\":{\"snap_tolerance_m\":1e999}}"),
              HasSubstr("not valid JSON"));
}

TEST(ExecuteRequest, NestedDeeperThanTheLimitIsRefusedBeforeParsing) {
  EXPECT_THAT(message_for(std::string(100'000, '[')), HasSubstr("nested deeper than 32"));
  EXPECT_THAT(
      message_for("{\"inputs\":{\"lod\":" + std::string(40, '[') + std::string(40, ']') + "}}"),
      HasSubstr("nested deeper than 32"));
  EXPECT_THAT(message_for("{\"inputs\":{\"crs\":\"" + std::string(100, '[') + "\"}}"), "accepted");
}

TEST(ExecuteRequest, NamesUnknownRepeatedAndWronglyTypedMembers) {
  EXPECT_THAT(message_for("[]"), HasSubstr("expected a JSON object"));
  EXPECT_THAT(message_for(R"({"input":{}})"), HasSubstr("unknown member `input`; known: inputs"));
  EXPECT_THAT(message_for(R"({"inputs":{},"inputs":{}})"), HasSubstr("`inputs` twice"));
  EXPECT_THAT(message_for(R"({"inputs":[]})"), HasSubstr("`inputs` is []"));
  EXPECT_THAT(message_for(R"({"inputs":{"crs":{"a":1}}})"), HasSubstr("input `crs` is {\"a\":1}"));
  EXPECT_THAT(message_for(R"({"outputs":["obj"]})"), HasSubstr("`outputs` is [\"obj\"]"));
  EXPECT_THAT(message_for(R"({"outputs":{"obj":{"transmissionMode":"fax"}}})"), HasSubstr("fax"));
  EXPECT_THAT(message_for(R"({"outputs":{"obj":{"format":{"mediaType":"model/stl"}}}})"),
              HasSubstr("expected \"model/obj\""));
  EXPECT_THAT(message_for(R"({"response":"xml"})"), HasSubstr("\"raw\" or \"document\""));
}

TEST(ExecuteRequest, SaysWhatItDoesNotSupport) {
  EXPECT_THAT(message_for(R"({"inputs":{"bbox":{"href":"http://example.org/box.json"}}})"),
              HasSubstr("inputs by reference are not supported"));
}

TEST(ExecuteRequest, NamesItsSubscriber) {
  const auto spec = decode_execute(
      export_process(),
      R"({"subscriber":{"successUri":"http://example.org/a","failedUri":"http://example.org/b"}})");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->subscriber.success_uri, "http://example.org/a");
  EXPECT_EQ(spec->subscriber.in_progress_uri, "");
  EXPECT_EQ(spec->subscriber.failed_uri, "http://example.org/b");
  for (const auto* wrong : {R"({"subscriber":1})", R"({"subscriber":{}})",
                            R"({"subscriber":{"successUri":7}})", R"({"subscriber":{"uri":"x"}})"})
    EXPECT_THAT(message_for(wrong), HasSubstr("subscriber")) << wrong;
}

}  // namespace
}  // namespace citymesh
