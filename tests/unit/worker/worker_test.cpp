#include "services/worker/worker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <thread>

#include "tests/unit/worker/worker_fixture.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

TEST_F(WorkerTest, RunsAJobAndListsItsFiles) {
  work_on([](const RunContext&) -> Result<void> { return {}; });
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Successful) << job.message;
  EXPECT_EQ(job.message, "no building selected");
  EXPECT_EQ(job.percent, 100);
  EXPECT_TRUE(job.started && job.finished);
  std::vector<std::string> names;
  for (const auto& file : job.results) {
    names.push_back(file.file_name);
    EXPECT_EQ(jobs_.read_result(job.id, file.file_name, 0, 1 << 20)->size(), file.bytes);
  }
  EXPECT_THAT(names, testing::IsSupersetOf(
                         {"model.obj", "report.json", "report.html", "picture.svg", "run.json"}));
  pool_->stop();
  EXPECT_THAT(lines_.str(), HasSubstr(R"("event":"job_started","job_id":")" + job.id));
  EXPECT_THAT(metrics_.text(), HasSubstr(R"(state="successful")"));
}

TEST_F(WorkerTest, RunsManyJobsOnSeveralThreadsOnceEach) {
  std::atomic<int> runs = 0;
  work_on([&runs](const RunContext&) -> Result<void> { return ++runs, Result<void>{}; },
          {.workers = 4});
  std::vector<std::string> ids;
  for (int i = 0; i < 20; ++i) ids.push_back(submitted());
  for (const auto& id : ids) EXPECT_EQ(ended(id).attempt, 1u);
  EXPECT_EQ(runs, 20);
}

TEST_F(WorkerTest, AnErrorOfTheRunFailsTheJobWithItsReason) {
  work_on([](const RunContext&) -> Result<void> {
    return fail(ErrorCode::Unavailable, "cannot write 'model.obj': No space left on device");
  });
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Failed);
  ASSERT_TRUE(job.error);
  EXPECT_EQ(job.error->code, ErrorCode::Unavailable);
  EXPECT_THAT(job.message, HasSubstr("No space left"));
  EXPECT_FALSE(has_files(job.id));
}

TEST_F(WorkerTest, ASourceThatCannotBeOpenedFailsTheJob) {
  work_with([]() -> Result<std::unique_ptr<CitySource>> {
    return fail(ErrorCode::NotFound, "data folder is gone");
  });
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_EQ(job.message, "data folder is gone");
}

TEST_F(WorkerTest, WhateverIsThrownFailsTheJobAndTheNextOneRuns) {
  std::atomic<int> run = 0;
  work_on([&run](const RunContext&) -> Result<void> {
    switch (run++) {
      case 0:
        throw std::bad_alloc();
      case 1:
        throw std::runtime_error("surprise");
      case 2:
        throw 42;
      default:
        return {};
    }
  });
  const auto first = ended(submitted());
  EXPECT_EQ(first.error->code, ErrorCode::ResourceExhausted);
  const auto second = ended(submitted());
  EXPECT_THAT(second.message, HasSubstr("surprise"));
  EXPECT_EQ(ended(submitted()).state, JobState::Failed);
  EXPECT_EQ(ended(submitted()).state, JobState::Successful);
}

TEST_F(WorkerTest, ADismissedJobStopsAndLeavesNoFiles) {
  work_on(until_stopped);
  const auto id = submitted();
  running(id);
  const auto job = jobs_.dismiss(id);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->state, JobState::Dismissed);
  EXPECT_FALSE(has_files(id));
  EXPECT_EQ(jobs_.results(id).error().code, ErrorCode::FailedPrecondition);
}

TEST_F(WorkerTest, ADismissalByAnotherProcessStopsTheJob) {
  work_on(until_stopped);
  const auto id = submitted();
  running(id);
  const auto other = *EmbeddedStore::open(folder_ / "jobs.sqlite");  // shares no feed with ours
  ASSERT_TRUE(other->update(id, {}, [](Job& job) { job.dismiss_requested = true; }));
  EXPECT_EQ(ended(id).state, JobState::Dismissed);
}

TEST_F(WorkerTest, AJobThatFinishesDespiteItsDismissalIsDismissed) {
  work_on([](const RunContext& context) -> Result<void> {
    while (!context.stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return {};
  });
  const auto id = submitted();
  running(id);
  EXPECT_EQ(jobs_.dismiss(id)->state, JobState::Dismissed);
  EXPECT_FALSE(has_files(id));
}

TEST_F(WorkerTest, AJobBeyondItsTimeLimitIsFailed) {
  work_on(until_stopped, {.job_timeout_ms = 50});
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_EQ(job.error->code, ErrorCode::DeadlineExceeded);
}

TEST_F(WorkerTest, AJobWhoseResultsAreTooLargeIsFailedAndLeavesNoFiles) {
  work_on([](const RunContext&) -> Result<void> { return {}; }, {.max_job_bytes = 100});
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Failed);
  ASSERT_TRUE(job.error);
  EXPECT_EQ(job.error->code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(job.error->message, HasSubstr("at most 100 may be of one job"));
  EXPECT_FALSE(has_files(job.id));
}

TEST_F(WorkerTest, ShutdownHandsTheJobBackAndTheNextPoolFinishesIt) {
  work_on(until_stopped);
  const auto id = submitted();
  running(id);
  pool_->stop();
  const auto queued = jobs_.get(id);
  ASSERT_TRUE(queued);
  EXPECT_EQ(queued->state, JobState::Accepted);
  EXPECT_FALSE(has_files(id));

  work_on([](const RunContext&) -> Result<void> { return {}; });
  const auto job = ended(id);
  EXPECT_EQ(job.state, JobState::Successful);
  EXPECT_EQ(job.attempt, 2u);
}

TEST_F(WorkerTest, HeartbeatsKeepALongJobOfAShortLease) {
  work_on(
      [](const RunContext&) -> Result<void> {
        std::this_thread::sleep_for(std::chrono::seconds(4));
        return {};
      },
      {.workers = 2, .lease_ms = 2500});
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Successful);
  EXPECT_EQ(job.attempt, 1u);
}

TEST_F(WorkerTest, AWorkerThatLostItsLeaseChangesNothing) {
  std::atomic<bool> go = false;
  work_on([&go](const RunContext&) -> Result<void> {
    while (!go) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return {};
  });
  const auto id = submitted();
  running(id);
  // Another worker takes the job over, as after a lease that ran out.
  const auto other = *EmbeddedStore::open(folder_ / "jobs.sqlite");
  ASSERT_TRUE(other->recover());
  const auto claim = other->claim("successor", kLongWait, 0);
  ASSERT_TRUE(claim && *claim);
  ASSERT_TRUE(other->update(id, (*claim)->attempt, [](Job& job) {
    job.state = JobState::Running;
    job.message = "of the successor";
  }));
  go = true;
  pool_->stop();
  const auto job = jobs_.get(id);
  EXPECT_EQ(job->state, JobState::Running);
  EXPECT_EQ(job->message, "of the successor");
  EXPECT_EQ(job->attempt, 2u);
}

TEST_F(WorkerTest, ProgressReachesTheStore) {
  std::atomic<bool> go = false;
  work_on(
      [&go](const RunContext& context) -> Result<void> {
        while (!go) {
          context.report({"source", 30, 120});
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return {};
      },
      {.progress_interval_ms = 1});
  const auto id = submitted();
  const auto job = awaited(id, [](const Job& now) { return now.progress.total == 120; });
  EXPECT_EQ(job.message, "source: 30 of 120 buildings");
  EXPECT_EQ(job.percent, 25);
  go = true;
  EXPECT_EQ(ended(id).state, JobState::Successful);
}

}  // namespace
}  // namespace citymesh
