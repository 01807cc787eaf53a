#include "services/jobs/write_back.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/worker/result_cache.h"
#include "tests/unit/worker/worker_fixture.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

/// Remembers which jobs have rows.
class Rows final : public WriteBackStore {
 public:
  class Writing final : public Attempt {
   public:
    Writing(Rows& rows, std::string job_id) : rows_(rows), job_id_(std::move(job_id)) {}
    Result<void> begin(const Scene&) override { return {}; }
    Result<void> add(const BuildingBodies&) override { return {}; }
    Result<std::vector<std::string>> finish() override { return std::vector<std::string>{"told"}; }
    Result<void> commit() override {
      if (rows_.before_commit) rows_.before_commit(job_id_);
      if (rows_.problem) return *rows_.problem;
      const std::scoped_lock lock(rows_.mutex_);
      rows_.written_.insert(job_id_);
      return {};
    }

   private:
    Rows& rows_;
    std::string job_id_;
  };

  std::unique_ptr<Attempt> begin(const std::string& job_id, const std::string&,
                                 std::stop_token) override {
    return std::make_unique<Writing>(*this, job_id);
  }
  Result<void> withdraw(const std::string& job_id) override {
    const std::scoped_lock lock(mutex_);
    written_.erase(job_id);
    withdrawn_.insert(job_id);
    return {};
  }

  bool has(const std::string& job_id) {
    const std::scoped_lock lock(mutex_);
    return written_.contains(job_id);
  }
  bool withdrawn(const std::string& job_id) {
    const std::scoped_lock lock(mutex_);
    return withdrawn_.contains(job_id);
  }

  std::function<void(const std::string& job_id)> before_commit{};
  std::optional<Error> problem{};

 private:
  std::mutex mutex_;
  std::set<std::string> written_, withdrawn_;
};

class WorkerWritesBack : public WorkerTest {
 protected:
  void TearDown() override { pool_.reset(); }

  void work(WorkerOptions options = {}) {
    options.write_back = &rows_;
    work_on([](const RunContext&) { return Result<void>{}; }, options);
  }

  Rows rows_;
};

constexpr const char* kAsked = R"({"write_back":true})";

TEST_F(WorkerWritesBack, AJobThatAsksForItHasItsRowsWhenItIsSuccessful) {
  std::optional<JobState> meanwhile;
  rows_.before_commit = [&](const std::string& id) { meanwhile = jobs_.get(id)->state; };
  work();
  const auto id = submitted(kAsked);
  EXPECT_EQ(ended(id).state, JobState::Successful);
  EXPECT_EQ(meanwhile, JobState::Running);
  EXPECT_TRUE(rows_.has(id));
  const auto report = results_->read(id, "report.json", 0, 1 << 20);
  ASSERT_TRUE(report);
  EXPECT_THAT(*report, HasSubstr("told"));

  const auto other = submitted();
  EXPECT_EQ(ended(other).state, JobState::Successful);
  EXPECT_FALSE(rows_.has(other));
}

TEST_F(WorkerWritesBack, AJobWhoseRowsAreRefusedFailsWithTheReasonAndWithoutFiles) {
  rows_.problem = fail(ErrorCode::PermissionDenied, "GRANT something");
  work();
  const auto id = submitted(kAsked);
  const auto job = ended(id);
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_THAT(job.message, HasSubstr("GRANT something"));
  EXPECT_FALSE(has_files(id));
}

TEST_F(WorkerWritesBack, ADismissalThatComesWithTheCommitLeavesNoRows) {
  rows_.before_commit = [&](const std::string& id) { EXPECT_TRUE(jobs_.request_dismissal(id)); };
  work();
  const auto id = submitted(kAsked);
  EXPECT_EQ(ended(id).state, JobState::Dismissed);
  pool_.reset();  // what is left to withdraw is withdrawn at the latest now
  EXPECT_TRUE(rows_.withdrawn(id));
  EXPECT_FALSE(rows_.has(id));
}

TEST_F(WorkerWritesBack, WithoutADatabaseAJobThatAsksForItFails) {
  work_on([](const RunContext&) { return Result<void>{}; });
  const auto job = ended(submitted(kAsked));
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_THAT(job.message, HasSubstr("--write_back_schema"));
}

TEST_F(WorkerWritesBack, ResultsOfAnEarlierJobAreNoAnswer) {
  WorkerOptions options;
  options.source_version = [] { return std::string("same"); };
  work(options);
  const auto first = submitted(kAsked), second = submitted(kAsked);
  EXPECT_EQ(ended(first).state, JobState::Successful);
  const auto again = ended(second);
  EXPECT_EQ(again.state, JobState::Successful);
  EXPECT_FALSE(again.cached);
  EXPECT_TRUE(rows_.has(second));
}

}  // namespace
}  // namespace citymesh
