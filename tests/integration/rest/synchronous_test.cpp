#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr auto* kValidate = "/processes/validate/execution";

class RestSynchronously : public RestOverSocket {
 protected:
  /// The one job there is, once it has been submitted.
  std::string job() {
    return eventually([this] {
      const auto jobs = must(service_.jobs().list({}));
      return jobs.empty() ? std::string() : jobs[0].id;
    });
  }
  JobState state_after(const std::string& id, JobState before) {
    eventually([&] { return must(service_.jobs().get(id)).state == before ? "" : "changed"; });
    return must(service_.jobs().get(id)).state;
  }

  static std::vector<JobService::File> report() {
    return {{"report", "report.json", "application/json", R"({"valid":true})"}};
  }

 private:
  template <class Look>
  static std::string eventually(Look look) {
    for (int i = 0; i < 2000; ++i) {
      if (std::string seen = look(); !seen.empty()) return seen;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "it never happened";
    return {};
  }
};

TEST_F(RestSynchronously, TheAnswerComesWithTheResultsOnTheSameConnection) {
  start();
  Connection connection(port_);
  connection.send(request("POST", kValidate, "{}"));
  job();
  service_.succeed(service_.start(), report());
  const auto answer = connection.read();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body, R"({"valid":true})");
  EXPECT_EQ(answer->headers.at("connection"), "keep-alive");
  connection.send(request("GET", "/healthz"));
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(RestSynchronously, RequestsSentAheadWaitForTheirTurn) {
  start();
  Connection connection(port_);
  connection.send(request("POST", kValidate, "{}") + request("GET", "/healthz"));
  job();
  service_.succeed(service_.start(), report());
  EXPECT_EQ(connection.read()->body, R"({"valid":true})");
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(RestSynchronously, WaitingTakesNoThread) {
  start({.io_threads = 1, .handler_threads = 1});
  std::vector<std::unique_ptr<Connection>> waiting;
  for (int i = 0; i < 50; ++i) {
    waiting.push_back(std::make_unique<Connection>(port_));
    waiting.back()->send(request("POST", kValidate, "{}"));
  }
  while (must(service_.jobs().count({})) < waiting.size())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  expect_still_working();
  for (std::size_t i = 0; i < waiting.size(); ++i) service_.succeed(service_.start(), report());
  for (const auto& connection : waiting) {
    const auto answer = connection->read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
  }
}

TEST_F(RestSynchronously, AClientThatLeavesTakesItsJobWithIt) {
  start();
  Connection connection(port_);
  connection.send(request("POST", kValidate, "{}"));
  const auto id = job();
  connection.leave();
  EXPECT_EQ(state_after(id, JobState::Accepted), JobState::Dismissed);
  expect_still_working();
}

TEST_F(RestSynchronously, WhatTakesTooLongIsAnsweredWithItsJob) {
  start({.sync_wait_s = 0.1});
  const auto answer = send(request("POST", kValidate, "{}"));
  EXPECT_EQ(answer.status, 201);
  const auto id = json::parse(answer.body)["jobID"].get<std::string>();
  EXPECT_THAT(answer.headers.at("location"), HasSubstr("/jobs/" + id));
  service_.succeed(service_.start(), report());
  EXPECT_EQ(send(request("GET", "/jobs/" + id + "/results/report")).body, R"({"valid":true})");
}

TEST_F(RestSynchronously, StoppingTheServerAnswersWithTheJobWhichStays) {
  start();
  Connection connection(port_);
  connection.send(request("POST", kValidate, "{}"));
  const auto id = job();
  server_->stop();
  const auto answer = connection.read();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 201);
  EXPECT_EQ(must(service_.jobs().get(id)).state, JobState::Accepted);
}

TEST_F(RestSynchronously, AFailedJobIsAProblem) {
  start();
  Connection connection(port_);
  connection.send(request("POST", kValidate, "{}"));
  job();
  service_.fail_job(service_.start(), {ErrorCode::InvalidArgument, "the features have 2 CRSs"});
  const auto answer = connection.read();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 400);
  EXPECT_EQ(answer->headers.at("content-type"), "application/problem+json");
  EXPECT_THAT(answer->body, HasSubstr("the features have 2 CRSs"));
  expect_still_working();
}

}  // namespace
}  // namespace citymesh
