#include "services/jobs/job_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <thread>

#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr TimeMs kLongWait = 60'000;

class JobManagerTest : public testing::Test {
 protected:
  JobManagerTest()
      : store_(*EmbeddedStore::open(folder_ / "jobs.sqlite")),
        results_(*FolderResultStore::open(folder_ / "results")) {}

  Job submitted(const std::string& inputs = "{}") {
    auto job = jobs_.submit({.process = "export-for-simulation", .inputs_json = inputs});
    EXPECT_TRUE(job) << job.error().message;
    return job ? *job : Job{};
  }

  Claim started() {
    const auto claim = store_->claim("worker", kLongWait, 0);
    EXPECT_TRUE(claim && *claim);
    EXPECT_TRUE(store_->update((*claim)->job_id, (*claim)->attempt,
                               [](Job& job) { job.state = JobState::Running; }));
    return **claim;
  }

  void finished(const Claim& claim, JobState state) {
    EXPECT_TRUE(store_->update(claim.job_id, claim.attempt, [state](Job& job) {
      job.state = state;
      job.message = "as told";
      if (state == JobState::Successful) job.results = {{"obj", "model.obj", "model/obj", 4}};
    }));
    EXPECT_TRUE(store_->done(claim));
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_;
  std::unique_ptr<FolderResultStore> results_;
  JobManager jobs_{*store_, *store_, *results_, {.max_open_jobs = 3, .dismiss_wait_ms = 50}};
};

TEST_F(JobManagerTest, WhatTheServiceDoesNotTakeIsRefusedBeforeThereIsAJob) {
  JobManager jobs(*store_, *store_, *results_,
                  {.check_inputs = [](const Inputs& inputs) -> Result<void> {
                    EXPECT_EQ(inputs.query.object_ids, std::vector<std::string>{"a"});
                    return fail(ErrorCode::InvalidArgument, "the box is too large");
                  }});
  const auto refused =
      jobs.submit({.process = "validate", .inputs_json = R"({"object_ids":["a"]})"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "the box is too large");
  EXPECT_EQ(*jobs.count({}), 0u);
}

TEST_F(JobManagerTest, AnEstimateMakesNoJob) {
  JobManager jobs(*store_, *store_, *results_,
                  {.estimate = [](const std::string& process, const std::string&) {
                    Estimate expected;
                    expected.process = process;
                    expected.buildings = 12;
                    return Result<Estimate>(expected);
                  }});
  for (const auto* inputs : {R"({"mode":"estimate"})", "{}"}) {
    const auto asked = jobs.check({.process = "heal", .inputs_json = inputs});
    ASSERT_TRUE(asked) << asked.error().message;
    EXPECT_EQ(asked->only_estimate, std::string_view(inputs).size() > 2);
    const auto expected = jobs.estimate(*asked);
    ASSERT_TRUE(expected) << expected.error().message;
    EXPECT_EQ(expected->buildings, 12u);
  }
  const auto job = jobs.submit({.process = "heal", .inputs_json = R"({"mode":"estimate"})"});
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(jobs.check({.process = "heal", .inputs_json = R"({"mode":7})"}).error().code,
            ErrorCode::InvalidArgument);
  EXPECT_EQ(jobs.check({.process = "fly"}).error().code, ErrorCode::NotFound);
  EXPECT_EQ(jobs.estimate(*jobs.check({.process = "echo"})).error().code, ErrorCode::Unimplemented);
  EXPECT_EQ(jobs_.estimate(*jobs_.check({.process = "heal"})).error().code,
            ErrorCode::Unimplemented);
  EXPECT_EQ(*jobs.count({}), 0u);
}

TEST(JobId, IsARandomUuidOfVersionFour) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = new_job_id();
    EXPECT_THAT(id, ::testing::MatchesRegex(
                        "[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
    ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1000u);
}

TEST(JobStates, HaveTheNamesOfOgc) {
  for (const auto* name : {"accepted", "running", "successful", "failed", "dismissed"})
    EXPECT_EQ(to_string(*job_state_from(name)), name);
  EXPECT_FALSE(job_state_from("done"));
}

TEST_F(JobManagerTest, ASubmittedJobIsStoredQueuedAndComplete) {
  const auto job = submitted();
  EXPECT_EQ(job.state, JobState::Accepted);
  const auto stored = jobs_.get(job.id);
  ASSERT_TRUE(stored);
  EXPECT_THAT(stored->spec.inputs_json, HasSubstr(R"("formats":["obj"])"));
  EXPECT_THAT(stored->spec.inputs_json, HasSubstr("snap_tolerance_m"));
  EXPECT_EQ(started().job_id, job.id);
}

TEST_F(JobManagerTest, SaysWhatIsWrongWithARequest) {
  const auto unknown = jobs_.submit({.process = "fly"});
  EXPECT_EQ(unknown.error().code, ErrorCode::NotFound);
  EXPECT_THAT(unknown.error().message, AllOf(HasSubstr("fly"), HasSubstr("export-for-simulation")));

  for (const auto* inputs :
       {"", "[]", "{", R"({"snap_tolerance_m":"wide"})", R"({"formats":["docx"]})",
        R"({"no_such_input":1})", R"({"bbox":{"bbox":[1,2,3]}})"}) {
    const auto job = jobs_.submit({.process = "export-for-simulation", .inputs_json = inputs});
    if (*inputs == 0) {
      EXPECT_TRUE(job);  // nothing said: the defaults
      continue;
    }
    ASSERT_FALSE(job) << inputs;
    EXPECT_EQ(job.error().code, ErrorCode::InvalidArgument) << inputs;
  }
  const auto outputs = jobs_.submit({.process = "export-for-simulation",
                                     .inputs_json = "{}",
                                     .outputs = {{"video", Transmission::Value}}});
  EXPECT_EQ(outputs.error().code, ErrorCode::InvalidArgument);
  EXPECT_THAT(outputs.error().message, AllOf(HasSubstr("video"), HasSubstr("obj")));
  EXPECT_EQ(*jobs_.count({}), 1u);
}

TEST_F(JobManagerTest, RequestedOutputsThatAreFormatsAreWritten) {
  const std::map<std::string, Transmission> outputs{{"stl", Transmission::Reference},
                                                    {"report", Transmission::Value}};
  const auto alone = jobs_.submit({"export-for-simulation", "{}", outputs});
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_THAT(alone->spec.inputs_json, HasSubstr(R"("formats":["stl"])"));
  const auto beside = jobs_.submit({"export-for-simulation", R"({"formats":["obj"]})", outputs});
  ASSERT_TRUE(beside);
  EXPECT_THAT(beside->spec.inputs_json, HasSubstr(R"("formats":["obj","stl"])"));
}

TEST_F(JobManagerTest, RefusesMoreOpenJobsThanTheLimit) {
  for (int i = 0; i < 3; ++i) submitted();
  const auto refused = jobs_.submit({.process = "export-for-simulation"});
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  finished(started(), JobState::Failed);
  submitted();
}

TEST_F(JobManagerTest, AnOwnerHasRoomOfItsOwnAndNobodysJobsTakeNone) {
  JobManager jobs(*store_, *store_, *results_, {.max_open_jobs = 10, .max_open_jobs_per_owner = 2});
  const JobSpec spec{.process = "export-for-simulation"};
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(jobs.submit(spec, {}, "city"));
  const auto refused = jobs.submit(spec, {}, "city");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(refused.error().message, HasSubstr("2 of your jobs"));
  EXPECT_TRUE(jobs.submit(spec, {}, "port"));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(jobs.submit(spec));
  finished(started(), JobState::Failed);
  EXPECT_TRUE(jobs.submit(spec, {}, "city"));
}

TEST_F(JobManagerTest, TheKeyOfARepeatedRequestCountsForItsOwnerOnly) {
  const JobSpec spec{.process = "export-for-simulation"};
  const auto first = jobs_.submit(spec, "key", "city");
  ASSERT_TRUE(first);
  EXPECT_EQ(first->owner, "city");
  EXPECT_EQ(jobs_.submit(spec, "key", "city")->id, first->id);
  EXPECT_NE(jobs_.submit(spec, "key", "port")->id, first->id);
}

TEST_F(JobManagerTest, AQueuedJobIsDismissedAtOnceAndNeverRuns) {
  const auto job = submitted();
  const auto dismissed = jobs_.dismiss(job.id);
  ASSERT_TRUE(dismissed);
  EXPECT_EQ(dismissed->state, JobState::Dismissed);
  EXPECT_FALSE(*store_->claim("worker", kLongWait, 0));
}

TEST_F(JobManagerTest, ARunningJobIsAskedToStopAndItsEndAwaited) {
  const auto job = submitted();
  const auto claim = started();
  const auto slow = jobs_.dismiss(job.id);  // nobody reacts within the wait
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->state, JobState::Running);
  EXPECT_TRUE(slow->dismiss_requested);

  JobManager patient(*store_, *store_, *results_, {.dismiss_wait_ms = kLongWait});
  const auto worker = store_->changes().subscribe([](const Job&) {});
  const std::jthread reacts([&] { finished(claim, JobState::Dismissed); });
  EXPECT_EQ(patient.dismiss(job.id)->state, JobState::Dismissed);
}

TEST_F(JobManagerTest, AFinalJobStaysAsItIs) {
  const auto job = submitted();
  finished(started(), JobState::Failed);
  const auto dismissed = jobs_.dismiss(job.id);
  ASSERT_TRUE(dismissed);
  EXPECT_EQ(dismissed->state, JobState::Failed);
  EXPECT_EQ(jobs_.dismiss("none").error().code, ErrorCode::NotFound);
}

TEST_F(JobManagerTest, ResultsBelongToSuccessfulJobsOnly) {
  const auto job = submitted();
  EXPECT_THAT(jobs_.results(job.id).error().message, HasSubstr("not ready"));
  const auto claim = started();
  EXPECT_EQ(jobs_.results(job.id).error().code, ErrorCode::FailedPrecondition);

  const auto folder = results_->stage(job.id, claim.attempt);
  ASSERT_TRUE(folder);
  std::ofstream(*folder / "model.obj") << "mesh";
  std::ofstream(*folder / "unlisted") << "x";
  ASSERT_TRUE(results_->commit(job.id, claim.attempt));
  finished(claim, JobState::Successful);
  ASSERT_TRUE(jobs_.results(job.id));
  EXPECT_EQ(*jobs_.read_result(job.id, "model.obj", 0, 100), "mesh");
  for (const auto* name : {"unlisted", "../model.obj", "obj", ""})
    EXPECT_EQ(jobs_.read_result(job.id, name, 0, 100).error().code, ErrorCode::NotFound) << name;
}

TEST_F(JobManagerTest, WaitingEndsWithTheChange) {
  const auto job = submitted();
  const auto claim = *store_->claim("worker", kLongWait, 0);
  const auto before = jobs_.get(job.id)->updated;
  const std::jthread change(
      [&] { EXPECT_TRUE(store_->update(job.id, claim->attempt, [](Job& j) { j.percent = 7; })); });
  const auto changed = jobs_.wait_for_change(job.id, before, kLongWait);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->percent, 7);
}

TEST_F(JobManagerTest, WaitingSeesChangesOfAnotherProcess) {
  const auto job = submitted();
  const auto other = *EmbeddedStore::open(folder_ / "jobs.sqlite");  // shares no feed with ours
  const std::jthread change(
      [&] { EXPECT_TRUE(other->update(job.id, {}, [](Job& j) { j.percent = 7; })); });
  const auto changed = jobs_.wait_for_change(job.id, job.updated, kLongWait);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->percent, 7);
}

TEST_F(JobManagerTest, WaitingForAFinalJobOrWithoutTimeReturnsAtOnce) {
  const auto job = submitted();
  EXPECT_TRUE(jobs_.wait_for_change(job.id, job.updated, 0));
  EXPECT_TRUE(jobs_.wait_for_change(job.id, job.updated, -5));
  ASSERT_TRUE(jobs_.dismiss(job.id));
  const auto final_update = jobs_.get(job.id)->updated;
  EXPECT_EQ(jobs_.wait_for_change(job.id, final_update, kLongWait)->state, JobState::Dismissed);
  EXPECT_EQ(jobs_.wait_for_change("none", 0, kLongWait).error().code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace citymesh
