#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pipeline/estimate.h"
#include "core/processes/inputs.h"
#include "services/jobs/job.h"
#include "services/jobs/stores.h"

namespace citymesh {

struct JobManagerOptions {
  /// Accepted and running; more are refused with ResourceExhausted.
  std::uint32_t max_open_jobs = 1000;
  /// The same for each owner; jobs of nobody in particular do not count. 0: no limit of its own.
  std::uint32_t max_open_jobs_per_owner = 0;
  /// What inputs may not ask of this service, whatever the process allows; empty: nothing.
  std::function<Result<void>(const Inputs& inputs)> check_inputs{};
  /// What checked inputs would process; empty: this service does not estimate.
  std::function<Result<Estimate>(const std::string& process, const std::string& inputs_json)>
      estimate{};
  /// Whether a subscriber's URI may be called; empty: this service calls nobody.
  std::function<Result<void>(const std::string& uri)> check_callback{};
  /// How long `dismiss` waits for a running job to stop before it answers.
  TimeMs dismiss_wait_ms = 1000;
  /// How often a waiting call looks for changes that another process made.
  TimeMs poll_ms = 250;
};

/// What somebody asked for, checked.
struct AskedJob {
  JobSpec spec{};
  bool only_estimate = false;  ///< the input `mode` says so: no job, but estimate()
  bool write_back = false;     ///< the input of this name: not everybody has the right to it
};

/// The verbs of the service. REST and gRPC translate to and from these and nothing else.
/// Thread-safe.
class JobManager {
 public:
  JobManager(JobStore& jobs, TaskQueue& queue, ResultStore& results,
             JobManagerOptions options = {});

  /// Checks process, outputs, subscriber and inputs (checked_inputs). Errors: NotFound for an
  /// unknown process, InvalidArgument, Unimplemented. Requested outputs that are formats are added
  /// to the input `formats`, or are the formats where the request states none.
  Result<AskedJob> check(JobSpec spec) const;

  /// Stores the job and queues it. Errors: InvalidArgument when only an estimate was asked for,
  /// ResourceExhausted.
  /// With an idempotency key a repeated request of the same owner gets the job of the first one,
  /// also when that has ended. AlreadyExists when the first one asked for something else. The key
  /// is free again once the job is forgotten.
  Result<Job> accept(AskedJob asked, std::string idempotency_key = {}, std::string owner = {},
                     std::string trace_id = {});
  /// check() and accept().
  Result<Job> submit(JobSpec spec, std::string idempotency_key = {}, std::string owner = {},
                     std::string trace_id = {});
  /// What a job of this kind would process, without making one: the input `mode` may say so or not.
  /// Errors: those of the source, Unimplemented.
  Result<Estimate> estimate(const AskedJob& asked) const;
  Result<Job> get(const std::string& id);
  Result<std::vector<Job>> list(const JobFilter& filter);
  Result<std::uint64_t> count(const JobFilter& filter);

  /// An open job ends as dismissed: at once when queued, within 100 ms of own work when running. A
  /// final job stays as it is and is no error. The job may still be `running` in the answer, with
  /// `dismiss_requested`, when its worker takes longer than `dismiss_wait_ms`.
  Result<Job> dismiss(const std::string& id);
  /// The same without waiting for the worker.
  Result<Job> request_dismissal(const std::string& id);

  /// FailedPrecondition (not ready, failed, dismissed) unless successful; NotFound when expired.
  Result<std::vector<ResultFile>> results(const std::string& id);
  Result<std::string> read_result(const std::string& id, const std::string& file_name,
                                  std::uint64_t offset, std::uint64_t max_bytes);

  /// Blocks until the job changes after `seen_updated`, is final, or `wait_ms` have passed; returns
  /// its present state.
  Result<Job> wait_for_change(const std::string& id, TimeMs seen_updated, TimeMs wait_ms);

  /// Tells of every change that this process makes to a job, see JobFeed.
  [[nodiscard]] JobFeed::Subscription listen(JobFeed::Listener listener);

 private:
  struct Waiting {
    std::condition_variable changed{};
    std::uint64_t changes = 0;
    std::uint32_t callers = 0;
  };

  Result<Job> wait_until(const std::string& id, TimeMs wait_ms,
                         const std::function<bool(const Job&)>& enough);
  Result<Job> repeated(const Job& job);
  Result<void> check_subscriber(const Subscriber& subscriber) const;
  Result<void> take_room_for(const Job& job);
  void leave_room_of(const Job& job);

  JobStore& jobs_;
  TaskQueue& queue_;
  ResultStore& results_;
  JobManagerOptions options_;

  std::mutex storing_mutex_;
  std::uint64_t storing_ = 0;                          // jobs on their way into the store
  std::map<std::string, std::uint64_t> storing_of_{};  // the same by owner
  std::mutex waiting_mutex_;
  std::map<std::string, Waiting> waiting_;  // by job id; only jobs somebody waits for
  JobFeed::Subscription subscription_;
};

}  // namespace citymesh
