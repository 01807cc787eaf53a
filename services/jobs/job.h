#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// OGC API - Processes' states.
enum class JobState { Accepted, Running, Successful, Failed, Dismissed };

std::string_view to_string(JobState state);
std::optional<JobState> job_state_from(std::string_view name);
inline bool is_final(JobState state) {
  return state != JobState::Accepted && state != JobState::Running;
}

/// Milliseconds since 1970-01-01 UTC.
using TimeMs = std::int64_t;
TimeMs now_ms();

/// Whether a client's key for repeating a request can be kept. Errors: InvalidArgument.
Result<void> check_idempotency_key(std::string_view key);

/// A random UUID (version 4) from the kernel's generator.
std::string new_job_id();

enum class Transmission { Value, Reference };

/// Whom a job tells how it goes on (OGC's `subscriber`), by URI; empty: nobody.
struct Subscriber {
  std::string success_uri{};
  std::string in_progress_uri{};
  std::string failed_uri{};  ///< also when the job is dismissed
  std::string base{};        ///< of the links in what is told; no part of what was asked for

  bool empty() const {
    return success_uri.empty() && in_progress_uri.empty() && failed_uri.empty();
  }
  friend bool operator==(const Subscriber& a, const Subscriber& b) {
    return a.success_uri == b.success_uri && a.in_progress_uri == b.in_progress_uri &&
           a.failed_uri == b.failed_uri;
  }
};

/// What was asked for, in the one form that command line, REST and gRPC agree on.
struct JobSpec {
  std::string process{};
  std::string inputs_json{};                      ///< checked_inputs() of services/offer
  std::map<std::string, Transmission> outputs{};  ///< empty: `report` plus the formats
  bool response_document = false;                 ///< OGC `response`: raw (default) or document
  Subscriber subscriber{};
  friend bool operator==(const JobSpec&, const JobSpec&) = default;
};

struct JobProgress {
  std::string stage{};
  std::uint64_t done = 0;
  std::uint64_t total = 0;
};

/// A result file as listed in a finished job.
struct ResultFile {
  std::string output{};  ///< id of the output: `report`, `obj`, …
  std::string file_name{};
  std::string media_type{};
  std::uint64_t bytes = 0;
};

struct Job {
  std::string id{};  ///< UUID; unguessable
  JobSpec spec{};
  JobState state = JobState::Accepted;
  std::string message{};  ///< for people: stage and counts, or why it failed
  JobProgress progress{};
  int percent = 0;
  std::optional<Error> error{};  ///< when failed
  std::uint32_t attempt = 0;     ///< tries so far
  bool dismiss_requested = false;
  TimeMs created = 0;
  TimeMs updated = 0;  ///< grows with every change of the job
  std::optional<TimeMs> started{}, finished{};
  std::vector<ResultFile> results{};  ///< when successful
  /// By which its client knows the request again when it repeats it; empty: never. No two jobs of
  /// one owner have the same.
  std::string idempotency_key{};
  std::string owner{};     ///< the client it belongs to; empty: nobody in particular
  std::string trace_id{};  ///< of the request that made it, for the log
  /// By which a later job that would give the same files finds the results; empty: never.
  std::string cache_key{};
  bool cached = false;  ///< the results are those of an earlier job
};

struct JobFilter {
  std::vector<std::string> processes{};
  std::vector<JobState> states{};
  std::optional<std::string> owner{};  ///< nothing: of all
  std::uint32_t limit = 100;
  std::uint32_t offset = 0;
};

}  // namespace citymesh
