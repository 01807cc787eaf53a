#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "services/jobs/job.h"
#include "services/jobs/stores.h"

namespace citymesh {

/// How long what jobs leave behind is kept after their end. 0: for ever, or no limit.
struct RetentionOptions {
  TimeMs keep_results_ms = 0;
  TimeMs keep_jobs_ms = 0;             ///< the record itself, with its results
  std::uint64_t max_result_bytes = 0;  ///< of all jobs; above it the oldest results go first
};

struct Swept {
  std::uint64_t results_expired = 0;  ///< jobs that lost their results and kept their record
  std::uint64_t jobs_forgotten = 0;
  std::uint64_t bytes_freed = 0;
};

/// Removes what is older or more than `options` allow. Files go before the record says so: after a
/// crash in between, the next sweep finishes the work. Safe beside readers, workers and sweeps of
/// other processes. Errors: those of the stores.
Result<Swept> sweep(JobStore& jobs, ResultStore& results, const RetentionOptions& options,
                    TimeMs now);

/// A job that was successful and whose results have been swept away.
bool has_expired(const Job& job);

}  // namespace citymesh
