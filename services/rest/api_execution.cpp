#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "services/offer/offer.h"
#include "services/rest/answers.h"
#include "services/rest/api.h"
#include "services/rest/documents.h"
#include "services/rest/execute.h"
#include "services/rest/problem.h"
#include "services/rest/results.h"
#include "services/telemetry/log.h"

namespace citymesh {
namespace {

/// How an execution is answered, and what `Preference-Applied` then says.
struct Mode {
  double wait_s = 0;  ///< 0: at once, with a job
  std::string applied_to_results{};
  std::string applied_to_job{};
};

/// OGC API - Processes 1.0, 7.11.2.3: without a preference a process that can is executed
/// synchronously; `respond-async` and `wait` are those of RFC 7240.
Mode mode_of(const ProcessSpec& process, std::string_view prefer, double longest_wait_s) {
  const bool async = prefers(prefer, "respond-async");
  Mode mode;
  if (async) mode.applied_to_job = "respond-async";
  if (process.async_only) return mode;

  std::uint32_t seconds = 0;
  const auto wait = preference_value(prefer, "wait").value_or("");
  const auto parsed = std::from_chars(wait.data(), wait.data() + wait.size(), seconds);
  const bool stated =
      !wait.empty() && parsed.ec == std::errc{} && parsed.ptr == wait.data() + wait.size();
  if (!stated) {
    mode.wait_s = async ? 0 : longest_wait_s;
    return mode;
  }
  mode.wait_s = std::min<double>(seconds, longest_wait_s);
  if (seconds <= longest_wait_s) mode.applied_to_results = fmt::format("wait={}", seconds);
  if (!async) mode.applied_to_job = mode.applied_to_results;
  return mode;
}

bool is_json(std::string_view content_type) {
  const auto type = media_type_of(content_type);
  return type.empty() || type == "application/json" || type.ends_with("+json");
}

/// The key of a request that its client may send again
/// (draft-ietf-httpapi-idempotency-key-header): a quoted text; quotes may be left out. Empty: none.
Result<std::string> idempotency_key(const Headers& headers) {
  constexpr std::string_view kName = "Idempotency-Key";
  if (!headers.has(kName)) return std::string{};
  const auto header = headers.get(kName);
  std::string_view key = header;
  if (key.size() > 1 && key.starts_with('"') && key.ends_with('"'))
    key = key.substr(1, key.size() - 2);
  if (auto checked = check_idempotency_key(key); !checked)
    return fail(checked.error().code, fmt::format("{}: {}", kName, checked.error().message));
  return std::string(key);
}

Response accepted(std::string_view base, const Job& job, const std::string& preference) {
  auto response = json_response(status_json(base, job), 201);
  response.headers.set("Location", job_url(base, job));
  if (!preference.empty()) response.headers.set("Preference-Applied", preference);
  return response;
}

}  // namespace

Response Api::estimate(const Call& call, const AskedJob& asked) const {
  const auto expected = jobs_.estimate(asked);
  if (!expected)
    return problem_response(problem_kind(expected.error().code), expected.error().message,
                            call.accept);
  return json_response(to_json(*expected));
}

Response Api::execute(const Call& call) const {
  const auto* process = find_offered(call.values[0]);
  if (process == nullptr) return no_such_process(call.values[0], call.accept);
  const auto content_type = call.request.headers.get("Content-Type");
  if (!is_json(content_type))
    return problem_response(
        problems::kUnsupportedMediaType,
        fmt::format("the Content-Type is '{}', expected application/json", content_type),
        call.accept);

  auto spec = decode_execute(*process, call.request.body);
  if (!spec)
    return problem_response(problem_kind(spec.error().code), spec.error().message, call.accept);
  spec->subscriber.base = call.base;
  auto asked = jobs_.check(*std::move(spec));
  if (!asked)
    return problem_response(problem_kind(asked.error().code), asked.error().message, call.accept);
  if (asked->only_estimate) return estimate(call, *asked);
  if (asked->write_back)
    if (const auto allowed = require(call.client, Role::WriteBack); !allowed)
      return problem_response(problem_kind(allowed.error().code), allowed.error().message,
                              call.accept);
  const auto key = idempotency_key(call.request.headers);
  if (!key)
    return problem_response(problem_kind(key.error().code), key.error().message, call.accept);
  const auto job = jobs_.accept(*std::move(asked), *key, call.client.name, call.trace_id);
  if (!job)
    return problem_response(job.error().code == ErrorCode::AlreadyExists
                                ? problems::kIdempotencyKeyUsed
                                : problem_kind(job.error().code),
                            job.error().message, call.accept);

  if (options_.log != nullptr)
    options_.log->info("job_accepted", {{"job_id", job->id},
                                        {"process", process->id},
                                        {"owner", job->owner},
                                        {"trace_id", call.trace_id}});

  auto mode = mode_of(*process, call.request.headers.get("Prefer"), options_.sync_wait_s);
  if (mode.wait_s <= 0) return accepted(call.base, *job, mode.applied_to_job);

  Follow follow;
  follow.job_id = job->id;
  follow.longest_s = mode.wait_s;
  follow.step = [this, id = job->id, base = call.base, accept = call.accept,
                 mode = std::move(mode)](bool last) {
    const auto now = jobs_.get(id);
    if (now && !is_final(now->state) && !last) return FollowStep{};
    Response answer;
    if (!now) {
      answer = job_error(now.error(), accept);
    } else if (!is_final(now->state)) {
      answer = accepted(base, *now, mode.applied_to_job);
    } else if (auto without = without_results(*now, base, accept)) {
      answer = *std::move(without);
    } else {
      answer = values_response(jobs_, *now, base, accept, options_.max_inline_bytes);
      if (!mode.applied_to_results.empty())
        answer.headers.set("Preference-Applied", mode.applied_to_results);
      // No `Link`: clients take any in an answer of 200 for the monitor, brackets included.
      answer.headers.set("Content-Location", job_url(base, *now) + "/results");
    }
    return FollowStep{{}, std::make_shared<Response>(std::move(answer)), true};
  };
  // Without a key nobody can come back to the job.
  if (key->empty())
    follow.client_left = [this, id = job->id] { (void)jobs_.request_dismissal(id); };
  Response response;
  response.follow = std::move(follow);
  return response;
}

}  // namespace citymesh
