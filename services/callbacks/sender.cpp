#include "services/callbacks/sender.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "services/callbacks/address_guard.h"
#include "services/callbacks/signature.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"

namespace citymesh {
namespace {

const std::string& uri_for(const Job& job) {
  const auto& subscriber = job.spec.subscriber;
  if (!is_final(job.state)) return subscriber.in_progress_uri;
  return job.state == JobState::Successful ? subscriber.success_uri : subscriber.failed_uri;
}

bool is_received(const Result<int>& status) { return status && *status >= 200 && *status < 300; }

}  // namespace

std::optional<TimeMs> retry_after(std::uint32_t attempt, const SenderOptions& options) {
  if (attempt >= options.max_attempts) return std::nullopt;
  auto wait = options.first_retry_ms;
  for (std::uint32_t i = 1; i < attempt && wait < options.longest_retry_ms; ++i) wait *= 4;
  return std::min(wait, options.longest_retry_ms);
}

struct CallbackSender::Impl {
  /// How a running job gets on.
  struct News {
    std::optional<Job> latest{};
    TimeMs not_before = 0;
  };

  Impl(JobStore& jobs_in, CallbackBody body_in, Log& log_in, Metrics& metrics_in,
       SenderOptions options_in)
      : jobs(jobs_in),
        body(std::move(body_in)),
        log(log_in),
        metrics(metrics_in),
        options(std::move(options_in)) {}

  void hear(const Job& job) {
    const auto& subscriber = job.spec.subscriber;
    if (subscriber.empty()) return;
    {
      const std::scoped_lock lock(mutex);
      if (is_final(job.state)) {
        news.erase(job.id);
      } else if (job.state == JobState::Running && !subscriber.in_progress_uri.empty()) {
        news[job.id].latest = job;
      } else {
        return;
      }
      ++changes;
    }
    wake.notify_one();
  }

  std::optional<Job> next_news() {
    const std::scoped_lock lock(mutex);
    const auto now = now_ms();
    std::optional<Job> next;
    for (auto entry = news.begin(); entry != news.end();) {
      auto& [latest, not_before] = entry->second;
      const bool is_due = now >= not_before;
      if (is_due && latest && !next) {
        next = std::exchange(latest, std::nullopt);
        not_before = now + options.progress_interval_ms;
      } else if (is_due && !latest) {
        entry = news.erase(entry);
        continue;
      }
      ++entry;
    }
    return next;
  }

  Result<int> send(const Job& job, const std::stop_token& stop) {
    Message message{.uri = uri_for(job), .body = body(job), .headers = {}};
    // The same for every attempt: who has seen it may leave it out.
    message.headers.emplace_back("Idempotency-Key",
                                 is_final(job.state)
                                     ? fmt::format("\"{}-{}\"", job.id, to_string(job.state))
                                     : fmt::format("\"{}-{}\"", job.id, job.updated));
    if (!options.secret.empty())
      message.headers.emplace_back("Citymesh-Signature",
                                   signature(options.secret, now_ms() / 1000, message.body));
    return post(message, options.post, stop);
  }

  void tell(const Job& job, std::uint32_t attempt, bool is_last, const Result<int>& status) {
    metrics.callback(is_received(status) ? "delivered" : is_last ? "given_up" : "retried");
    if (is_received(status)) {
      log.info("callback_sent", {{"job_id", job.id},
                                 {"to", shown_uri(uri_for(job))},
                                 {"state", to_string(job.state)},
                                 {"attempt", attempt},
                                 {"trace_id", job.trace_id}});
      return;
    }
    log.warning("callback_failed", {{"job_id", job.id},
                                    {"to", shown_uri(uri_for(job))},
                                    {"state", to_string(job.state)},
                                    {"attempt", attempt},
                                    {"last", is_last},
                                    {"error", status ? fmt::format("the answer was {}", *status)
                                                     : status.error().message},
                                    {"trace_id", job.trace_id}});
  }

  /// False when nothing was due.
  bool send_next(const std::stop_token& stop) {
    const auto due = jobs.take_callback(
        now_ms(), [this](std::uint32_t attempt) { return retry_after(attempt, options); });
    if (!due) {
      log.error("callbacks_not_read", {{"error", due.error().message}});
      return false;
    }
    if (*due) {
      const auto& [job, attempt] = **due;
      const bool is_wanted = !uri_for(job).empty();
      const auto status = is_wanted ? send(job, stop) : Result<int>(200);
      if (is_wanted) tell(job, attempt, !retry_after(attempt, options), status);
      if (is_received(status))
        if (auto done = jobs.callback_done(job.id); !done)
          log.warning("callback_not_closed", {{"job_id", job.id}, {"error", done.error().message}});
      return true;
    }
    const auto job = next_news();
    if (job) tell(*job, 1, true, send(*job, stop));
    return job.has_value();
  }

  void work(const std::stop_token& stop) {
    std::uint64_t seen = 0;
    while (!stop.stop_requested()) {
      bool sent = false;
      try {
        sent = send_next(stop);
      } catch (const std::exception& error) {
        log.error("callback_error", {{"error", error.what()}});
      }
      if (sent) continue;
      std::unique_lock lock(mutex);
      wake.wait_for(lock, stop, std::chrono::milliseconds(options.poll_ms),
                    [&] { return changes != seen; });
      seen = changes;
    }
  }

  JobStore& jobs;
  CallbackBody body;
  Log& log;
  Metrics& metrics;
  SenderOptions options;

  std::mutex mutex;
  std::condition_variable_any wake;
  std::uint64_t changes = 0;
  std::map<std::string, News> news;  // by job id
  JobFeed::Subscription subscription;
  std::vector<std::jthread> threads;
};

CallbackSender::CallbackSender(JobStore& jobs, CallbackBody body, Log& log, Metrics& metrics,
                               SenderOptions options)
    : impl_(std::make_unique<Impl>(jobs, std::move(body), log, metrics, std::move(options))) {}

CallbackSender::~CallbackSender() { stop(); }

void CallbackSender::start() {
  auto& sender = *impl_;
  sender.subscription =
      sender.jobs.changes().subscribe([&sender](const Job& job) { sender.hear(job); });
  for (unsigned i = 0; i < std::max(1u, sender.options.threads); ++i)
    sender.threads.emplace_back([&sender](const std::stop_token& stop) { sender.work(stop); });
}

void CallbackSender::stop() {
  for (auto& thread : impl_->threads) thread.request_stop();
  impl_->threads.clear();
  impl_->subscription = {};
}

}  // namespace citymesh
