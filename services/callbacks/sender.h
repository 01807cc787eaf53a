#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "services/callbacks/post.h"
#include "services/jobs/stores.h"

namespace citymesh {

class Log;
class Metrics;

struct SenderOptions {
  PostOptions post{};
  std::string secret{};  ///< signs messages; empty: they are not signed
  unsigned threads = 4;
  std::uint32_t max_attempts = 8;       ///< the last one some three hours after the first
  TimeMs first_retry_ms = 10'000;       ///< four times as long after each failure,
  TimeMs longest_retry_ms = 3'600'000;  ///< up to this
  TimeMs progress_interval_ms = 5'000;  ///< between two messages about the progress of a job
  TimeMs poll_ms = 1'000;  ///< how often it looks for what is due, beside what it is told
};

/// When a message whose `attempt` (1 for the first) is being made is due again if that fails;
/// nothing: it was the last one.
std::optional<TimeMs> retry_after(std::uint32_t attempt, const SenderOptions& options);

/// What the subscriber of a job is told: the results of a successful one, else its status.
using CallbackBody = std::function<std::string(const Job&)>;

/// Tells the subscribers of jobs what becomes of them. That a job has ended is told again until a
/// status of 2xx comes back, also after a restart; two may hear it twice, none not at all while it
/// can be reached. How a job gets on is told once, and only the latest. What it refers to must
/// outlive it.
class CallbackSender {
 public:
  CallbackSender(JobStore& jobs, CallbackBody body, Log& log, Metrics& metrics,
                 SenderOptions options);
  ~CallbackSender();  ///< stops
  CallbackSender(const CallbackSender&) = delete;
  CallbackSender& operator=(const CallbackSender&) = delete;

  void start();
  /// What is being sent is given up and due again later.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
