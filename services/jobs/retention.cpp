#include "services/jobs/retention.h"

#include <algorithm>
#include <limits>

namespace citymesh {
namespace {

constexpr std::uint32_t kBatch = 100;
constexpr TimeMs kAnyTime = std::numeric_limits<TimeMs>::max();

std::uint64_t bytes_of(const Job& job) {
  std::uint64_t bytes = 0;
  for (const auto& file : job.results) bytes += file.bytes;
  return bytes;
}

class Sweep {
 public:
  Sweep(JobStore& jobs, ResultStore& results) : jobs_(jobs), results_(results) {}

  Result<void> forget_before(TimeMs time) {
    return for_each(time, false, [&](const Job& job) -> Result<bool> {
      if (auto erased = results_.erase(job.id); !erased) return erased.error();
      if (auto erased = jobs_.erase(job.id); !erased) return is_gone(erased.error());
      ++swept_.jobs_forgotten;
      swept_.bytes_freed += bytes_of(job);
      return true;
    });
  }

  Result<void> expire_before(TimeMs time) {
    return for_each(time, true,
                    [&](const Job& job) { return expire(job, "results have expired"); });
  }

  /// The oldest results, until those that are left fit.
  Result<void> expire_down_to(std::uint64_t most_bytes) {
    const auto held = jobs_.result_bytes();
    if (!held) return held.error();
    std::uint64_t left = *held;
    if (left <= most_bytes) return {};
    return for_each(kAnyTime, true, [&](const Job& job) -> Result<bool> {
      left -= std::min(left, bytes_of(job));
      auto expired = expire(job, "results were removed to make room for newer ones");
      if (!expired) return expired;
      return left > most_bytes;
    });
  }

  const Swept& swept() const { return swept_; }

 private:
  /// Another process was faster.
  static Result<bool> is_gone(const Error& error) {
    if (error.code == ErrorCode::NotFound) return true;
    return error;
  }

  Result<bool> expire(const Job& job, std::string_view why) {
    if (auto erased = results_.erase(job.id); !erased) return erased.error();
    if (auto dropped = jobs_.drop_results(job.id, why); !dropped) return is_gone(dropped.error());
    ++swept_.results_expired;
    swept_.bytes_freed += bytes_of(job);
    return true;
  }

  /// `visit` takes the job out of what is asked for, and says whether to go on.
  template <class Visit>
  Result<void> for_each(TimeMs time, bool with_results, Visit&& visit) {
    for (;;) {
      const auto batch = jobs_.ended_before(time, with_results, kBatch);
      if (!batch) return batch.error();
      for (const auto& job : *batch) {
        const Result<bool> go_on = visit(job);
        if (!go_on) return go_on.error();
        if (!*go_on) return {};
      }
      if (batch->size() < kBatch) return {};
    }
  }

  JobStore& jobs_;
  ResultStore& results_;
  Swept swept_;
};

}  // namespace

Result<Swept> sweep(JobStore& jobs, ResultStore& results, const RetentionOptions& options,
                    TimeMs now) {
  Sweep sweep(jobs, results);
  if (options.keep_jobs_ms > 0)
    if (auto done = sweep.forget_before(now - options.keep_jobs_ms); !done) return done.error();
  if (options.keep_results_ms > 0)
    if (auto done = sweep.expire_before(now - options.keep_results_ms); !done) return done.error();
  if (options.max_result_bytes > 0)
    if (auto done = sweep.expire_down_to(options.max_result_bytes); !done) return done.error();
  return sweep.swept();
}

bool has_expired(const Job& job) {
  return job.state == JobState::Successful && job.results.empty();
}

}  // namespace citymesh
