// What the executable test suite of OGC API - Processes 1.0 checks of conformance class core, with
// the requests that it sends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/rest/live_service.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr auto* kTestString = "teststring";

class ConformanceCore : public LiveService {
 protected:
  ConformanceCore() : echo_(document("/processes/echo")) {}

  /// The value that the suite gives to an input, by the schema of its description; nothing for
  /// kinds that it does not know.
  static std::optional<json> value_for(const json& schema) {
    const auto type = schema.value("type", "");
    if (type == "string" && !schema.contains("format") && !schema.contains("contentMediaType"))
      return kTestString;
    if (type == "array" && schema["items"].value("type", "") == "string") return kTestString;
    if (type == "object" && schema.contains("properties") && schema["properties"].contains("bbox"))
      return json{{"bbox", {345345345, 345345345, 345345345, 345345345}},
                  {"crs", "urn:ogc:def:crs:EPSG:6.6:4326"}};
    if (type == "object") return json{{"value", kTestString}};
    return std::nullopt;
  }
  json request() const {
    json inputs, outputs;
    for (const auto& [id, input] : echo_["inputs"].items())
      if (auto value = value_for(input["schema"])) inputs[id] = *value;
    for (const auto& [id, output] : echo_["outputs"].items())
      outputs[id] = {{"transmissionMode", "value"}};
    return {{"inputs", inputs}, {"outputs", outputs}};
  }
  json request_of_one_output() const {
    auto one = request();
    one["outputs"] = {{"text", {{"transmissionMode", "value"}}}};
    one["response"] = "raw";
    return one;
  }

  json echo_;
};

TEST_F(ConformanceCore, LandingPageHasTheLinksAskedFor) {
  const auto landing = document("/");
  expect_links(landing);
  EXPECT_TRUE(link(landing, "service-desc") || link(landing, "service-doc"));
  EXPECT_TRUE(link(landing, std::string(kOgc) + "conformance"));
  EXPECT_TRUE(link(landing, std::string(kOgc) + "processes"));
  for (const auto& link : landing["links"])
    EXPECT_EQ(get(link["href"].get<std::string>(), link["type"].get<std::string>()).status, 200)
        << link;
}

TEST_F(ConformanceCore, ConformanceNamesTheClass) {
  const auto classes = document("/conformance")["conformsTo"];
  EXPECT_NE(std::find(classes.begin(), classes.end(), std::string(kConformance) + "core"),
            classes.end());
}

TEST_F(ConformanceCore, ProcessListIsCutByLimit) {
  const auto all = document("/processes");
  expect_links(all);
  EXPECT_GT(all["processes"].size(), 1U);
  for (const auto& process : all["processes"]) {
    EXPECT_TRUE(process.at("id").is_string());
    EXPECT_TRUE(process.at("version").is_string());
    expect_links(process);
  }
  EXPECT_EQ(document("/processes?limit=1")["processes"].size(), 1U);
}

TEST_F(ConformanceCore, EveryProcessOfTheListCanBeGot) {
  const json processes = document("/processes")["processes"];
  for (const auto& process : processes) {
    const auto described = document(*link(process, "self"));
    EXPECT_EQ(described["id"], process["id"]);
    EXPECT_TRUE(link(described, std::string(kOgc) + "execute"));
  }
}

TEST_F(ConformanceCore, UnknownProcessAndUnknownJobAreExceptions) {
  expect_exception(get("/processes/invalid-process-7"), 404, "no-such-process");
  expect_exception(send("POST", "/processes/invalid-process-7/execution", R"({"inputs":{}})"), 404,
                   "no-such-process");
  const std::string job = "/jobs/invalid-job-00000000-0000-4000-8000-000000000000";
  expect_exception(get(job), 404, "no-such-job");
  expect_exception(get(job + "/results"), 404, "no-such-job");
  expect_exception(send("DELETE", job), 404, "no-such-job");
}

TEST_F(ConformanceCore, FirstInputOfEchoIsAPlainTextThatComesBack) {
  EXPECT_EQ(echo_["inputs"].begin().key(), "binary");  // the parser sorts; the text itself does not
  const auto text = get("/processes/echo").body;
  const auto inputs = text.find("\"inputs\"");
  EXPECT_LT(text.find("\"text\": {", inputs), text.find("\"binary\": {", inputs));
  for (const auto& [id, output] : echo_["outputs"].items())
    EXPECT_TRUE(echo_["inputs"].contains(id)) << id;
}

TEST_F(ConformanceCore, WithoutPreferenceTheExecutionIsSynchronous) {
  const auto answer = execute(request());
  EXPECT_EQ(answer.status, 200) << answer.body;
  EXPECT_FALSE(answer.headers.contains("link"));
}

TEST_F(ConformanceCore, RespondAsyncIsAnsweredWithAJobThatCanBeFollowedByLinks) {
  const auto answer = execute(request(), "respond-async ");
  ASSERT_EQ(answer.status, 201) << answer.body;
  EXPECT_EQ(answer.headers.at("preference-applied"), "respond-async");
  const auto location = answer.headers.at("location");
  EXPECT_THAT(location, StartsWith("http://127.0.0.1:"));
  expect_status_info(json::parse(answer.body));
  expect_status_info(document(location));
  const auto status = ended(location);
  expect_status_info(status);
  EXPECT_EQ(status["status"], "successful") << status;
  const auto results = link(status, std::string(kOgc) + "results");
  ASSERT_TRUE(results);
  EXPECT_THAT(get(*results, "").body, HasSubstr(kTestString));
}

TEST_F(ConformanceCore, OutputsMayBeAbsent) {
  auto wanted = request();
  wanted.erase("outputs");
  const auto answer = execute(wanted);
  ASSERT_EQ(answer.status, 200) << answer.body;
  const auto results = json::parse(answer.body);
  for (const auto& [id, value] : wanted["inputs"].items()) EXPECT_TRUE(results.contains(id)) << id;
}

TEST_F(ConformanceCore, TakesInputsOfEveryKindInline) {
  auto array = request();
  array["inputs"]["list"] = {"test1", "test2", "test3"};
  auto box = request();
  box["inputs"]["box"] = {{"bbox", {51.9, 7, 52, 7.1}},
                          {"crs", "http://www.opengis.net/def/crs/OGC/1.3/CRS84"}};
  auto binary = request();  // as the suite sends it, in the form of an older draft
  binary["inputs"]["binary"] = {
      {"value", "SUkqAA=="},
      {"format", {{"mediaType", "application/octet-stream"}, {"encoding", "base64"}}}};
  for (const auto& wanted : {array, box, binary}) EXPECT_EQ(execute(wanted).status, 200) << wanted;
}

TEST_F(ConformanceCore, InputOfTheWrongFormatIsAnExceptionInPlainJson) {
  std::size_t formats = 0;
  auto wrong = request();
  for (const auto& [id, input] : echo_["inputs"].items())
    if (input["schema"].contains("contentMediaType")) {
      wrong["inputs"][id] = {{"type", "wrong/type_0"}};
      ++formats;
    }
  ASSERT_GT(formats, 0U);
  const auto answer = execute(wrong);
  EXPECT_EQ(answer.headers.at("content-type"), "application/json");
  EXPECT_EQ(answer.status, 400);
  EXPECT_TRUE(json::parse(answer.body)["type"].is_string());
}

TEST_F(ConformanceCore, InputsAreValidatedAgainstTheirSchemas) {
  for (const auto* wrong :
       {R"({"inputs":{"number":"many"}})", R"({"inputs":{"integer":1.5}})",
        R"({"inputs":{"boolean":"yes"}})", R"({"inputs":{"binary":"not base64"}})",
        R"({"inputs":{"box":{"bbox":[1,2,3]}}})", R"({"inputs":{"text":{"value":1}}})",
        R"({"inputs":{"unknown":1}})", R"({"outputs":{"unknown":{}}})", R"({"inputs":[]})"})
    EXPECT_EQ(execute(json::parse(wrong)).status, 400) << wrong;
}

TEST_F(ConformanceCore, OneRawValueIsTheValueItself) {
  const auto now = execute(request_of_one_output());
  EXPECT_EQ(now.status, 200);
  EXPECT_EQ(now.body, kTestString);
  EXPECT_THAT(now.headers.at("content-type"), StartsWith("text/plain"));

  const auto job = execute(request_of_one_output(), "respond-async");
  const auto status = ended(job.headers.at("location"));
  EXPECT_EQ(get(*link(status, std::string(kOgc) + "results"), "").body, kTestString);
}

TEST_F(ConformanceCore, SeveralRawValuesAreMultipart) {
  auto wanted = request();
  wanted["response"] = "raw";
  const auto answer =
      send("POST", kEchoExecution, wanted.dump(), "multipart/related, application/json;q=0.5");
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.headers.at("content-type"), StartsWith("multipart/related"));
  EXPECT_THAT(answer.body, HasSubstr("Content-ID: <text>"));
  EXPECT_THAT(answer.body, HasSubstr(kTestString));
}

TEST_F(ConformanceCore, RawReferencesAreLinksWithoutABody) {
  auto wanted = request_of_one_output();
  wanted["outputs"]["text"]["transmissionMode"] = "reference";
  const auto answer = execute(wanted);
  EXPECT_EQ(answer.status, 204);
  EXPECT_TRUE(answer.body.empty());
  const auto header = answer.headers.at("link");
  EXPECT_EQ(get(header.substr(1, header.find('>') - 1), "").body, kTestString);
}

TEST_F(ConformanceCore, DocumentHoldsEveryValue) {
  auto wanted = request();
  wanted["response"] = "document";
  wanted["inputs"]["number"] = 1.5;
  for (const auto* prefer : {"", "respond-async"}) {
    auto answer = execute(wanted, prefer);
    if (answer.status == 201) {
      const auto status = ended(answer.headers.at("location"));
      answer = get(*link(status, std::string(kOgc) + "results"));
    }
    ASSERT_EQ(answer.status, 200);
    EXPECT_EQ(answer.headers.at("content-type"), "application/json");
    const auto results = json::parse(answer.body);
    EXPECT_EQ(results["text"], kTestString);
    EXPECT_EQ(results["number"]["value"], 1.5);
    EXPECT_EQ(results["box"]["value"]["bbox"][0], 345345345);
    EXPECT_FALSE(results.contains("binary"));
  }
}

TEST_F(ConformanceCore, ResultsBeforeTheEndAreNotReady) {
  auto wanted = request_of_one_output();
  wanted["inputs"]["pause"] = 60;
  const auto location = execute(wanted, "respond-async").headers.at("location");
  const auto results = get(location + "/results");
  expect_exception(results, 404, "result-not-ready");
  EXPECT_EQ(send("DELETE", location).status, 200);
}

TEST_F(ConformanceCore, ResultsOfAFailedJobAreTheReason) {
  const auto job = send("POST", "/processes/heal/execution", R"({"inputs":{}})", "application/json",
                        "Prefer: respond-async\r\n");
  const auto status = ended(job.headers.at("location"));
  expect_status_info(status);
  EXPECT_EQ(status["status"], "failed");
  EXPECT_TRUE(status["exception"]["type"].is_string());
  EXPECT_EQ(status["exception"]["detail"], "this service has no cities");
  const auto reason = link(status, std::string(kOgc) + "exceptions");
  ASSERT_TRUE(reason);
  const auto answer = get(*reason);
  EXPECT_GE(answer.status, 400);
  EXPECT_EQ(json::parse(answer.body)["type"], status["exception"]["type"]);
}

}  // namespace
}  // namespace citymesh
