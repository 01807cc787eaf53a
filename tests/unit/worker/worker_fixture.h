#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "services/jobs/job_manager.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "services/worker/worker.h"
#include "tests/support/temp_folder.h"

namespace citymesh {

inline constexpr TimeMs kLongWait = 60'000;

/// A source whose reading does what the test wants.
class ScriptedSource final : public CitySource {
 public:
  using Script = std::function<Result<void>(const RunContext&)>;
  explicit ScriptedSource(Script script) : script_(std::move(script)) {}

  Result<Selection> select(const BuildingQuery&, const RunContext&) override {
    Selection selection;
    selection.crs = {"EPSG:25833"};
    return selection;
  }
  Result<void> read(const BuildingQuery&, const Selection&, const BuildingSink&,
                    const RunContext& context) override {
    return script_(context);
  }

 private:
  Script script_;
};

inline Result<void> until_stopped(const RunContext& context) {
  while (!context.stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return fail(ErrorCode::Cancelled, "stopped");
}

/// Workers over real stores; what a job does is up to the test.
class WorkerTest : public testing::Test {
 protected:
  WorkerTest()
      : store_(*EmbeddedStore::open(folder_ / "jobs.sqlite")),
        results_(*FolderResultStore::open(folder_ / "results")),
        jobs_(*store_, *store_, *results_, {.dismiss_wait_ms = kLongWait}) {}

  void work_on(ScriptedSource::Script script, WorkerOptions options = {}) {
    work_with(
        [script]() -> Result<std::unique_ptr<CitySource>> {
          return std::unique_ptr<CitySource>(new ScriptedSource(script));
        },
        options);
  }

  void work_with(SourceFactory source, WorkerOptions options = {}) {
    pool_ = std::make_unique<WorkerPool>(*store_, *store_, *results_, std::move(source), log_,
                                         metrics_, options);
    pool_->start();
  }

  std::string submitted(const std::string& inputs = "{}", const std::string& owner = {}) {
    const auto job =
        jobs_.submit({.process = "export-for-simulation", .inputs_json = inputs}, {}, owner);
    EXPECT_TRUE(job) << job.error().message;
    return job ? job->id : "";
  }

  Job awaited(const std::string& id, const std::function<bool(const Job&)>& condition) {
    auto job = jobs_.get(id);
    while (job && !condition(*job) && !is_final(job->state))
      job = jobs_.wait_for_change(id, job->updated, kLongWait);
    EXPECT_TRUE(job && condition(*job)) << (job ? job->message : job.error().message);
    return job ? *job : Job{};
  }

  Job ended(const std::string& id) {
    return awaited(id, [](const Job& job) { return is_final(job.state); });
  }

  Job running(const std::string& id) {
    return awaited(id, [](const Job& job) { return job.state == JobState::Running; });
  }

  bool has_files(const std::string& id) {
    return std::filesystem::exists(folder_ / "results" / id);
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_;
  std::unique_ptr<FolderResultStore> results_;
  JobManager jobs_;
  std::ostringstream lines_;
  Log log_{lines_};
  Metrics metrics_;
  std::unique_ptr<WorkerPool> pool_;
};

}  // namespace citymesh
