// Conformance classes OGC process description, JSON, OpenAPI 3.0, job list and dismiss.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/integration/rest/live_service.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::StartsWith;

using ConformanceClasses = LiveService;
using ConformanceProcessDescription = LiveService;
using ConformanceJson = LiveService;
using ConformanceOpenApi = LiveService;

TEST_F(ConformanceClasses, AreDeclared) {
  const auto declared = document("/conformance")["conformsTo"].get<std::set<std::string>>();
  std::set<std::string> expected;
  for (const auto* name : {"core", "ogc-process-description", "json", "html", "oas30", "job-list",
                           "callback", "dismiss"})
    expected.insert(std::string(kConformance) + name);
  EXPECT_EQ(declared, expected);
}

TEST_F(ConformanceProcessDescription, HasInputsAndOutputsWithSchemas) {
  const json control = {"sync-execute", "async-execute", "dismiss"};
  const json transmission = {"value", "reference"};
  const json processes = document("/processes")["processes"];
  for (const auto& process : processes) {
    const auto described = document(*link(process, "self"));
    EXPECT_TRUE(described["id"].is_string());
    EXPECT_TRUE(described["version"].is_string());
    for (const auto& option : described["jobControlOptions"])
      EXPECT_NE(std::find(control.begin(), control.end(), option), control.end());
    for (const auto& mode : described["outputTransmission"])
      EXPECT_NE(std::find(transmission.begin(), transmission.end(), mode), transmission.end());
    expect_links(described);
    ASSERT_TRUE(described["inputs"].is_object());
    for (const auto& [id, input] : described["inputs"].items()) {
      EXPECT_TRUE(input["schema"].is_object()) << id;
      EXPECT_TRUE(input["title"].is_string()) << id;
      if (input.contains("minOccurs")) {
        EXPECT_TRUE(input["minOccurs"].is_number_unsigned());
      }
    }
    ASSERT_TRUE(described["outputs"].is_object());
    for (const auto& [id, output] : described["outputs"].items())
      EXPECT_TRUE(output["schema"].is_object()) << id;
  }
}

TEST_F(ConformanceProcessDescription, SchemasOfEchoAreOfEveryKind) {
  std::set<std::string> types;
  const auto echo = document("/processes/echo");
  for (const auto& [id, input] : echo["inputs"].items())
    types.insert(input["schema"]["type"].get<std::string>());
  EXPECT_EQ(types,
            (std::set<std::string>{"array", "boolean", "integer", "number", "object", "string"}));
  EXPECT_EQ(echo["inputs"]["box"]["schema"]["format"], "ogc-bbox");
  EXPECT_EQ(echo["inputs"]["binary"]["schema"]["contentMediaType"], "application/octet-stream");
  EXPECT_EQ(echo["outputs"]["number"]["schema"]["type"], "number");
  EXPECT_EQ(echo["outputs"]["box"]["schema"]["properties"]["bbox"]["type"], "array");
}

TEST_F(ConformanceJson, EveryResourceIsJsonWhenAskedFor) {
  const auto location =
      execute({{"inputs", {{"text", "a"}}}}, "respond-async").headers.at("location");
  const auto status = ended(location);
  for (const auto& target :
       {std::string("/"), std::string("/conformance"), std::string("/processes"),
        std::string("/processes/echo"), std::string("/jobs"), location, location + "/results"}) {
    const auto answer = get(target);
    EXPECT_EQ(answer.status, 200) << target;
    EXPECT_EQ(answer.headers.at("content-type"), "application/json") << target;
    EXPECT_TRUE(json::accept(answer.body)) << target;
    EXPECT_EQ(get(target, "").headers.at("content-type"), "application/json") << target;
    EXPECT_EQ(get(target + "?f=json", "text/html").headers.at("content-type"), "application/json");
  }
}

TEST_F(ConformanceOpenApi, DefinitionIsThatOfTheService) {
  const auto landing = document("/");
  const auto definition = link(landing, "service-desc");
  ASSERT_TRUE(definition);
  const auto answer = get(*definition, "application/vnd.oai.openapi+json;version=3.0");
  EXPECT_EQ(answer.headers.at("content-type"), "application/vnd.oai.openapi+json;version=3.0");
  const auto api = json::parse(answer.body);
  EXPECT_THAT(api["openapi"].get<std::string>(), StartsWith("3.0."));
  for (const auto* path :
       {"/", "/conformance", "/processes", "/processes/{processID}", "/processes/echo/execution",
        "/jobs", "/jobs/{jobID}", "/jobs/{jobID}/results"})
    EXPECT_TRUE(api["paths"].contains(path)) << path;
  EXPECT_TRUE(api["paths"]["/jobs/{jobID}"].contains("delete"));
}

class ConformanceJobs : public LiveService {
 protected:
  std::string paused_job() {
    return execute({{"inputs", {{"text", "a"}, {"pause", 60}}}}, "respond-async")
        .headers.at("location");
  }
  std::string ended_job() {
    auto location = execute({{"inputs", {{"text", "a"}}}}, "respond-async").headers.at("location");
    ended(location);
    return location;
  }
  std::size_t count(const std::string& query) {
    const auto list = document("/jobs" + query);
    expect_links(list);
    for (const auto& job : list["jobs"]) expect_status_info(job);
    return list["jobs"].size();
  }
};

TEST_F(ConformanceJobs, ListHasEveryJobWithItsProcess) {
  ended_job();
  execute({{"inputs", {{"text", "synchronous"}}}});
  EXPECT_EQ(link(document("/"), std::string(kOgc) + "job-list"),
            fmt::format("http://127.0.0.1:{}/jobs", port_));
  EXPECT_EQ(count(""), 2U);
}

TEST_F(ConformanceJobs, ListIsFilteredByEveryParameterOfTheStandard) {
  const auto done = ended_job();
  const auto open = paused_job();
  EXPECT_EQ(count("?type=process"), 2U);
  EXPECT_EQ(count("?processID=echo"), 2U);
  EXPECT_EQ(count("?processID=heal"), 0U);
  EXPECT_EQ(count("?processID=heal,echo"), 2U);
  EXPECT_EQ(count("?status=successful"), 1U);
  EXPECT_EQ(count("?status=successful,running,accepted"), 2U);
  EXPECT_EQ(count("?datetime=2000-01-01T00:00:00Z/.."), 2U);
  EXPECT_EQ(count("?datetime=../2000-01-01T00:00:00Z"), 0U);
  EXPECT_EQ(count("?minDuration=3600"), 0U);
  EXPECT_EQ(count("?maxDuration=3600&status=successful"), 1U);
  for (const auto* wrong : {"?status=lost", "?type=cake", "?limit=0", "?limit=many",
                            "?minDuration=long", "?datetime=yesterday"})
    EXPECT_EQ(get(std::string("/jobs") + wrong).status, 400) << wrong;
  EXPECT_EQ(send("DELETE", open).status, 200);
}

TEST_F(ConformanceJobs, ListIsPagedByLimitAndItsNextLink) {
  for (int i = 0; i < 3; ++i) ended_job();
  std::set<std::string> seen;
  std::optional<std::string> page = "/jobs?limit=2";
  for (int pages = 0; page; ++pages) {
    ASSERT_LT(pages, 2);
    const auto list = document(*page);
    EXPECT_LE(list["jobs"].size(), 2U);
    for (const auto& job : list["jobs"]) seen.insert(job["jobID"].get<std::string>());
    page = link(list, "next");
  }
  EXPECT_EQ(seen.size(), 3U);
}

TEST_F(ConformanceJobs, DismissEndsAJobAndSaysSo) {
  const json processes = document("/processes")["processes"];
  for (const auto& process : processes)
    EXPECT_NE(std::find(process["jobControlOptions"].begin(), process["jobControlOptions"].end(),
                        "dismiss"),
              process["jobControlOptions"].end());
  const auto job = paused_job();
  while (document(job)["status"] == "accepted") continue;
  const auto answer = send("DELETE", job);
  EXPECT_EQ(answer.status, 200);
  const auto status = json::parse(answer.body);
  expect_status_info(status);
  EXPECT_EQ(status["status"], "dismissed");
  EXPECT_EQ(document(job)["status"], "dismissed");
  EXPECT_EQ(get(job + "/results").status, 404);
}

TEST_F(ConformanceJobs, PauseOfEchoIsSeenAsProgress) {
  const auto job = paused_job();
  auto status = document(job);
  while (!status.contains("stage")) status = document(job);
  EXPECT_EQ(status["stage"], "pause");
  EXPECT_EQ(status["total"], 60);
  EXPECT_THAT(status["message"].get<std::string>(), testing::HasSubstr("of 60 seconds"));
  EXPECT_EQ(send("DELETE", job).status, 200);
}

}  // namespace
}  // namespace citymesh
