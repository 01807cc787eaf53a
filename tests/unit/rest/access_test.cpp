#include "services/access/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "services/access/api_keys.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class RestAccess : public RestApi {
 protected:
  RestAccess() {
    std::ofstream keys(folder_ / "keys");
    for (const auto* key : {&city_, &reader_of_city_, &port_, &operator_})
      keys << key->line << '\n';
    keys.close();
    access_ = must(Access::open({.api_keys = folder_ / "keys"}));
    api_.emplace(service_.jobs(), service_.metrics(), ApiOptions{.access = access_.get()});
  }

  Response send_as(const NewApiKey& key, std::string method, std::string target,
                   std::string body = {}) {
    return send_with({{"Authorization", "Bearer " + key.key}}, std::move(method), std::move(target),
                     std::move(body));
  }
  Response send_with(Fields fields, std::string method, std::string target, std::string body = {}) {
    Request request{std::move(method), std::move(target), {}, std::move(body)};
    request.headers.set("Host", "citymesh.test");
    for (auto& [name, value] : fields) request.headers.set(name, value);
    return api_->handle(request);
  }
  std::string submit_as(const NewApiKey& key) {
    const auto response = send_as(key, "POST", kExecution, kBox);
    EXPECT_EQ(response.status, 201) << text(response);
    return document(response)["jobID"];
  }
  std::vector<std::string> listed_for(const NewApiKey& key) {
    std::vector<std::string> ids;
    const auto list = document(send_as(key, "GET", "/jobs"));
    for (const auto& job : list["jobs"]) ids.push_back(job["jobID"]);
    return ids;
  }

  TempFolder folder_;
  NewApiKey city_ = must(make_api_key("city", Role::Submit));
  NewApiKey reader_of_city_ = must(make_api_key("city", Role::ReadOwn));
  NewApiKey port_ = must(make_api_key("port", Role::Submit));
  NewApiKey operator_ = must(make_api_key("operator", Role::Admin));
  std::unique_ptr<Access> access_;
  std::optional<Api> api_;
};

TEST_F(RestAccess, WhatTheServiceIsAnybodyMayAsk) {
  for (const auto* path : {"/", "/conformance", "/api", "/openapi.json", "/processes",
                           "/processes/heal", "/healthz", "/readyz"})
    EXPECT_EQ(send_with({}, "GET", path).status, 200) << path;
  EXPECT_EQ(send_with({}, "OPTIONS", "/jobs").status, 204);
  EXPECT_EQ(send_with({}, "GET", "/nowhere").status, 404);
}

TEST_F(RestAccess, EverythingElseWantsToKnowWhoAsks) {
  const auto id = submit_as(city_);
  for (const auto& path :
       {std::string("/jobs"), "/jobs/" + id, "/jobs/" + id + "/events", "/jobs/" + id + "/results",
        "/jobs/" + id + "/results/obj", std::string("/metrics")}) {
    const auto response = send_with({}, "GET", path);
    EXPECT_EQ(response.status, 401) << path;
    EXPECT_EQ(response.headers.get("WWW-Authenticate"), R"(Bearer realm="citymesh")");
    EXPECT_EQ(response.headers.get("Content-Type"), "application/problem+json");
    EXPECT_THAT(text(response), HasSubstr("X-API-Key"));
    EXPECT_EQ(send_with({}, "HEAD", path).status, 401) << path;
  }
  EXPECT_EQ(send_with({}, "POST", kExecution, kBox).status, 401);
  EXPECT_EQ(send_with({}, "DELETE", "/jobs/" + id).status, 401);
  EXPECT_EQ(listed_for(operator_).size(), 1u);
}

TEST_F(RestAccess, AKeyThatIsNotKnownProvesNothing) {
  const auto stranger = must(make_api_key("city", Role::Admin));
  const auto response = send_as(stranger, "GET", "/jobs");
  EXPECT_EQ(response.status, 401);
  EXPECT_THAT(response.headers.get("WWW-Authenticate"), HasSubstr("invalid_token"));
  EXPECT_THAT(text(response), Not(HasSubstr(stranger.key)));
  EXPECT_EQ(send_with({{"Authorization", "Basic eDp5"}}, "GET", "/jobs").status, 401);
  EXPECT_EQ(send_with({{"X-API-Key", city_.key}}, "GET", "/jobs").status, 200);
}

TEST_F(RestAccess, WritingBackIsARightOfItsOwn) {
  constexpr const char* kWriteBack = R"({"inputs": {"write_back": true}})";
  const auto refused = send_with({{"X-API-Key", city_.key}}, "POST", kExecution, kWriteBack);
  EXPECT_EQ(refused.status, 403);
  EXPECT_THAT(text(refused), HasSubstr("expected write-back"));
  EXPECT_EQ(send_with({{"X-API-Key", operator_.key}}, "POST", kExecution, kWriteBack).status, 201);
}

TEST_F(RestAccess, AJobOfAnotherClientDoesNotExist) {
  const auto id = submit_as(city_);
  service_.succeed(service_.start(), JobService::export_files());
  const auto unknown = "/jobs/" + new_job_id();
  for (const auto* rest : {"", "/events", "/results", "/results/obj", "/results/nothing"}) {
    EXPECT_NE(send_as(city_, "GET", "/jobs/" + id + rest).status, 403) << rest;
    const auto foreign = send_as(port_, "GET", "/jobs/" + id + rest);
    EXPECT_EQ(foreign.status, 404) << rest;
    auto seen = document(foreign);
    auto missing = document(send_as(port_, "GET", unknown + rest));
    EXPECT_EQ(seen["type"], missing["type"]);
    EXPECT_EQ(seen["title"], missing["title"]);
    EXPECT_EQ(seen["detail"].get<std::string>().size(),
              missing["detail"].get<std::string>().size());
  }
  EXPECT_EQ(send_as(port_, "DELETE", "/jobs/" + id).status, 404);
  EXPECT_EQ(send_as(city_, "GET", "/jobs/" + id + "/results/obj").status, 200);
  EXPECT_EQ(send_as(operator_, "GET", "/jobs/" + id + "/results/obj").status, 200);
}

TEST_F(RestAccess, TheJobListIsThatOfTheClient) {
  const auto of_city = submit_as(city_);
  const auto of_port = submit_as(port_);
  EXPECT_THAT(listed_for(city_), ElementsAre(of_city));
  EXPECT_THAT(listed_for(reader_of_city_), ElementsAre(of_city));
  EXPECT_THAT(listed_for(port_), ElementsAre(of_port));
  EXPECT_THAT(listed_for(operator_), ElementsAre(of_port, of_city));
  const auto page = send_with({{"Authorization", "Bearer " + city_.key}, {"Accept", "text/html"}},
                              "GET", "/jobs");
  EXPECT_THAT(text(page), AllOf(HasSubstr(of_city), Not(HasSubstr(of_port))));
}

TEST_F(RestAccess, WhoOnlyReadsNeitherSubmitsNorDismisses) {
  const auto id = submit_as(city_);
  for (const auto& refused : {send_as(reader_of_city_, "POST", kExecution, kBox),
                              send_as(reader_of_city_, "DELETE", "/jobs/" + id)}) {
    EXPECT_EQ(refused.status, 403);
    EXPECT_THAT(text(refused), AllOf(HasSubstr("read-own"), HasSubstr("submit")));
  }
  EXPECT_EQ(send_as(reader_of_city_, "GET", "/jobs/" + id).status, 200);
  EXPECT_EQ(send_as(reader_of_city_, "GET", "/metrics").status, 200);
}

TEST_F(RestAccess, AnAdminDismissesWhatOthersSubmitted) {
  const auto id = submit_as(city_);
  EXPECT_EQ(send_as(operator_, "DELETE", "/jobs/" + id).status, 200);
  EXPECT_EQ(document(send_as(city_, "GET", "/jobs/" + id))["status"], "dismissed");
}

TEST_F(RestAccess, TheSameIdempotencyKeyOfTwoClientsMakesTwoJobs) {
  const auto id = [&](const NewApiKey& key) {
    return document(send_with({{"X-API-Key", key.key}, {"Idempotency-Key", "1"}}, "POST",
                              kExecution, kBox))["jobID"]
        .get<std::string>();
  };
  const auto first = id(city_);
  EXPECT_EQ(id(city_), first);
  EXPECT_NE(id(port_), first);
}

TEST_F(RestAccess, TheDescriptionNamesTheWaysToShowWhoOneIs) {
  const auto description = document(send_with({}, "GET", "/api"));
  EXPECT_EQ(description["components"]["securitySchemes"]["bearer"]["scheme"], "bearer");
  EXPECT_EQ(description["components"]["securitySchemes"]["apiKey"]["name"], "X-API-Key");
  EXPECT_EQ(description["security"].size(), 2u);
  const auto& paths = description["paths"];
  for (const auto* open : {"/", "/processes", "/processes/{processID}", "/healthz"})
    EXPECT_EQ(paths[open]["get"]["security"], json::array()) << open;
  EXPECT_FALSE(paths["/jobs"]["get"].contains("security"));
  EXPECT_FALSE(paths["/jobs/{jobID}/results/{output}"]["get"].contains("security"));
  EXPECT_FALSE(paths["/processes/heal/execution"]["post"].contains("security"));
  EXPECT_FALSE(document(get("/api"))["components"].contains("securitySchemes"));
}

TEST_F(RestAccess, WithoutAuthenticationJobsAreCountedByAddressAndSeenByAll) {
  Request request{"POST", kExecution, {}, kBox};
  request.headers.set("Host", "citymesh.test");
  request.peer = "203.0.113.9";
  const auto id = document(RestApi::api_.handle(request))["jobID"].get<std::string>();
  EXPECT_EQ(must(service_.jobs().get(id)).owner, "address:203.0.113.9");
  EXPECT_EQ(get("/jobs/" + id).status, 200);
}

}  // namespace
}  // namespace citymesh
