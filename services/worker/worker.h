#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "services/jobs/stores.h"
#include "services/worker/run_offered.h"

namespace citymesh {

class Log;
class Metrics;
class WriteBackStore;

struct WorkerOptions {
  unsigned workers = 1;               ///< jobs worked on at the same time
  unsigned threads_per_job = 1;       ///< threads of one job's own work
  TimeMs lease_ms = 30'000;           ///< a worker not heard of for so long counts as dead
  TimeMs job_timeout_ms = 0;          ///< a job that runs longer is failed; 0: no limit
  std::uint64_t max_job_bytes = 0;    ///< a job whose results are larger is failed; 0: no limit
  TimeMs progress_interval_ms = 200;  ///< least time between two stored progress reports

  /// Text that differs whenever what jobs read does; empty: unknown. With it a job that asks for
  /// what an earlier one asked for gets the results of that one; none: every job is worked on.
  std::function<std::string()> source_version{};
  bool share_results = false;  ///< also with jobs of other owners
  /// For jobs that write back, which fail without; must outlive the pool. A job that ends otherwise
  /// than successful has what it wrote withdrawn, in time: tried until it is done.
  WriteBackStore* write_back = nullptr;
};

/// Threads that claim jobs, run them and store their results. They keep nothing between jobs, and
/// nothing that a job does ends its worker. The source is opened once per job, on its worker
/// thread. The stores must outlive the pool.
class WorkerPool {
 public:
  WorkerPool(JobStore& jobs, TaskQueue& queue, ResultStore& results, SourceFactory source, Log& log,
             Metrics& metrics, WorkerOptions options = {});
  ~WorkerPool();  ///< stops
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  void start();

  /// Stops the running jobs and hands them back to the queue. Returns when all threads have ended.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
