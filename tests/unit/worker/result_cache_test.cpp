#include "services/worker/result_cache.h"

#include <gmock/gmock.h>

#include <atomic>
#include <set>

#include "services/jobs/retention.h"
#include "tests/unit/worker/worker_fixture.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

/// Results as they are, with something done before another job's are reused.
class WatchedResults final : public ResultStore {
 public:
  explicit WatchedResults(ResultStore& results) : results_(results) {}
  std::function<void(const std::string& from, const std::string& job)> before_reuse{};

  Result<std::filesystem::path> stage(const std::string& id, std::uint32_t attempt) override {
    return results_.stage(id, attempt);
  }
  Result<void> reuse(const std::string& from, const std::vector<ResultFile>& files,
                     const std::string& id, std::uint32_t attempt) override {
    if (before_reuse) before_reuse(from, id);
    return results_.reuse(from, files, id, attempt);
  }
  Result<void> commit(const std::string& id, std::uint32_t attempt) override {
    return results_.commit(id, attempt);
  }
  Result<void> discard(const std::string& id, std::uint32_t attempt) override {
    return results_.discard(id, attempt);
  }
  Result<std::string> read(const std::string& id, const std::string& name, std::uint64_t offset,
                           std::uint64_t max_bytes) override {
    return results_.read(id, name, offset, max_bytes);
  }
  Result<std::uint64_t> size(const std::string& id, const std::string& name) override {
    return results_.size(id, name);
  }
  Result<void> erase(const std::string& id) override { return results_.erase(id); }

 private:
  ResultStore& results_;
};

class ResultCacheTest : public WorkerTest {
 protected:
  void TearDown() override { pool_.reset(); }  // it uses what this class adds

  /// A pool with the cache; `runs_` counts the jobs that are worked on.
  void work(WorkerOptions options = {}) {
    options.source_version = [this] {
      const std::scoped_lock lock(version_mutex_);
      return version_;
    };
    pool_ = std::make_unique<WorkerPool>(
        *store_, *store_, watched_,
        [this]() -> Result<std::unique_ptr<CitySource>> {
          return std::unique_ptr<CitySource>(new ScriptedSource([this](const RunContext& context) {
            ++runs_;
            return script_ ? script_(context) : Result<void>{};
          }));
        },
        log_, metrics_, options);
    pool_->start();
  }

  void set_version(const std::string& version) {
    const std::scoped_lock lock(version_mutex_);
    version_ = version;
  }

  Job done(const std::string& inputs = "{}", const std::string& owner = {}) {
    auto job = ended(submitted(inputs, owner));
    EXPECT_EQ(job.state, JobState::Successful) << job.message;
    return job;
  }

  std::string content(const Job& job, const std::string& file) {
    const auto bytes = jobs_.read_result(job.id, file, 0, 1 << 20);
    EXPECT_TRUE(bytes) << bytes.error().message;
    return bytes ? *bytes : "";
  }

  WatchedResults watched_{*results_};
  std::mutex version_mutex_;
  std::string version_ = "first";
  std::atomic<int> runs_ = 0;
  ScriptedSource::Script script_;
};

TEST_F(ResultCacheTest, AJobThatAsksForTheSameGetsTheResultsOfTheFirst) {
  work();
  const auto first = done();
  EXPECT_FALSE(first.cached);
  const auto second = done(R"({"formats":["obj"]})");  // the default in so many words
  EXPECT_TRUE(second.cached);
  EXPECT_EQ(runs_, 1);
  EXPECT_EQ(second.message, first.message + "; from the results of an earlier job");
  EXPECT_EQ(second.percent, 100);
  ASSERT_EQ(second.results.size(), first.results.size());
  for (std::size_t i = 0; i < first.results.size(); ++i) {
    EXPECT_EQ(second.results[i].output, first.results[i].output);
    EXPECT_EQ(second.results[i].media_type, first.results[i].media_type);
    EXPECT_EQ(second.results[i].bytes, first.results[i].bytes);
    EXPECT_EQ(content(second, second.results[i].file_name),
              content(first, first.results[i].file_name));
  }
  pool_->stop();
  EXPECT_THAT(lines_.str(), HasSubstr(R"("event":"results_reused","job_id":")" + second.id));
  EXPECT_THAT(metrics_.text(), HasSubstr("citymesh_result_cache_hits_total 1"));
}

TEST_F(ResultCacheTest, WhatWasReusedOutlivesItsFirstJobAndIsReusedItself) {
  work();
  const auto first = done();
  const auto second = done();
  ASSERT_TRUE(second.cached);
  ASSERT_TRUE(results_->erase(first.id));
  ASSERT_TRUE(store_->erase(first.id));
  EXPECT_FALSE(content(second, "report.json").empty());
  const auto third = done();
  EXPECT_TRUE(third.cached);
  EXPECT_EQ(third.message, second.message);
  EXPECT_EQ(runs_, 1);
}

TEST_F(ResultCacheTest, OtherInputsOrDataAreWorkedOn) {
  work();
  done();
  EXPECT_FALSE(done(R"({"formats":["stl"]})").cached);
  set_version("second");
  EXPECT_FALSE(done().cached);
  EXPECT_TRUE(done().cached);
  set_version("first");
  EXPECT_TRUE(done().cached);
  EXPECT_EQ(runs_, 3);
}

TEST_F(ResultCacheTest, DataOfUnknownVersionAreWorkedOnEveryTime) {
  set_version("");
  work();
  done();
  EXPECT_FALSE(done().cached);
  EXPECT_EQ(runs_, 2);
}

TEST_F(ResultCacheTest, ResultsOfDataThatChangedMeanwhileAreNotReused) {
  script_ = [this](const RunContext&) -> Result<void> {
    set_version("changed");
    return {};
  };
  work();
  done();
  set_version("first");
  EXPECT_FALSE(done().cached);
  set_version("changed");
  EXPECT_FALSE(done().cached);
}

TEST_F(ResultCacheTest, AnOwnerNeverGetsTheResultsOfAnother) {
  work();
  done("{}", "city");
  EXPECT_FALSE(done("{}", "port").cached);
  EXPECT_FALSE(done().cached);
  EXPECT_TRUE(done("{}", "city").cached);
  EXPECT_TRUE(done("{}", "port").cached);
  EXPECT_EQ(runs_, 3);
}

TEST_F(ResultCacheTest, WhereNobodyIsToldApartAllShareResults) {
  work({.share_results = true});
  done("{}", "address:192.0.2.1");
  EXPECT_TRUE(done("{}", "address:192.0.2.2").cached);
}

TEST_F(ResultCacheTest, AJobThatFailedOrWasDismissedAnswersNone) {
  std::atomic<int> run = 0;
  script_ = [&run](const RunContext& context) -> Result<void> {
    switch (run++) {
      case 0:
        return fail(ErrorCode::Unavailable, "no");
      case 1:
        return until_stopped(context);
      default:
        return {};
    }
  };
  work();
  EXPECT_EQ(ended(submitted()).state, JobState::Failed);
  const auto dismissed = submitted();
  while (run < 2) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(jobs_.dismiss(dismissed));
  EXPECT_FALSE(done().cached);
  EXPECT_EQ(runs_, 3);
}

TEST_F(ResultCacheTest, SweptResultsAreMadeAgain) {
  work();
  const auto first = done();
  ASSERT_TRUE(sweep(*store_, *results_, {.keep_results_ms = 1}, now_ms() + 1'000));
  EXPECT_FALSE(done().cached);
  EXPECT_EQ(runs_, 2);
}

TEST_F(ResultCacheTest, ResultsThatAreSweptAtThisMomentAreMadeAgain) {
  work();
  const auto first = done();
  watched_.before_reuse = [this](const std::string& from, const std::string&) {
    EXPECT_TRUE(results_->erase(from));
  };
  const auto second = done();
  EXPECT_FALSE(second.cached);
  EXPECT_FALSE(content(second, "report.json").empty());
  EXPECT_EQ(runs_, 2);
}

TEST_F(ResultCacheTest, ResultsOfWhichAFileIsGoneAreMadeAgain) {
  work();
  const auto first = done();
  watched_.before_reuse = [this](const std::string& from, const std::string&) {
    std::filesystem::remove(folder_ / "results" / from / "attempt-1" / "report.html");
  };
  const auto second = done();
  EXPECT_FALSE(second.cached);
  ASSERT_EQ(second.results.size(), first.results.size());
  for (const auto& file : second.results) content(second, file.file_name);
}

TEST_F(ResultCacheTest, ADismissalWhileResultsAreReusedCounts) {
  work();
  done();
  watched_.before_reuse = [this](const std::string&, const std::string& job) {
    EXPECT_TRUE(jobs_.request_dismissal(job));
  };
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Dismissed);
  EXPECT_FALSE(job.cached);
  EXPECT_FALSE(has_files(job.id));
  EXPECT_EQ(runs_, 1);
}

TEST_F(ResultCacheTest, ReusedResultsCountForTheLimitOfAJob) {
  work();
  done();
  pool_.reset();
  work({.max_job_bytes = 100});
  const auto job = ended(submitted());
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_EQ(job.error->code, ErrorCode::ResourceExhausted);
  pool_->stop();  // the files go after the state is told
  EXPECT_FALSE(has_files(job.id));
}

TEST_F(ResultCacheTest, WithoutAVersionOfTheSourceThereIsNone) {
  work_on([this](const RunContext&) -> Result<void> { return ++runs_, Result<void>{}; });
  done();
  EXPECT_FALSE(done().cached);
  EXPECT_EQ(runs_, 2);
}

TEST_F(ResultCacheTest, EchoIsAnsweredByEcho) {
  work();
  for (int time = 0; time < 2; ++time) {
    const auto job = jobs_.submit({.process = "echo", .inputs_json = R"({"text":"hello"})"});
    ASSERT_TRUE(job) << job.error().message;
    EXPECT_FALSE(ended(job->id).cached);
  }
}

TEST(CacheKey, DiffersInEveryPartAndFromPartToPart) {
  Job job;
  job.spec.process = "heal";
  job.spec.inputs_json = "{}";
  job.owner = "city";
  std::set<std::string> keys{cache_key(job, "data", false), cache_key(job, "other", false),
                             cache_key(job, "data", true), cache_key(job, "data", false, "9.9.9")};
  auto other = job;
  other.owner = "port";
  keys.insert(cache_key(other, "data", false));
  other = job;
  other.owner.clear();
  keys.insert(cache_key(other, "data", false));
  other = job;
  other.spec.process = "validate";
  keys.insert(cache_key(other, "data", false));
  other = job;
  other.spec.inputs_json = R"({"formats":["obj"]})";
  keys.insert(cache_key(other, "data", false));
  other = job;
  other.spec.process = "heal{}";
  other.spec.inputs_json = "";
  keys.insert(cache_key(other, "data", false));
  EXPECT_EQ(keys.size(), 9u);
}

TEST(CacheKey, IsTheSameForWhatDoesNotChangeTheFiles) {
  Job job, other;
  job.spec = {.process = "heal", .inputs_json = "{}"};
  other.spec = job.spec;
  other.id = new_job_id();
  other.spec.outputs = {{"report", Transmission::Value}};
  other.spec.response_document = true;
  other.spec.subscriber.success_uri = "https://portal.example/done";
  other.idempotency_key = "key";
  EXPECT_EQ(cache_key(job, "data", false), cache_key(other, "data", false));
  other.owner = "city";
  EXPECT_EQ(cache_key(job, "data", true), cache_key(other, "data", true));
}

}  // namespace
}  // namespace citymesh
