#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "services/jobs/job_manager.h"
#include "services/jobs/retention.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/telemetry/metrics.h"

namespace citymesh {

template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().message;
    abort();
  }
  return std::move(result).value();
}

inline void must(const Result<void>& result) {
  if (!result) {
    ADD_FAILURE() << result.error().message;
    abort();
  }
}

/// The real job stores over a temporary folder. No worker: a test finishes its jobs itself.
class JobService {
 public:
  JobService()
      : folder_(make_folder()),
        store_(must(EmbeddedStore::open(folder_ / "jobs.sqlite"))),
        results_(must(FolderResultStore::open(folder_ / "results"))),
        jobs_(std::make_unique<JobManager>(
            *store_, *store_, *results_,
            JobManagerOptions{.max_open_jobs = 100, .estimate = &JobService::estimate})) {}
  ~JobService() {
    jobs_.reset();
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  JobService(const JobService&) = delete;
  JobService& operator=(const JobService&) = delete;

  JobManager& jobs() { return *jobs_; }
  Metrics& metrics() { return metrics_; }

  struct File {
    std::string output, name, media_type, content;
  };

  /// The oldest waiting job becomes running.
  Claim start() {
    auto claim = must(store_->claim("worker-of-the-test", 60'000, 10'000));
    EXPECT_TRUE(claim.has_value());
    must(store_->update(claim->job_id, claim->attempt, [](Job& job) {
      job.state = JobState::Running;
      job.started = job.updated = now_ms();
      job.progress = {"heal", 3, 12};
      job.percent = 25;
      job.message = "heal: 3 of 12 buildings";
    }));
    return *claim;
  }

  void succeed(const Claim& claim, const std::vector<File>& files) {
    const auto folder = must(results_->stage(claim.job_id, claim.attempt));
    std::vector<ResultFile> listed;
    for (const auto& file : files) {
      std::ofstream(folder / file.name, std::ios::binary) << file.content;
      listed.push_back({file.output, file.name, file.media_type, file.content.size()});
    }
    must(results_->commit(claim.job_id, claim.attempt));
    must(store_->update(claim.job_id, claim.attempt, [&](Job& job) {
      job.state = JobState::Successful;
      job.finished = job.updated = now_ms();
      job.percent = 100;
      job.message = "12 buildings: 11 delivered, 1 dropped";
      job.results = listed;
    }));
    must(store_->done(claim));
  }

  void fail_job(const Claim& claim, const Error& error) {
    must(store_->update(claim.job_id, claim.attempt, [&](Job& job) {
      job.state = JobState::Failed;
      job.finished = job.updated = now_ms();
      job.error = error;
      job.message = error.message;
    }));
    must(store_->done(claim));
  }

  /// Time passes, until the results of all ended jobs are gone.
  void expire_results() {
    must(sweep(*store_, *results_, {.keep_results_ms = 1}, now_ms() + 1'000));
  }

  void forget_jobs() { must(sweep(*store_, *results_, {.keep_jobs_ms = 1}, now_ms() + 1'000)); }

  /// A successful job of every always-written file and an OBJ, submitted with `spec`.
  Job finished(JobSpec spec) {
    auto job = must(jobs_->submit(std::move(spec)));
    succeed(start(), export_files());
    return must(jobs_->get(job.id));
  }

  /// What a source would tell.
  static Result<Estimate> estimate(const std::string& process, const std::string&) {
    Estimate expected;
    expected.process = process;
    expected.buildings = 12;
    expected.outputs = {{"report", 14'000}};
    return expected;
  }

  static std::vector<File> export_files() {
    return {{"report", "report.json", "application/json", R"({"counts":{"requested":12}})"},
            {"report.html", "report.html", "text/html", "<!DOCTYPE html><title>Report</title>"},
            {"picture.svg", "picture.svg", "image/svg+xml", "<svg/>"},
            {"run.json", "run.json", "application/json", R"({"threads":1})"},
            {"obj", "model.obj", "model/obj", "o b_1\nv 0 0 0\n"},
            {"stl_binary", "model_binary.stl", "model/stl", std::string("\0\1\2\3", 4)},
            {"model_binary.patches.json", "model_binary.patches.json", "application/json", "[]"}};
  }

 private:
  static std::filesystem::path make_folder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "citymesh-rest-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) abort();
    return pattern;
  }

  std::filesystem::path folder_;
  std::unique_ptr<EmbeddedStore> store_;
  std::unique_ptr<FolderResultStore> results_;
  std::unique_ptr<JobManager> jobs_;
  Metrics metrics_;
};

}  // namespace citymesh
