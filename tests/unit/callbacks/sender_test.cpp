#include "services/callbacks/sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <thread>

#include "services/callbacks/signature.h"
#include "services/stores/embedded_store.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "tests/support/http_receiver.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kSecret = "0123456789abcdef0123456789abcdef";

class Callbacks : public testing::Test {
 protected:
  void start() { start(options_); }
  void start(SenderOptions options) {
    sender_.reset();
    sender_ = std::make_unique<CallbackSender>(
        *store_,
        [](const Job& job) { return "{\"state\":\"" + std::string(to_string(job.state)) + "\"}"; },
        log_, metrics_, std::move(options));
    sender_->start();
  }
  std::string stopped_log() {
    sender_.reset();
    return lines_.str();
  }
  /// A running job that tells the receiver everything.
  Job running() {
    Job job;
    job.id = new_job_id();
    job.spec.process = "heal";
    job.spec.inputs_json = "{}";
    job.spec.subscriber = {receiver_.url("/done"), receiver_.url("/progress"),
                           receiver_.url("/failed"), "http://base"};
    job.created = job.updated = now_ms();
    EXPECT_TRUE(store_->insert(job));
    return *store_->update(job.id, {}, [](Job& j) { j.state = JobState::Running; });
  }
  void end(const Job& job, JobState state) {
    EXPECT_TRUE(store_->update(job.id, {}, [state](Job& j) {
      j.state = state;
      j.finished = now_ms();
    }));
  }
  /// The next request that is not about progress.
  std::string told() {
    for (;;) {
      auto request = receiver_.next();
      EXPECT_TRUE(request);
      if (!request || !request->starts_with("POST /progress")) return request.value_or("");
    }
  }
  /// Whether an attempt with that outcome is counted in the end.
  bool is_counted(const std::string& outcome) {
    const auto none = "citymesh_callbacks_total{outcome=\"" + outcome + "\"} 0\n";
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (metrics_.text().find(none) != std::string::npos) {
      if (std::chrono::steady_clock::now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  bool is_anything_due() {
    const auto due = store_->take_callback(now_ms() + 86'400'000,
                                           [](std::uint32_t) { return std::optional<TimeMs>(0); });
    return !due || due->has_value();
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_ = *EmbeddedStore::open(folder_ / "jobs.sqlite");
  std::ostringstream lines_;
  Log log_{lines_};
  Metrics metrics_;
  HttpReceiver receiver_;
  SenderOptions options_{.post = {.allow_private = true, .timeout_s = 5},
                         .secret = kSecret,
                         .threads = 2,
                         .first_retry_ms = 20'000,
                         .progress_interval_ms = 0,
                         .poll_ms = 5};
  std::unique_ptr<CallbackSender> sender_;
};

TEST_F(Callbacks, TellThatAJobWasSuccessfulSignedAndOnce) {
  start();
  const auto job = running();
  end(job, JobState::Successful);
  const auto request = told();
  EXPECT_THAT(request, StartsWith("POST /done HTTP/1.1\r\n"));
  EXPECT_EQ(HttpReceiver::body(request), "{\"state\":\"successful\"}");
  EXPECT_EQ(HttpReceiver::header(request, "Content-Type"), "application/json");
  EXPECT_EQ(HttpReceiver::header(request, "Idempotency-Key"), "\"" + job.id + "-successful\"");
  const auto signed_by = HttpReceiver::header(request, "Citymesh-Signature");
  ASSERT_THAT(signed_by, StartsWith("t="));
  const auto seconds = std::stoll(signed_by.substr(2));
  EXPECT_EQ(signed_by, signature(kSecret, seconds, HttpReceiver::body(request)));
  EXPECT_TRUE(is_counted("delivered"));
}

TEST_F(Callbacks, TellOfFailureAndDismissalUnderTheirAddress) {
  start();
  for (const auto state : {JobState::Failed, JobState::Dismissed}) {
    end(running(), state);
    EXPECT_THAT(told(), StartsWith("POST /failed"));
  }
}

TEST_F(Callbacks, TellHowARunningJobGetsOn) {
  start();
  const auto job = running();
  const auto request = receiver_.next();
  ASSERT_TRUE(request);
  EXPECT_THAT(*request, StartsWith("POST /progress"));
  EXPECT_EQ(HttpReceiver::body(*request), "{\"state\":\"running\"}");
}

TEST_F(Callbacks, AreTriedAgainUntilTheyAreReceived) {
  for (const auto* trouble : {"500 No", "404 No", "301 Moved\r\nLocation: /elsewhere"})
    receiver_.answer(trouble);
  const auto job = running();
  end(job, JobState::Successful);
  auto options = options_;
  options.first_retry_ms = options.longest_retry_ms = 1'000;  // longer than an attempt takes
  start(options);
  for (int attempt = 1; attempt <= 4; ++attempt)
    EXPECT_THAT(told(), StartsWith("POST /done"));  // and never /elsewhere
}

TEST_F(Callbacks, AreGivenUpAfterTheLastAttempt) {
  for (int i = 0; i < 5; ++i) receiver_.answer("503 No");
  end(running(), JobState::Successful);
  auto options = options_;
  options.max_attempts = 2;
  options.first_retry_ms = 100;
  start(options);
  for (int attempt = 1; attempt <= 2; ++attempt) EXPECT_THAT(told(), StartsWith("POST /done"));
  EXPECT_TRUE(is_counted("retried"));
  EXPECT_TRUE(is_counted("given_up"));
  EXPECT_FALSE(is_anything_due());
  EXPECT_TRUE(receiver_.is_quiet());
}

TEST_F(Callbacks, SurviveARestart) {
  end(running(), JobState::Successful);  // nobody is there to tell it
  store_.reset();
  store_ = *EmbeddedStore::open(folder_ / "jobs.sqlite");
  start();
  EXPECT_THAT(told(), StartsWith("POST /done"));
}

TEST_F(Callbacks, OfAnOpenJobOrWithoutAnAddressAreNotMade) {
  running();
  EXPECT_FALSE(is_anything_due());
  Job plain;
  plain.id = new_job_id();
  plain.spec.process = "heal";
  ASSERT_TRUE(store_->insert(plain));
  end(plain, JobState::Successful);
  EXPECT_FALSE(is_anything_due());
}

TEST_F(Callbacks, ThatWereReceivedAreNotDueAgain) {
  const auto job = running();
  end(job, JobState::Successful);
  EXPECT_TRUE(is_anything_due());
  ASSERT_TRUE(store_->callback_done(job.id));
  EXPECT_FALSE(is_anything_due());
}

TEST_F(Callbacks, CountTheirAttemptsAndWaitAsTheyAreTold) {
  const auto job = running();
  end(job, JobState::Failed);
  const auto wait = [](std::uint32_t) { return std::optional<TimeMs>(1'000); };
  const auto first = store_->take_callback(5'000, wait);
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->job.id, job.id);
  EXPECT_EQ((*first)->job.spec.subscriber.base, "http://base");
  EXPECT_EQ((*first)->attempt, 1U);
  EXPECT_FALSE(store_->take_callback(5'999, wait)->has_value());
  EXPECT_EQ((*store_->take_callback(6'000, wait))->attempt, 2U);
}

TEST_F(Callbacks, NeverReachAnAddressWithin) {
  Message message{.uri = receiver_.url("/"), .body = "{}", .headers = {}};
  ASSERT_TRUE(post(message, {.allow_private = true}, {}));
  ASSERT_TRUE(receiver_.next());
  ASSERT_FALSE(post(message, {}, {}));
  // A name is judged when it is connected to: this one is the machine's own.
  char name[256] = {};
  ASSERT_EQ(::gethostname(name, sizeof name - 1), 0);
  message.uri = receiver_.url("/", name);
  const auto posted = post(message, {}, {});
  ASSERT_FALSE(posted);
  EXPECT_THAT(posted.error().code,
              testing::AnyOf(ErrorCode::PermissionDenied, ErrorCode::Unavailable,
                             ErrorCode::DeadlineExceeded));
  EXPECT_TRUE(receiver_.is_quiet());
}

TEST_F(Callbacks, SayInTheLogWhyTheyFailedWithoutSecrets) {
  receiver_.answer("401 No");
  end(running(), JobState::Failed);
  start();
  told();
  const auto log = stopped_log();
  EXPECT_THAT(log, HasSubstr("callback_failed"));
  EXPECT_THAT(log, Not(HasSubstr("/failed")));
  EXPECT_THAT(log, Not(HasSubstr(kSecret)));
}

TEST_F(Callbacks, AreGivenUpWhenStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto posted = post({.uri = receiver_.url("/"), .body = "{}", .headers = {}},
                           {.allow_private = true, .timeout_s = 3600}, stop.get_token());
  ASSERT_FALSE(posted);
  EXPECT_EQ(posted.error().code, ErrorCode::Cancelled);
}

TEST(CallbackRetries, WaitLongerEachTimeAndEnd) {
  const SenderOptions options;
  EXPECT_EQ(retry_after(1, options), 10'000);
  EXPECT_EQ(retry_after(2, options), 40'000);
  EXPECT_EQ(retry_after(5, options), 2'560'000);
  EXPECT_EQ(retry_after(6, options), 3'600'000);
  EXPECT_EQ(retry_after(7, options), 3'600'000);
  EXPECT_EQ(retry_after(8, options), std::nullopt);
}

}  // namespace
}  // namespace citymesh
