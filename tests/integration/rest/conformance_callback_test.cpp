// Conformance class callback: the subscriber of a job hears how it goes on and what came out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/callbacks/sender.h"
#include "services/rest/results.h"
#include "tests/integration/rest/live_service.h"
#include "tests/support/http_receiver.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class ConformanceCallback : public LiveService {
 protected:
  ConformanceCallback()
      : sender_(*store_, callback_json, log_, metrics_,
                {.post = {.allow_private = true}, .progress_interval_ms = 0, .poll_ms = 5}) {
    sender_.start();
  }
  json request(const json& inputs) {
    return {{"inputs", inputs},
            {"subscriber",
             {{"successUri", receiver_.url("/success")},
              {"inProgressUri", receiver_.url("/progress")},
              {"failedUri", receiver_.url("/failed")}}}};
  }
  std::string next(std::string_view path) {
    for (;;) {
      auto heard = receiver_.next();
      EXPECT_TRUE(heard) << path;
      if (!heard || heard->starts_with(fmt::format("POST {} ", path))) return heard.value_or("");
    }
  }

  HttpReceiver receiver_;
  CallbackSender sender_;
};

TEST_F(ConformanceCallback, SuccessIsToldWithTheResults) {
  const auto job = execute(request({{"text", "teststring"}}), "respond-async");
  ASSERT_EQ(job.status, 201) << job.body;
  const auto results = json::parse(HttpReceiver::body(next("/success")));
  EXPECT_EQ(get(results["text"]["href"].get<std::string>(), "").body, "teststring");
  EXPECT_THAT(results["text"]["href"].get<std::string>(),
              StartsWith(job.headers.at("location") + "/results/"));
}

TEST_F(ConformanceCallback, ProgressAndDismissalAreToldWithTheStatus) {
  const auto job = execute(request({{"text", "a"}, {"pause", 60}}), "respond-async");
  const auto progress = json::parse(HttpReceiver::body(next("/progress")));
  expect_status_info(progress);
  EXPECT_EQ(progress["status"], "running");
  EXPECT_EQ(send("DELETE", job.headers.at("location")).status, 200);
  const auto end = json::parse(HttpReceiver::body(next("/failed")));
  expect_status_info(end);
  EXPECT_EQ(end["status"], "dismissed");
}

TEST_F(ConformanceCallback, FailureIsToldWithItsReason) {
  auto wanted = request(json::object());
  EXPECT_EQ(send("POST", "/processes/validate/execution", wanted.dump(), "application/json",
                 "Prefer: respond-async\r\n")
                .status,
            201);
  const auto end = json::parse(HttpReceiver::body(next("/failed")));
  EXPECT_EQ(end["status"], "failed");
  EXPECT_EQ(end["exception"]["detail"], "this service has no cities");
}

TEST_F(ConformanceCallback, AddressesThatCannotBeUsedAreRefusedAtOnce) {
  for (const auto* subscriber :
       {R"("http://example.org/")", R"({})", R"({"successUri":1})", R"({"successUri":""})",
        R"({"successUri":"file:///etc/passwd"})", R"({"successUri":"http://a@example.org/"})",
        R"({"callUri":"http://example.org/"})"}) {
    json wanted = {{"inputs", {{"text", "a"}}}, {"subscriber", json::parse(subscriber)}};
    const auto answer = execute(wanted, "respond-async");
    EXPECT_EQ(answer.status, 400) << subscriber;
  }
}

}  // namespace
}  // namespace citymesh
