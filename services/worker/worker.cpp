#include "services/worker/worker.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/processes/inputs.h"
#include "services/jobs/write_back.h"
#include "services/offer/offer.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "services/worker/result_cache.h"

namespace citymesh {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;

constexpr int kPatience = 5;  ///< nice value of working threads
constexpr TimeMs kClaimWaitMs = 250;
constexpr Milliseconds kKeeperTick{50};  // dismissals made by another process show within this time
constexpr Milliseconds kRestAfterError{500};
constexpr Milliseconds kRestAfterWithdrawal{10'000};  // that did not succeed

/// Why a running job was told to stop. The first reason counts.
enum class StopReason { None, Dismissed, Shutdown, Deadline, LeaseLost };

struct Run {
  Claim claim{};
  std::stop_source stop{};
  std::atomic<StopReason> reason{StopReason::None};
  Clock::time_point started = Clock::now();
  Clock::time_point next_heartbeat{};
  std::string cache_key{};  // of the results; empty: not to be found by later jobs
  bool cached = false;
  std::unique_ptr<WriteBackStore::Attempt> write_back{};  // none: not asked for

  void end(StopReason why) {
    auto none = StopReason::None;
    reason.compare_exchange_strong(none, why);
    stop.request_stop();
  }
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string counted(const Progress& progress, std::string_view unit) {
  if (progress.total == 0) return fmt::format("{}", progress.stage);
  return fmt::format("{}: {} of {} {}", progress.stage, progress.done, progress.total, unit);
}

/// The result files with their sizes as they are on disk.
Result<std::vector<ResultFile>> listed(const std::filesystem::path& folder,
                                       const std::vector<OutputFile>& files) {
  std::vector<ResultFile> results;
  for (const auto& file : files) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(folder / file.file_name, error);
    if (error)
      return fail(ErrorCode::Internal, fmt::format("result file '{}' cannot be read: {}",
                                                   file.file_name, error.message()));
    results.push_back({file.output, file.file_name, file.media_type, bytes});
  }
  return results;
}

std::uint64_t bytes_of(const std::vector<ResultFile>& files) {
  std::uint64_t bytes = 0;
  for (const auto& file : files) bytes += file.bytes;
  return bytes;
}

}  // namespace

struct WorkerPool::Impl {
  Impl(JobStore& jobs_in, TaskQueue& queue_in, ResultStore& results_in, SourceFactory source_in,
       Log& log_in, Metrics& metrics_in, WorkerOptions options_in)
      : jobs(jobs_in),
        queue(queue_in),
        results(results_in),
        source(std::move(source_in)),
        log(log_in),
        metrics(metrics_in),
        options(std::move(options_in)) {}

  void claim_and_work(const std::stop_token& shutdown, const std::string& worker);
  void work(const Claim& claim, const std::stop_token& shutdown);
  Result<ProcessOutcome> run_job(const Job& job, Run& run, std::filesystem::path& folder);
  Result<ProcessOutcome> answer(const Job& job, Run& run, std::filesystem::path& folder);
  Result<ProcessOutcome> compute(const Job& job, Run& run, const std::filesystem::path& folder);
  Result<void> write_back(const Run& run);
  void withdraw_later(const Job& job);
  void withdraw_now();
  std::string key_of(const Job& job) const;
  std::string_view finish(const Run& run, std::string_view process, Result<ProcessOutcome> outcome,
                          const std::filesystem::path& folder);
  std::string_view hand_back(const Run& run);
  std::string_view close(const Run& run, JobState state, std::string message,
                         std::optional<Error> error, std::vector<ResultFile> files);
  std::function<void(const Progress&)> progress_sink(Run& run, const Job& job);

  void discard(const Claim& claim);
  void keep(const std::stop_token& stop);
  void look_after(Run& run);
  void dismiss(const std::string& job_id);

  JobStore& jobs;
  TaskQueue& queue;
  ResultStore& results;
  SourceFactory source;
  Log& log;
  Metrics& metrics;
  WorkerOptions options;

  std::mutex running_mutex;
  std::map<std::string, std::shared_ptr<Run>> running;  // by job id
  JobFeed::Subscription dismissals;
  std::mutex withdrawals_mutex;
  std::set<std::string> withdrawals;  // jobs whose rows have to go
  Clock::time_point next_withdrawal{};
  std::vector<std::jthread> workers;
  std::jthread keeper;
};

WorkerPool::WorkerPool(JobStore& jobs, TaskQueue& queue, ResultStore& results, SourceFactory source,
                       Log& log, Metrics& metrics, WorkerOptions options)
    : impl_(std::make_unique<Impl>(jobs, queue, results, std::move(source), log, metrics,
                                   std::move(options))) {}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::start() {
  auto& pool = *impl_;
  pool.dismissals = pool.jobs.changes().subscribe([&pool](const Job& job) {
    if (job.dismiss_requested) pool.dismiss(job.id);
    // Of a job that is given up nobody is left to take the files away.
    if (job.state == JobState::Failed && job.attempt > 0) pool.discard({job.id, job.attempt, {}});
    if (is_final(job.state) && job.state != JobState::Successful && job.attempt > 0)
      pool.withdraw_later(job);
  });
  pool.keeper = std::jthread([&pool](const std::stop_token& stop) { pool.keep(stop); });
  const auto process = fmt::format("{}-{}", ::getpid(), new_job_id().substr(0, 8));
  for (unsigned i = 0; i < std::max(1u, pool.options.workers); ++i)
    pool.workers.emplace_back(
        [&pool, name = fmt::format("{}-{}", process, i)](const std::stop_token& stop) {
          // Answers go before work. Threads that a job starts are as patient.
          (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kPatience);
          pool.claim_and_work(stop, name);
        });
}

void WorkerPool::stop() {
  auto& pool = *impl_;
  for (auto& worker : pool.workers) worker.request_stop();
  pool.workers.clear();  // joins; leases are kept alive until here
  pool.next_withdrawal = {};
  pool.withdraw_now();
  pool.keeper = {};
  pool.dismissals = {};
}

void WorkerPool::Impl::claim_and_work(const std::stop_token& shutdown, const std::string& worker) {
  while (!shutdown.stop_requested()) {
    try {
      withdraw_now();
      const auto claim = queue.claim(worker, options.lease_ms, kClaimWaitMs);
      if (!claim) {
        log.error("claim_failed", {{"error", claim.error().message}});
        std::this_thread::sleep_for(kRestAfterError);
      } else if (*claim) {
        work(**claim, shutdown);
      }
    } catch (const std::exception& error) {
      log.error("worker_error", {{"worker", worker}, {"error", error.what()}});
      std::this_thread::sleep_for(kRestAfterError);
    }
  }
}

void WorkerPool::Impl::work(const Claim& claim, const std::stop_token& shutdown) {
  const auto run = std::make_shared<Run>();
  run->claim = claim;
  run->next_heartbeat = Clock::now() + Milliseconds(options.lease_ms / 3);
  struct Registered {
    Registered(Impl& pool_in, const std::shared_ptr<Run>& run)
        : pool(pool_in), id(run->claim.job_id) {
      const std::scoped_lock lock(pool.running_mutex);
      pool.running.insert_or_assign(id, run);
    }
    ~Registered() {
      const std::scoped_lock lock(pool.running_mutex);
      pool.running.erase(id);
    }
    Impl& pool;
    std::string id;
  } const registered(*this, run);
  const std::stop_callback on_shutdown(shutdown, [&run] { run->end(StopReason::Shutdown); });

  const auto job = jobs.update(claim.job_id, claim.attempt, [](Job& changed) {
    changed.state = JobState::Running;
    changed.started = changed.started.value_or(now_ms());
    changed.message = "started";
    changed.progress = {};
    changed.percent = 0;
  });
  if (!job) {
    const auto code = job.error().code;
    log.warning("job_not_started", {{"job_id", claim.job_id}, {"error", job.error().message}});
    if (code == ErrorCode::FailedPrecondition || code == ErrorCode::NotFound)
      (void)queue.done(claim);  // dismissed meanwhile
    else
      (void)queue.release(claim);
    return;
  }
  if (job->dismiss_requested) run->end(StopReason::Dismissed);

  log.info("job_started", {{"job_id", job->id},
                           {"process", job->spec.process},
                           {"attempt", claim.attempt},
                           {"worker", claim.worker},
                           {"owner", job->owner},
                           {"trace_id", job->trace_id}});
  metrics.job_started(job->spec.process);
  std::filesystem::path folder;
  auto outcome = run_job(*job, *run, folder);
  const auto error = outcome ? std::string() : outcome.error().message;
  const auto ended = finish(*run, job->spec.process, std::move(outcome), folder);
  const auto seconds = seconds_since(run->started);
  metrics.job_ended(job->spec.process, ended, seconds);
  if (ended == to_string(JobState::Failed))
    log.error("job_ended", {{"job_id", job->id},
                            {"process", job->spec.process},
                            {"state", ended},
                            {"seconds", seconds},
                            {"error", error},
                            {"trace_id", job->trace_id}});
  else
    log.info("job_ended", {{"job_id", job->id},
                           {"process", job->spec.process},
                           {"state", ended},
                           {"seconds", seconds},
                           {"trace_id", job->trace_id}});
}

// The edge behind which nothing is thrown: whatever a job does, its worker goes on.
Result<ProcessOutcome> WorkerPool::Impl::run_job(const Job& job, Run& run,
                                                 std::filesystem::path& folder) {
  try {
    return answer(job, run, folder);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::ResourceExhausted,
                "not enough memory for this job; try a smaller selection");
  } catch (const std::exception& error) {
    return fail(ErrorCode::Internal, fmt::format("unexpected error: {}", error.what()));
  } catch (...) {
    return fail(ErrorCode::Internal, "unexpected error of unknown type");
  }
}

/// From the results of an earlier job, or by work.
Result<ProcessOutcome> WorkerPool::Impl::answer(const Job& job, Run& run,
                                                std::filesystem::path& folder) {
  const auto stage = [&]() -> Result<void> {
    auto staged = results.stage(job.id, run.claim.attempt);
    if (!staged) return staged.error();
    folder = *std::move(staged);
    return {};
  };
  if (auto staged = stage(); !staged) return staged.error();
  const auto key = key_of(job);
  if (key.empty()) return compute(job, run, folder);

  if (const auto earlier = reuse_results(jobs, results, key, run.claim)) {
    log.info("results_reused",
             {{"job_id", job.id}, {"of", earlier->id}, {"trace_id", job.trace_id}});
    run.cached = true;
    run.cache_key = key;
    ProcessOutcome outcome;
    for (const auto& file : earlier->results)
      outcome.files.push_back({file.output, file.file_name, file.media_type});
    outcome.message = earlier->message;
    if (!earlier->cached) outcome.message += "; from the results of an earlier job";
    return outcome;
  }
  if (auto staged = stage(); !staged) return staged.error();
  auto outcome = compute(job, run, folder);
  if (outcome && key_of(job) == key) run.cache_key = key;  // nothing changed while it was read
  return outcome;
}

std::string WorkerPool::Impl::key_of(const Job& job) const {
  if (!options.source_version) return {};
  return cache_key(job, options.source_version(), options.share_results);
}

Result<ProcessOutcome> WorkerPool::Impl::compute(const Job& job, Run& run,
                                                 const std::filesystem::path& folder) {
  RunContext context;
  context.stop = run.stop.get_token();
  context.on_progress = progress_sink(run, job);
  context.now_s = [] {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  };
  context.threads = std::max(1u, options.threads_per_job);
  if (options.write_back != nullptr && asks_to_write_back(job.spec.inputs_json))
    run.write_back = options.write_back->begin(job.id, job.spec.process, context.stop);
  return run_offered(job.spec.process, job.spec.inputs_json, source, folder, context,
                     run.write_back.get());
}

/// Files first, then rows, then the word that the job is successful: a worker that dies between has
/// its job worked on again, with the same rows in place of these. Only who still has the job
/// writes.
Result<void> WorkerPool::Impl::write_back(const Run& run) {
  if (!run.write_back) return {};
  if (auto kept = queue.heartbeat(run.claim, options.lease_ms); !kept) return kept;
  return run.write_back->commit();
}

void WorkerPool::Impl::withdraw_later(const Job& job) {
  if (options.write_back == nullptr || !asks_to_write_back(job.spec.inputs_json)) return;
  const std::scoped_lock lock(withdrawals_mutex);
  withdrawals.insert(job.id);
}

void WorkerPool::Impl::withdraw_now() {
  std::set<std::string> due;
  {
    const std::scoped_lock lock(withdrawals_mutex);
    if (Clock::now() < next_withdrawal) return;
    due.swap(withdrawals);
  }
  for (const auto& job_id : due) {
    const auto withdrawn = options.write_back->withdraw(job_id);
    if (withdrawn) continue;
    log.warning("not_withdrawn", {{"job_id", job_id}, {"error", withdrawn.error().message}});
    const std::scoped_lock lock(withdrawals_mutex);
    withdrawals.insert(job_id);
    next_withdrawal = Clock::now() + kRestAfterWithdrawal;
  }
}

/// Ends the attempt in store and queue; returns the word for log and metrics.
std::string_view WorkerPool::Impl::finish(const Run& run, std::string_view process,
                                          Result<ProcessOutcome> outcome,
                                          const std::filesystem::path& folder) {
  const auto& claim = run.claim;
  switch (run.reason.load()) {
    case StopReason::LeaseLost:
      discard(claim);
      return "lost";
    case StopReason::Dismissed:
      return close(run, JobState::Dismissed, "dismissed", std::nullopt, {});
    case StopReason::Shutdown:
      if (!outcome && outcome.error().code == ErrorCode::Cancelled) return hand_back(run);
      break;
    case StopReason::Deadline:
      if (!outcome && outcome.error().code == ErrorCode::Cancelled)
        outcome = fail(
            ErrorCode::DeadlineExceeded,
            fmt::format("stopped after {:.1f} s, the limit is {:.1f} s", seconds_since(run.started),
                        static_cast<double>(options.job_timeout_ms) / 1000.0));
      break;
    case StopReason::None:
      break;
  }
  if (!outcome) return close(run, JobState::Failed, outcome.error().message, outcome.error(), {});

  auto files = listed(folder, outcome->files);
  if (files && options.max_job_bytes > 0 && bytes_of(*files) > options.max_job_bytes)
    files = fail(ErrorCode::ResourceExhausted,
                 fmt::format("the results have {} bytes, at most {} may be of one job; choose a "
                             "smaller `bbox` or fewer `formats`",
                             bytes_of(*files), options.max_job_bytes));
  if (!files) return close(run, JobState::Failed, files.error().message, files.error(), {});
  if (auto committed = results.commit(claim.job_id, claim.attempt); !committed)
    return close(run, JobState::Failed, committed.error().message, committed.error(), {});
  if (auto written = write_back(run); !written)
    return close(run, JobState::Failed, written.error().message, written.error(), {});
  if (run.cached) metrics.results_reused();
  for (const auto& [stage, seconds] : outcome->timings.stages_s)
    metrics.stage_took(process, stage, seconds);
  const auto& counts = outcome->buildings;
  metrics.buildings("delivered", counts.delivered);
  metrics.buildings("merged", counts.merged);
  metrics.buildings("dropped", counts.dropped);
  for (const auto& [code, count] : outcome->issues) metrics.issues(code, count);
  return close(run, JobState::Successful, std::move(outcome->message), std::nullopt,
               *std::move(files));
}

std::string_view WorkerPool::Impl::hand_back(const Run& run) {
  discard(run.claim);
  const auto job = jobs.update(run.claim.job_id, run.claim.attempt, [](Job& changed) {
    changed.state = changed.dismiss_requested ? JobState::Dismissed : JobState::Accepted;
    changed.message =
        changed.dismiss_requested ? "dismissed" : "queued again: the server shut down";
    if (changed.dismiss_requested) changed.finished = now_ms();
    changed.progress = {};
    changed.percent = 0;
  });
  const auto released =
      job && is_final(job->state) ? queue.done(run.claim) : queue.release(run.claim);
  if (!job || !released)
    log.error("job_not_released",
              {{"job_id", run.claim.job_id},
               {"error", job ? released.error().message : job.error().message}});
  return job && is_final(job->state) ? to_string(job->state) : "released";
}

std::string_view WorkerPool::Impl::close(const Run& run, JobState state, std::string message,
                                         std::optional<Error> error,
                                         std::vector<ResultFile> files) {
  const auto& claim = run.claim;
  if (state != JobState::Successful) discard(claim);  // before anyone sees the job as ended
  const auto job = jobs.update(claim.job_id, claim.attempt, [&](Job& changed) {
    changed.finished = now_ms();
    if (changed.dismiss_requested) {  // a dismissal that came during the last steps still counts
      changed.state = JobState::Dismissed;
      changed.message = "dismissed";
      return;
    }
    changed.state = state;
    changed.message = std::move(message);
    changed.error = std::move(error);
    if (state == JobState::Successful) {
      changed.results = std::move(files);
      changed.cache_key = run.cache_key;
      changed.cached = run.cached;
      changed.percent = 100;
      changed.progress.done = changed.progress.total;
    }
  });
  if (!job) {
    // Another attempt owns the job, or the store is down and the lease will run out.
    if (const auto other = jobs.get(claim.job_id);
        run.write_back && other && is_final(other->state) && other->state != JobState::Successful)
      withdraw_later(*other);
    log.error("job_not_closed", {{"job_id", claim.job_id}, {"error", job.error().message}});
    discard(claim);
    return "lost";
  }
  if (job->state != JobState::Successful && state == JobState::Successful) discard(claim);
  if (auto done = queue.done(claim); !done)
    log.warning("task_not_removed", {{"job_id", claim.job_id}, {"error", done.error().message}});
  return to_string(job->state);
}

std::function<void(const Progress&)> WorkerPool::Impl::progress_sink(Run& run, const Job& job) {
  struct Seen {
    std::set<std::string, std::less<>> stages{};
    std::optional<Clock::time_point> stored{};
    int percent = 0;
  };
  return [this, &run, unit = progress_unit(job.spec.process), trace_id = job.trace_id,
          seen = std::make_shared<Seen>()](const Progress& progress) {
    if (!seen->stages.contains(progress.stage)) {
      seen->stages.emplace(progress.stage);
      log.info("job_stage", {{"job_id", run.claim.job_id},
                             {"stage", progress.stage},
                             {"total", progress.total},
                             {"trace_id", trace_id}});
    }
    const auto now = Clock::now();
    if (seen->stored && now - *seen->stored < Milliseconds(options.progress_interval_ms)) return;
    seen->stored = now;
    if (progress.total > 0)
      seen->percent = std::max(seen->percent, static_cast<int>(std::min<double>(
                                                  99.0, 100.0 * static_cast<double>(progress.done) /
                                                            static_cast<double>(progress.total))));
    const auto stored =
        jobs.set_progress(run.claim.job_id, run.claim.attempt,
                          {std::string(progress.stage), progress.done, progress.total},
                          counted(progress, unit), seen->percent);
    if (!stored && stored.error().code == ErrorCode::FailedPrecondition)
      run.end(StopReason::LeaseLost);
  };
}

void WorkerPool::Impl::discard(const Claim& claim) {
  if (auto discarded = results.discard(claim.job_id, claim.attempt); !discarded)
    log.warning("files_not_discarded",
                {{"job_id", claim.job_id}, {"error", discarded.error().message}});
}

void WorkerPool::Impl::dismiss(const std::string& job_id) {
  const std::scoped_lock lock(running_mutex);
  if (const auto found = running.find(job_id); found != running.end())
    found->second->end(StopReason::Dismissed);
}

/// Heartbeats, dismissals from other processes and deadlines of all running jobs.
void WorkerPool::Impl::keep(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any tick;
  while (!stop.stop_requested()) {
    std::vector<std::shared_ptr<Run>> runs;
    {
      const std::scoped_lock lock(running_mutex);
      for (const auto& [id, run] : running) runs.push_back(run);
    }
    for (const auto& run : runs) look_after(*run);
    std::unique_lock lock(mutex);
    tick.wait_for(lock, stop, kKeeperTick, [] { return false; });
  }
}

void WorkerPool::Impl::look_after(Run& run) {
  const auto& claim = run.claim;
  const auto now = Clock::now();
  if (options.job_timeout_ms > 0 && now - run.started > Milliseconds(options.job_timeout_ms))
    run.end(StopReason::Deadline);
  if (const auto job = jobs.get(claim.job_id);
      (job && job->dismiss_requested) || (!job && job.error().code == ErrorCode::NotFound))
    run.end(StopReason::Dismissed);
  if (now < run.next_heartbeat) return;
  if (const auto kept = queue.heartbeat(claim, options.lease_ms); kept) {
    run.next_heartbeat = now + Milliseconds(options.lease_ms / 3);
  } else if (kept.error().code == ErrorCode::FailedPrecondition) {
    // Also when the job has just ended and its task is gone: then nobody listens any more.
    run.end(StopReason::LeaseLost);
  } else {
    log.warning("heartbeat_failed", {{"job_id", claim.job_id}, {"error", kept.error().message}});
  }
}

}  // namespace citymesh
