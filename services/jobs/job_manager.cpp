#include "services/jobs/job_manager.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/write/write.h"
#include "services/jobs/retention.h"
#include "services/offer/offer.h"

namespace citymesh {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr const char* kFormats = "formats";

template <class Specs>
std::string ids(const Specs& specs) {
  std::string text;
  for (const auto& spec : specs) {
    if (!text.empty()) text += ", ";
    text += spec.id;
  }
  return text;
}

Result<void> check_outputs(const ProcessSpec& process, const JobSpec& spec) {
  for (const auto& [output, transmission] : spec.outputs) {
    const auto known = std::ranges::any_of(
        process.outputs, [&](const OutputSpec& candidate) { return candidate.id == output; });
    if (!known)
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("outputs: '{}' is not an output of process {}; expected one of {}",
                              output, process.id, ids(process.outputs)));
  }
  return {};
}

/// Requested outputs that are formats are written also when `formats` does not name them.
std::string with_requested_formats(const ProcessSpec& process, const JobSpec& spec) {
  const auto has_formats = std::ranges::any_of(
      process.inputs, [](const OptionSpec& option) { return option.name == kFormats; });
  auto inputs = json::parse(spec.inputs_json.empty() ? "{}" : spec.inputs_json, nullptr, false);
  if (!has_formats || !inputs.is_object()) return spec.inputs_json;

  auto formats = inputs.contains(kFormats) ? inputs[kFormats] : json::array();
  if (formats.is_string()) formats = json::array({formats});  // one text is a list of one
  for (const auto& [output, transmission] : spec.outputs)
    if (find_format(output) != nullptr && std::ranges::find(formats, json(output)) == formats.end())
      formats.push_back(output);
  if (formats.empty()) return spec.inputs_json;
  inputs[kFormats] = std::move(formats);
  return inputs.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

JobManager::JobManager(JobStore& jobs, TaskQueue& queue, ResultStore& results,
                       JobManagerOptions options)
    : jobs_(jobs), queue_(queue), results_(results), options_(std::move(options)) {
  subscription_ = jobs_.changes().subscribe([this](const Job& job) {
    const std::scoped_lock lock(waiting_mutex_);
    const auto found = waiting_.find(job.id);
    if (found == waiting_.end()) return;
    ++found->second.changes;
    found->second.changed.notify_all();
  });
}

Result<AskedJob> JobManager::check(JobSpec spec) const {
  const auto* process = find_offered(spec.process);
  if (process == nullptr)
    return fail(ErrorCode::NotFound, fmt::format("process '{}' does not exist; available: {}",
                                                 spec.process, offered_ids()));
  if (auto checked = check_outputs(*process, spec); !checked) return checked.error();
  if (auto checked = check_subscriber(spec.subscriber); !checked) return checked.error();
  if (!spec.outputs.empty()) {
    // What is parsed there has passed the limits here.
    if (auto complete = complete_inputs(*process, spec.inputs_json); !complete)
      return complete.error();
    spec.inputs_json = with_requested_formats(*process, spec);
  }
  auto inputs = checked_inputs(spec.process, spec.inputs_json);
  if (!inputs) return inputs.error();
  spec.inputs_json = std::move(inputs->json);
  if (inputs->of_city && options_.check_inputs)
    if (auto allowed = options_.check_inputs(*inputs->of_city); !allowed) return allowed.error();
  return AskedJob{std::move(spec), inputs->of_city && inputs->of_city->only_estimate,
                  inputs->of_city && inputs->of_city->write_back};
}

Result<Estimate> JobManager::estimate(const AskedJob& asked) const {
  const auto& process = asked.spec.process;
  if (find_process(process) == nullptr)
    return fail(
        ErrorCode::Unimplemented,
        fmt::format("process '{}' reads no buildings: there is nothing to estimate", process));
  if (!options_.estimate)
    return fail(ErrorCode::Unimplemented, "this service does not estimate; submit a job instead");
  return options_.estimate(process, asked.spec.inputs_json);
}

Result<Job> JobManager::submit(JobSpec spec, std::string idempotency_key, std::string owner,
                               std::string trace_id) {
  auto asked = check(std::move(spec));
  if (!asked) return asked.error();
  return accept(*std::move(asked), std::move(idempotency_key), std::move(owner),
                std::move(trace_id));
}

Result<Job> JobManager::accept(AskedJob asked, std::string idempotency_key, std::string owner,
                               std::string trace_id) {
  if (asked.only_estimate)
    return fail(ErrorCode::InvalidArgument,
                "input `mode` is \"estimate\", which makes no job; expected \"run\"");

  Job job;
  job.id = new_job_id();
  job.spec = std::move(asked.spec);
  job.message = "queued";
  job.created = job.updated = now_ms();
  job.idempotency_key = std::move(idempotency_key);
  job.owner = std::move(owner);
  job.trace_id = std::move(trace_id);

  if (!job.idempotency_key.empty()) {
    auto first = repeated(job);
    if (first || first.error().code != ErrorCode::NotFound) return first;
  }
  if (const auto room = take_room_for(job); !room) return room.error();
  const auto stored = jobs_.insert(job);
  leave_room_of(job);
  if (!stored) {
    // Somebody else has just taken the same key.
    if (stored.error().code == ErrorCode::AlreadyExists) return repeated(job);
    return stored.error();
  }
  return job;
}

/// Jobs that are being stored count like stored ones, for many are stored at the same time. One
/// whose commit has just ended may so count twice for a moment: the limit is never exceeded.
Result<void> JobManager::take_room_for(const Job& job) {
  const std::scoped_lock lock(storing_mutex_);
  const auto open = jobs_.count_open();
  if (!open) return open.error();
  if (*open + storing_ >= options_.max_open_jobs)
    return fail(ErrorCode::ResourceExhausted,
                fmt::format("{} jobs are open and at most {} may be; try again later",
                            *open + storing_, options_.max_open_jobs));
  const auto found = storing_of_.find(job.owner);
  const std::uint64_t of_owner = found == storing_of_.end() ? 0 : found->second;
  if (options_.max_open_jobs_per_owner > 0 && !job.owner.empty()) {
    const auto own = jobs_.count_open_of(job.owner);
    if (!own) return own.error();
    if (*own + of_owner >= options_.max_open_jobs_per_owner)
      return fail(ErrorCode::ResourceExhausted,
                  fmt::format("{} of your jobs are open and at most {} may be; try again when one "
                              "of them has ended",
                              *own + of_owner, options_.max_open_jobs_per_owner));
  }
  ++storing_;
  ++storing_of_[job.owner];
  return {};
}

void JobManager::leave_room_of(const Job& job) {
  const std::scoped_lock lock(storing_mutex_);
  --storing_;
  const auto found = storing_of_.find(job.owner);
  if (--found->second == 0) storing_of_.erase(found);
}

Result<void> JobManager::check_subscriber(const Subscriber& subscriber) const {
  if (subscriber.empty()) return {};
  if (!options_.check_callback)
    return fail(ErrorCode::Unimplemented,
                "`subscriber`: this service calls nobody back; poll the job instead");
  for (const auto* uri :
       {&subscriber.success_uri, &subscriber.in_progress_uri, &subscriber.failed_uri})
    if (!uri->empty())
      if (auto checked = options_.check_callback(*uri); !checked) return checked;
  return {};
}

/// The job that a request with the key of `job` got before.
Result<Job> JobManager::repeated(const Job& job) {
  auto first = jobs_.get_by_key(job.owner, job.idempotency_key);
  if (first && first->spec != job.spec)
    return fail(ErrorCode::AlreadyExists,
                fmt::format("idempotency key '{}' belongs to job {}, which asked for something "
                            "else; expected the same request again or a new key",
                            job.idempotency_key, first->id));
  return first;
}

Result<Job> JobManager::get(const std::string& id) { return jobs_.get(id); }

Result<std::vector<Job>> JobManager::list(const JobFilter& filter) { return jobs_.list(filter); }

Result<std::uint64_t> JobManager::count(const JobFilter& filter) { return jobs_.count(filter); }

Result<Job> JobManager::dismiss(const std::string& id) {
  auto job = request_dismissal(id);
  if (!job || is_final(job->state)) return job;
  return wait_until(id, options_.dismiss_wait_ms,
                    [](const Job& now) { return is_final(now.state); });
}

Result<Job> JobManager::request_dismissal(const std::string& id) {
  auto job = jobs_.update(id, std::nullopt, [](Job& open) {
    open.dismiss_requested = true;
    if (open.state == JobState::Accepted) {
      open.state = JobState::Dismissed;
      open.message = "dismissed before it ran";
      open.finished = now_ms();
    } else {
      open.message = "dismissal requested";
    }
  });
  if (!job) {
    if (job.error().code == ErrorCode::FailedPrecondition) return jobs_.get(id);  // final already
    return job.error();
  }
  if (is_final(job->state))
    if (auto removed = queue_.remove(id); !removed) return removed.error();
  return job;
}

Result<std::vector<ResultFile>> JobManager::results(const std::string& id) {
  auto job = jobs_.get(id);
  if (!job) return job.error();
  switch (job->state) {
    case JobState::Successful:
      if (has_expired(*job))
        return fail(ErrorCode::NotFound, fmt::format("job {}: its {}", id, job->message));
      return std::move(job->results);
    case JobState::Failed:
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {} failed and has no results: {}", id, job->message));
    case JobState::Dismissed:
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {} was dismissed and has no results", id));
    case JobState::Accepted:
    case JobState::Running:
      break;
  }
  return fail(ErrorCode::FailedPrecondition,
              fmt::format("results of job {} are not ready: it is {}, expected successful", id,
                          to_string(job->state)));
}

Result<std::string> JobManager::read_result(const std::string& id, const std::string& file_name,
                                            std::uint64_t offset, std::uint64_t max_bytes) {
  const auto files = results(id);
  if (!files) return files.error();
  const auto listed = std::ranges::any_of(
      *files, [&](const ResultFile& file) { return file.file_name == file_name; });
  if (!listed)
    return fail(ErrorCode::NotFound, fmt::format("job {} has no result file '{}'", id, file_name));
  return results_.read(id, file_name, offset, max_bytes);
}

Result<Job> JobManager::wait_for_change(const std::string& id, TimeMs seen_updated,
                                        TimeMs wait_ms) {
  return wait_until(id, wait_ms, [seen_updated](const Job& job) {
    return job.updated > seen_updated || is_final(job.state);
  });
}

JobFeed::Subscription JobManager::listen(JobFeed::Listener listener) {
  return jobs_.changes().subscribe(std::move(listener));
}

Result<Job> JobManager::wait_until(const std::string& id, TimeMs wait_ms,
                                   const std::function<bool(const Job&)>& enough) {
  const auto deadline = Clock::now() + std::chrono::milliseconds(std::max<TimeMs>(wait_ms, 0));
  std::unique_lock lock(waiting_mutex_);
  auto& waiting = waiting_[id];
  ++waiting.callers;

  // The store is read without the lock; a change made meanwhile shows in `changes`.
  Result<Job> job = fail(ErrorCode::Internal, "");
  for (;;) {
    const auto seen = waiting.changes;
    lock.unlock();
    job = jobs_.get(id);
    lock.lock();
    const auto now = Clock::now();
    if (!job || enough(*job) || now >= deadline) break;
    const auto next_poll = now + std::chrono::milliseconds(options_.poll_ms);
    waiting.changed.wait_until(lock, std::min(deadline, next_poll),
                               [&] { return waiting.changes != seen; });
  }
  if (--waiting.callers == 0) waiting_.erase(id);
  return job;
}

}  // namespace citymesh
