#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "services/jobs/job.h"
#include "services/jobs/stores.h"

namespace citymesh {

struct JobManagerOptions {
  std::uint32_t max_open_jobs =
      1000;  ///< accepted and running; more are refused with ResourceExhausted
};

/// The verbs of the service. REST and gRPC translate to and from these and nothing else.
/// Thread-safe.
class JobManager {
 public:
  JobManager(JobStore& jobs, TaskQueue& queue, ResultStore& results,
             JobManagerOptions options = {});

  /// Checks process and inputs (canonical_inputs), stores the job and queues it. Errors: NotFound
  /// for an unknown process, InvalidArgument for inputs or outputs, ResourceExhausted.
  Result<Job> submit(JobSpec spec);
  Result<Job> get(const std::string& id);
  Result<std::vector<Job>> list(const JobFilter& filter);

  /// An open job ends as dismissed: at once when queued, within 100 ms of own work when running. A
  /// final job stays.
  Result<Job> dismiss(const std::string& id);

  /// FailedPrecondition (not ready, failed, dismissed) unless successful.
  Result<std::vector<ResultFile>> results(const std::string& id);
  Result<std::string> read_result(const std::string& id, const std::string& file_name,
                                  std::uint64_t offset, std::uint64_t max_bytes);

  /// Blocks until the job changes after `seen_updated`, is final, or `wait_ms` have passed; returns
  /// its present state.
  Result<Job> wait_for_change(const std::string& id, TimeMs seen_updated, TimeMs wait_ms);

 private:
  JobStore& jobs_;
  TaskQueue& queue_;
  ResultStore& results_;
  JobManagerOptions options_;
};

}  // namespace citymesh
