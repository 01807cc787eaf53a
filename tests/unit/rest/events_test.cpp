#include "services/rest/events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Job running(TimeMs updated, std::uint64_t done) {
  Job job;
  job.id = "j";
  job.state = JobState::Running;
  job.progress = {"heal", done, 100};
  job.updated = updated;
  return job;
}

json data_of(const std::string& event) {
  const auto begin = event.find("data: ") + 6;
  return json::parse(event.substr(begin, event.find('\n', begin) - begin));
}

TEST(JobEvents, TellStageCountsRateAndTimeToGo) {
  JobEvents events("");
  const auto first = events.next(running(1000, 20));
  EXPECT_THAT(first, StartsWith("id: 1000\nevent: status\ndata: {"));
  EXPECT_THAT(first, ::testing::EndsWith("}\n\n"));
  EXPECT_EQ(data_of(first)["stage"], "heal");
  EXPECT_EQ(data_of(first)["done"], 20);
  EXPECT_EQ(data_of(first)["total"], 100);
  EXPECT_FALSE(data_of(first).contains("eta_s")) << "one moment has no rate";

  const auto second = data_of(events.next(running(3000, 40)));
  EXPECT_EQ(second["rate_per_s"], 10.0);
  EXPECT_EQ(second["eta_s"], 6.0);
}

TEST(JobEvents, RateBeginsAnewWithEveryStage) {
  JobEvents events("");
  events.next(running(1000, 0));
  events.next(running(2000, 50));
  auto job = running(3000, 10);
  job.progress.stage = "write";
  EXPECT_FALSE(data_of(events.next(job)).contains("rate_per_s"));
  job.progress.done = 12;
  job.updated = 4000;
  EXPECT_EQ(data_of(events.next(job))["rate_per_s"], 2.0);
}

TEST(JobEvents, AreOnlyWhatIsNewerThanTheLastOneSeen) {
  JobEvents events("2000");
  EXPECT_EQ(events.next(running(2000, 1)), "");
  EXPECT_NE(events.next(running(2001, 1)), "");
  EXPECT_EQ(events.next(running(2001, 1)), "");
  for (const auto* unknown : {"", "x", "12x", "99999999999999999999999", "\n"})
    EXPECT_NE(JobEvents(unknown).next(running(1, 1)), "") << unknown;
}

TEST(JobEvents, StayOnOneLineWhateverTheMessageHolds) {
  auto job = running(1, 1);
  job.message = "a\nid: 7\n\ndata: \xff";
  const auto event = JobEvents("").next(job);
  EXPECT_EQ(std::ranges::count(event, '\n'), 4);
  EXPECT_THAT(data_of(event)["message"].get<std::string>(), StartsWith("a\nid: 7"));
}

using RestEvents = RestApi;

TEST_F(RestEvents, FollowAJobToItsEnd) {
  const auto id = submit();
  const auto response = get("/jobs/" + id + "/events");
  EXPECT_EQ(response.headers.get("Content-Type"), "text/event-stream");
  EXPECT_EQ(response.headers.get("Cache-Control"), "no-store");
  ASSERT_TRUE(response.follow && response.follow->streams);
  const auto& step = response.follow->step;

  EXPECT_EQ(data_of(step(false).bytes)["status"], "accepted");
  EXPECT_EQ(step(false).bytes, "") << "nothing has changed";
  const auto claim = service_.start();
  EXPECT_EQ(data_of(step(false).bytes)["stage"], "heal");
  service_.succeed(claim, JobService::export_files());
  const auto last = step(false);
  EXPECT_TRUE(last.end);
  EXPECT_EQ(data_of(last.bytes)["status"], "successful");
}

TEST_F(RestEvents, AClientThatHasSeenTheEndIsToldNotToComeBack) {
  const auto events = "/jobs/" + finished(kBox) + "/events";
  const auto bytes = get(events).follow->step(false).bytes;
  const auto begin = bytes.find("id: ") + 4;
  const auto id = bytes.substr(begin, bytes.find('\n', begin) - begin);
  EXPECT_EQ(get(events, {{"Last-Event-ID", id}}).status, 204);
  EXPECT_TRUE(get(events, {{"Last-Event-ID", "1"}}).follow);
}

TEST_F(RestEvents, OfNoJobAreAProblem) {
  for (const auto* id : {"x", "00000000-0000-4000-8000-000000000000", "..%2Fx"})
    EXPECT_EQ(problem(get(std::string("/jobs/") + id + "/events"), 404)["type"],
              kExceptions + "no-such-job");
}

}  // namespace
}  // namespace citymesh
