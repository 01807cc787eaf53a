#include "services/jobs/retention.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/jobs/job_manager.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

constexpr TimeMs kHour = 3'600'000;
constexpr TimeMs kNow = 100 * kHour;

class Retention : public testing::Test {
 protected:
  Retention()
      : store_(*EmbeddedStore::open(folder_ / "jobs.sqlite")),
        results_(*FolderResultStore::open(folder_ / "results")) {}

  /// A successful job that ended at `finished` and left `bytes`.
  std::string ended(TimeMs finished, std::size_t bytes, JobState state = JobState::Successful) {
    Job job;
    job.id = new_job_id();
    job.spec.process = "heal";
    job.spec.inputs_json = "{}";
    job.state = state;
    job.attempt = 1;
    job.created = job.updated = finished;
    job.finished = finished;
    if (state == JobState::Successful) {
      const auto staged = results_->stage(job.id, 1);
      EXPECT_TRUE(staged);
      std::ofstream(*staged / "model.obj") << std::string(bytes, 'v');
      EXPECT_TRUE(results_->commit(job.id, 1));
      job.results = {{"obj", "model.obj", "model/obj", bytes}};
    }
    EXPECT_TRUE(store_->insert(job));
    return job.id;
  }

  Swept swept(const RetentionOptions& options) {
    const auto done = sweep(*store_, *results_, options, kNow);
    EXPECT_TRUE(done) << done.error().message;
    return done ? *done : Swept{};
  }

  bool has_files(const std::string& id) { return results_->size(id, "model.obj").has_value(); }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_;
  std::unique_ptr<FolderResultStore> results_;
};

TEST_F(Retention, ResultsExpireAndTheRecordSaysSo) {
  const auto old = ended(kNow - 3 * kHour, 10), young = ended(kNow - kHour, 20);
  const auto done = swept({.keep_results_ms = 2 * kHour});
  EXPECT_EQ(done.results_expired, 1u);
  EXPECT_EQ(done.bytes_freed, 10u);
  EXPECT_FALSE(has_files(old));
  EXPECT_TRUE(has_files(young));
  EXPECT_TRUE(has_expired(*store_->get(old)));
  EXPECT_FALSE(has_expired(*store_->get(young)));

  JobManager jobs(*store_, *store_, *results_);
  const auto asked = jobs.results(old);
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, ErrorCode::NotFound);
  EXPECT_THAT(asked.error().message, HasSubstr("results have expired"));
  EXPECT_TRUE(jobs.results(young));
}

TEST_F(Retention, OpenJobsAndYoungRecordsStay) {
  const auto running = ended(kNow - 90 * kHour, 0, JobState::Running);
  const auto failed = ended(kNow - 90 * kHour, 0, JobState::Failed);
  const auto old = ended(kNow - 90 * kHour, 5), young = ended(kNow - kHour, 7);
  const auto done = swept({.keep_jobs_ms = 50 * kHour});
  EXPECT_EQ(done.jobs_forgotten, 2u);
  EXPECT_EQ(done.bytes_freed, 5u);
  EXPECT_TRUE(store_->get(running));
  EXPECT_FALSE(store_->get(failed));
  EXPECT_FALSE(store_->get(old));
  EXPECT_FALSE(has_files(old));
  EXPECT_TRUE(store_->get(young));
  EXPECT_TRUE(has_files(young));
}

TEST_F(Retention, AboveTheQuotaTheOldestResultsGoFirst) {
  std::vector<std::string> ids;
  for (int i = 0; i < 120; ++i) ids.push_back(ended(kNow - (300 - i) * 1000, 100));
  EXPECT_EQ(*store_->result_bytes(), 12'000u);
  const auto done = swept({.max_result_bytes = 1'950});
  EXPECT_EQ(done.results_expired, 101u);
  EXPECT_EQ(*store_->result_bytes(), 1'900u);
  EXPECT_FALSE(has_files(ids[100]));
  EXPECT_TRUE(has_files(ids[101]));
  EXPECT_EQ(swept({.max_result_bytes = 1'950}).results_expired, 0u);
}

TEST_F(Retention, NothingIsSweptByDefault) {
  const auto id = ended(1, 10);
  EXPECT_EQ(swept({}).bytes_freed, 0u);
  EXPECT_TRUE(has_files(id));
}

TEST_F(Retention, ASweepThatACrashCutShortIsFinishedByTheNext) {
  const auto id = ended(kNow - 3 * kHour, 10);
  std::filesystem::remove_all(folder_ / "results" / id);  // files gone, the record not yet changed
  EXPECT_EQ(swept({.keep_results_ms = kHour}).results_expired, 1u);
  EXPECT_TRUE(has_expired(*store_->get(id)));
}

}  // namespace
}  // namespace citymesh
