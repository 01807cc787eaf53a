#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "services/jobs/job.h"
#include "services/jobs/job_feed.h"

namespace citymesh {

/// Holds the truth about jobs. Calls are atomic and thread-safe; a change is durable when the call
/// returns.
class JobStore {
 public:
  virtual ~JobStore() = default;

  /// Stores the job and, when it is open, queues it for the TaskQueue's claims: both or neither,
  /// whatever dies meanwhile. (A store that has its queue elsewhere keeps what is still to be sent
  /// there beside the job.) AlreadyExists when there is a job with its id, or with its owner and
  /// idempotency key.
  virtual Result<void> insert(const Job& job) = 0;
  virtual Result<Job> get(const std::string& id) = 0;  ///< NotFound
  virtual Result<Job> get_by_key(const std::string& owner,
                                 const std::string& idempotency_key) = 0;  ///< NotFound
  /// The last successful job with that key that still has its results. NotFound.
  virtual Result<Job> get_by_cache_key(const std::string& cache_key) = 0;
  virtual Result<std::vector<Job>> list(const JobFilter& filter) = 0;  ///< newest first
  /// How many jobs match; limit and offset of the filter do not count.
  virtual Result<std::uint64_t> count(const JobFilter& filter) = 0;

  // Accepted and running; cheap.
  virtual Result<std::uint64_t> count_open() = 0;
  virtual Result<std::uint64_t> count_open_of(const std::string& owner) = 0;

  /// Applies `change` to the stored job and stores it, unless the job is final already or `attempt`
  /// (when given) is no longer the job's attempt: then FailedPrecondition. A late worker can so
  /// never overwrite its successor.
  virtual Result<Job> update(const std::string& id, std::optional<std::uint32_t> attempt,
                             const std::function<void(Job&)>& change) = 0;
  /// As `update`, for the progress of a running job. Cheap: a crash may lose it.
  virtual Result<void> set_progress(const std::string& id, std::uint32_t attempt,
                                    const JobProgress& progress, std::string_view message,
                                    int percent) = 0;
  virtual Result<void> erase(const std::string& id) = 0;

  // What ended jobs leave behind, for retention.

  /// Jobs that ended before `time`, oldest first; `with_results`: only those that have some.
  virtual Result<std::vector<Job>> ended_before(TimeMs time, bool with_results,
                                                std::uint32_t limit) = 0;
  virtual Result<std::uint64_t> result_bytes() = 0;  ///< of all jobs together
  /// The list of results of an ended job becomes empty, and its cache key. FailedPrecondition for
  /// an open job.
  virtual Result<Job> drop_results(const std::string& id, std::string_view message) = 0;

  // What ended jobs still have to tell their subscribers.

  struct DueCallback {
    Job job{};
    std::uint32_t attempt = 0;  ///< 1 for the first
  };
  /// Takes a callback that is due. Unless it is done before, it is due again after the time that
  /// `retry_after` says for the attempt; where that says nothing, it was the last one.
  virtual Result<std::optional<DueCallback>> take_callback(
      TimeMs now,
      const std::function<std::optional<TimeMs>(std::uint32_t attempt)>& retry_after) = 0;
  virtual Result<void> callback_done(const std::string& id) = 0;

  /// Tells of every change made through this object. Another process may change jobs unheard.
  JobFeed& changes() { return changes_; }

 private:
  JobFeed changes_;
};

/// A claimed piece of work, held by a lease that heartbeats extend.
struct Claim {
  std::string job_id{};
  std::uint32_t attempt = 0;  ///< 1 for the first try
  std::string worker{};
};

/// Hands jobs to workers, each to one at a time. JobStore::insert fills it.
class TaskQueue {
 public:
  virtual ~TaskQueue() = default;

  /// The oldest task that is free or whose lease has run out; none: empty. Waits up to `wait_ms`
  /// for one. The claim's attempt becomes the job's. A lease that ran out counts as a death of the
  /// worker; after the allowed number of deaths the job is failed instead of claimed.
  virtual Result<std::optional<Claim>> claim(const std::string& worker, TimeMs lease_ms,
                                             TimeMs wait_ms) = 0;
  /// FailedPrecondition when the lease was lost to another worker.
  virtual Result<void> heartbeat(const Claim& claim, TimeMs lease_ms) = 0;
  virtual Result<void> done(const Claim& claim) = 0;     ///< removes the task
  virtual Result<void> release(const Claim& claim) = 0;  ///< back to the queue at once (shutdown)
  virtual Result<void> remove(const std::string& job_id) = 0;
  struct Waiting {
    std::uint64_t tasks = 0;  ///< that no worker holds
    TimeMs oldest = 0;        ///< when the job of the first of them was created
  };
  virtual Result<Waiting> waiting() = 0;
};

/// Immutable result files. A job's files become visible all at once, by `commit`.
class ResultStore {
 public:
  virtual ~ResultStore() = default;

  /// An empty private folder for one attempt; what an earlier attempt left is gone.
  virtual Result<std::filesystem::path> stage(const std::string& job_id, std::uint32_t attempt) = 0;
  /// Puts files that another job has committed into the folder of a staged attempt, at little cost.
  /// They are then the attempt's own, whatever becomes of the other job. NotFound when one of them
  /// is not there any more; some may then have been put.
  virtual Result<void> reuse(const std::string& from_job_id, const std::vector<ResultFile>& files,
                             const std::string& job_id, std::uint32_t attempt) = 0;
  virtual Result<void> commit(const std::string& job_id, std::uint32_t attempt) = 0;
  virtual Result<void> discard(const std::string& job_id, std::uint32_t attempt) = 0;

  /// Bytes [offset, offset + max) of a committed file; empty at the end. NotFound. `file_name` is
  /// never a path.
  virtual Result<std::string> read(const std::string& job_id, const std::string& file_name,
                                   std::uint64_t offset, std::uint64_t max_bytes) = 0;
  virtual Result<std::uint64_t> size(const std::string& job_id, const std::string& file_name) = 0;
  virtual Result<void> erase(const std::string& job_id) = 0;
};

}  // namespace citymesh
