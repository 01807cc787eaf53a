#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/offer/offer.h"
#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr auto* kValidate = "/processes/validate/execution";
constexpr auto* kHeal = "/processes/heal/execution";

class RestExecution : public RestApi {
 protected:
  Response execute(const char* target, std::string prefer = {}, std::string body = kBox) {
    Fields fields;
    if (!prefer.empty()) fields.emplace_back("Prefer", std::move(prefer));
    return send("POST", target, std::move(body), std::move(fields));
  }
  /// What a waiting answer becomes now.
  static std::shared_ptr<Response> step(const Response& response, bool last = false) {
    return response.follow->step(last).answer;
  }
  std::string only_job() {
    const auto jobs = must(service_.jobs().list({}));
    EXPECT_EQ(jobs.size(), 1U);
    return jobs.at(0).id;
  }
};

TEST_F(RestExecution, ProcessesDeclareHowTheyCanBeExecuted) {
  for (const auto& process : offered_processes()) {
    const auto declared =
        document(get("/processes/" + std::string(process.id)))["jobControlOptions"];
    EXPECT_EQ(declared, process.async_only ? json({"async-execute", "dismiss"})
                                           : json({"sync-execute", "async-execute", "dismiss"}));
  }
}

TEST_F(RestExecution, AsyncOnlyProcessIsAJobWithAndWithoutPreference) {
  const auto plain = execute(kExecution);
  EXPECT_EQ(plain.status, 201);
  EXPECT_FALSE(plain.headers.has("Preference-Applied"));
  for (const auto* prefer : {"respond-async", "respond-async, wait=5", "wait=5"}) {
    const auto response = execute(kExecution, prefer);
    EXPECT_EQ(response.status, 201);
    EXPECT_FALSE(response.follow);
    EXPECT_EQ(response.headers.get("Preference-Applied"),
              prefers(prefer, "respond-async") ? "respond-async" : "");
  }
}

TEST_F(RestExecution, AnEstimateIsAnsweredAtOnceAndMakesNoJob) {
  for (const auto* target : {kExecution, kHeal, kValidate})
    for (const auto* prefer : {"", "respond-async"}) {
      const auto response = execute(target, prefer, R"({"inputs":{"mode":"estimate"}})");
      EXPECT_EQ(response.status, 200);
      EXPECT_FALSE(response.follow);
      EXPECT_FALSE(response.headers.has("Location"));
      EXPECT_EQ(document(response)["buildings"], 12);
      EXPECT_EQ(document(response)["expected"]["outputs"]["report"], 14'000);
    }
  EXPECT_EQ(execute(kHeal, "", R"({"inputs":{"mode":"guess"}})").status, 400);
  EXPECT_TRUE(must(service_.jobs().list({})).empty());
}

TEST_F(RestExecution, PreferRespondAsyncMakesAJobOfAnyProcess) {
  for (const auto* target : {kValidate, kHeal}) {
    const auto response = execute(target, "respond-async");
    EXPECT_EQ(response.status, 201);
    EXPECT_EQ(response.headers.get("Preference-Applied"), "respond-async");
    EXPECT_THAT(response.headers.get("Location"), StartsWith("http://citymesh.test:8080/jobs/"));
  }
}

TEST_F(RestExecution, WithoutPreferenceTheAnswerWaitsForTheResults) {
  const auto response = execute(kValidate);
  ASSERT_TRUE(response.follow);
  EXPECT_FALSE(response.follow->streams);
  EXPECT_EQ(response.follow->longest_s, 30);
  EXPECT_EQ(response.follow->job_id, only_job());
  EXPECT_FALSE(step(response));
  const auto claim = service_.start();
  EXPECT_FALSE(step(response));
  service_.succeed(claim, JobService::export_files());
  EXPECT_TRUE(step(response));
}

TEST_F(RestExecution, OneOutputIsTheAnswerItself) {
  const auto response = execute(kValidate);
  service_.succeed(service_.start(), {{"report", "report.json", "application/json", R"({"a":1})"},
                                      {"report.html", "report.html", "text/html", "<html/>"}});
  const auto answer = step(response);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->headers.get("Content-Type"), "application/json");
  EXPECT_EQ(text(*answer), R"({"a":1})");
  EXPECT_EQ(answer->headers.get("Content-Location"),
            "http://citymesh.test:8080/jobs/" + only_job() + "/results");
  EXPECT_FALSE(answer->headers.has("Link")) << "clients take it for the monitor";
  EXPECT_TRUE(answer->headers.has("X-Content-Type-Options")) << "the finish of every answer";
}

TEST_F(RestExecution, SeveralOutputsAreADocumentOfValues) {
  const auto response = execute(kHeal);
  service_.succeed(service_.start(), JobService::export_files());
  const auto answer = step(response);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->headers.get("Content-Type"), "application/json");
  const auto results = document(*answer);
  EXPECT_EQ(results["report"]["value"]["counts"]["requested"], 12);
  EXPECT_EQ(results["obj"], "o b_1\nv 0 0 0\n");
  EXPECT_EQ(results["stl_binary"]["encoding"], "base64");
}

TEST_F(RestExecution, TheRequestDecidesTheFormOfTheAnswer) {
  const auto answer_to = [&](std::string body) {
    const auto response = execute(kHeal, {}, std::move(body));
    service_.succeed(service_.start(), JobService::export_files());
    return *step(response);
  };
  EXPECT_EQ(text(answer_to(R"({"outputs":{"obj":{}},"response":"raw"})")), "o b_1\nv 0 0 0\n");
  EXPECT_THAT(answer_to(R"({"outputs":{"obj":{},"report":{}}})").headers.get("Content-Type"),
              StartsWith("multipart/related"));
  EXPECT_EQ(
      document(answer_to(R"({"outputs":{"report":{}},"response":"document"})"))["report"]["value"],
      json::parse(R"({"counts":{"requested":12}})"));
  const auto linked = answer_to(R"({"outputs":{"obj":{"transmissionMode":"reference"}}})");
  EXPECT_EQ(linked.status, 204);
  EXPECT_THAT(linked.headers.get("Link"), HasSubstr("/results/model.obj>"));
}

TEST_F(RestExecution, FailureOfTheJobIsTheAnswer) {
  const auto response = execute(kValidate);
  service_.fail_job(service_.start(), {ErrorCode::InvalidArgument, "the features have 2 CRSs"});
  const auto answer = step(response);
  ASSERT_TRUE(answer);
  EXPECT_EQ(detail(*answer, 400), "the features have 2 CRSs");
}

TEST_F(RestExecution, DismissedMeanwhileThereAreNoResults) {
  const auto response = execute(kValidate);
  must(service_.jobs().dismiss(only_job()));
  EXPECT_EQ(problem(*step(response), 404)["type"], kExceptions + "result-not-available");
}

TEST_F(RestExecution, ExpiredMeanwhileThereAreNoResults) {
  const auto response = execute(kValidate);
  service_.succeed(service_.start(), JobService::export_files());
  service_.expire_results();
  EXPECT_EQ(problem(*step(response), 404)["type"], kExceptions + "result-not-available");
}

TEST_F(RestExecution, AtTheEndOfTheWaitTheJobIsTheAnswerAndGoesOn) {
  const auto response = execute(kValidate);
  const auto answer = step(response, true);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 201);
  EXPECT_EQ(answer->headers.get("Location"), "http://citymesh.test:8080/jobs/" + only_job());
  EXPECT_EQ(document(*answer)["status"], "accepted");
  EXPECT_EQ(must(service_.jobs().get(only_job())).state, JobState::Accepted);
}

TEST_F(RestExecution, PreferWaitShortensTheWaitAndIsConfirmed) {
  const auto sync = execute(kValidate, "wait=5");
  ASSERT_TRUE(sync.follow);
  EXPECT_EQ(sync.follow->longest_s, 5);
  EXPECT_EQ(step(sync, true)->headers.get("Preference-Applied"), "wait=5");

  const auto either = execute(kValidate, "respond-async, wait=7");
  ASSERT_TRUE(either.follow);
  EXPECT_EQ(either.follow->longest_s, 7);
  EXPECT_EQ(step(either, true)->headers.get("Preference-Applied"), "respond-async");

  EXPECT_EQ(execute(kValidate, "wait=0").status, 201);
  const auto longer = execute(kValidate, "wait=86400");
  EXPECT_EQ(longer.follow->longest_s, 30) << "the server's limit holds";
  EXPECT_FALSE(step(longer, true)->headers.has("Preference-Applied"));
}

TEST_F(RestExecution, PreferencesThatCannotBeReadAreIgnored) {
  for (const auto* prefer : {"wait=soon", "wait=-1", "wait=1.5", "wait", "return=minimal", ",,;="})
    EXPECT_EQ(execute(kValidate, prefer).follow->longest_s, 30) << prefer;
}

TEST_F(RestExecution, AClientThatLeavesTakesItsJobWithIt) {
  const auto response = execute(kValidate);
  response.follow->client_left();
  EXPECT_EQ(must(service_.jobs().get(only_job())).state, JobState::Dismissed);
}

TEST_F(RestExecution, ARepeatedRequestWithItsKeyGetsTheJobOfTheFirstOne) {
  const Fields key = {{"Idempotency-Key", "\"3f1c2a\""}, {"Prefer", "respond-async"}};
  const auto first = send("POST", kExecution, kBox, key);
  ASSERT_EQ(first.status, 201);
  const auto again = send("POST", kExecution, kBox, key);
  EXPECT_EQ(again.status, 201);
  EXPECT_EQ(again.headers.get("Location"), first.headers.get("Location"));

  service_.succeed(service_.start(), JobService::export_files());
  const auto late = send("POST", kExecution, kBox, {{"Idempotency-Key", "3f1c2a"}});
  EXPECT_EQ(late.headers.get("Location"), first.headers.get("Location"));
  EXPECT_EQ(document(late)["status"], "successful");
  only_job();

  send("POST", kExecution, kBox, {{"Idempotency-Key", "another"}});
  send("POST", kExecution, kBox);
  EXPECT_EQ(must(service_.jobs().count({})), 3U);
}

TEST_F(RestExecution, ARepeatedRequestMayWaitForTheResultsOfTheFirstOne) {
  const Fields key = {{"Idempotency-Key", "3f1c2a"}};
  const auto first = send("POST", kValidate, kBox, key);
  ASSERT_TRUE(first.follow);
  EXPECT_FALSE(first.follow->client_left);  // it may come back
  const auto again = send("POST", kValidate, kBox, key);
  ASSERT_TRUE(again.follow);
  service_.succeed(service_.start(), JobService::export_files());
  EXPECT_EQ(step(again)->status, 200);
  only_job();
}

TEST_F(RestExecution, AKeyIsForOneRequestOnly) {
  const Fields key = {{"Idempotency-Key", "3f1c2a"}, {"Prefer", "respond-async"}};
  ASSERT_EQ(send("POST", kHeal, kBox, key).status, 201);
  const auto id = only_job();
  for (const auto& [target, body] :
       {std::pair<std::string, std::string>{kValidate, kBox},
        {kHeal, R"({"inputs":{"bbox":{"bbox":[13.4,52.5,13.42,52.51]}}})"},
        {kHeal, R"({"inputs":{"bbox":{"bbox":[13.4,52.5,13.41,52.51]}},"outputs":{"report":{}}})"}})
    EXPECT_THAT(detail(send("POST", target, body, key), 422), HasSubstr(id)) << body;
  EXPECT_EQ(only_job(), id);
}

TEST_F(RestExecution, AKeyIsFreeAgainWhenItsJobIsForgotten) {
  const Fields key = {{"Idempotency-Key", "3f1c2a"}, {"Prefer", "respond-async"}};
  send("POST", kHeal, kBox, key);
  const auto id = only_job();
  service_.succeed(service_.start(), JobService::export_files());
  service_.expire_results();
  EXPECT_EQ(document(send("POST", kHeal, kBox, key))["jobID"], id);
  service_.forget_jobs();
  EXPECT_EQ(send("POST", kValidate, kBox, key).status, 201);
  EXPECT_NE(only_job(), id);
}

TEST_F(RestExecution, AKeyThatCannotBeReadIsRefused) {
  for (const auto& key : {std::string(), std::string("\"\""), std::string("a\"b"),
                          std::string("a\\b"), std::string("\xc3\xa4"), std::string(256, 'k')})
    EXPECT_THAT(detail(send("POST", kHeal, kBox, {{"Idempotency-Key", key}}), 400),
                HasSubstr("Idempotency-Key"))
        << key;
  EXPECT_EQ(must(service_.jobs().count({})), 0U);
}

TEST_F(RestExecution, AServerThatNeverWaitsMakesAJobOfEveryExecution) {
  const Api never(service_.jobs(), service_.metrics(),
                  {.public_url = "http://c", .sync_wait_s = 0});
  EXPECT_EQ(never.handle({"POST", kValidate, {}, "{}"}).status, 201);
}

TEST_F(RestExecution, BadRequestsAreRefusedAtOnceAndLeaveNoJob) {
  for (const auto* body : {"", "{", "[]", "{\"inputs\":{\"a\":1,\"a\":2}}", "{\"x\":\"\xff\"}"}) {
    const auto response = send("POST", kValidate, body, {{"Content-Type", "application/json"}});
    EXPECT_FALSE(response.follow);
    problem(response, 400);
  }
  EXPECT_TRUE(must(service_.jobs().list({})).empty());
}

}  // namespace
}  // namespace citymesh
