#include "services/rest/api.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>

#include "core/pipeline/pipeline.h"
#include "services/rest/documents.h"
#include "services/rest/execute.h"
#include "services/rest/job_query.h"
#include "services/rest/links.h"
#include "services/rest/openapi.h"
#include "services/rest/pages.h"
#include "services/rest/problem.h"
#include "services/rest/processes.h"
#include "services/rest/results.h"

namespace citymesh {
namespace {

constexpr std::string_view kJson = "application/json";
constexpr std::string_view kAllowedHeaders =
    "Accept, Authorization, Content-Type, Idempotency-Key, If-None-Match, Prefer, Range";
constexpr std::string_view kExposedHeaders =
    "Location, Link, Preference-Applied, Content-Disposition, Retry-After";

/// Matches `/jobs/{id}` against segments; the values of the braces, or nothing.
std::optional<std::vector<std::string>> match(std::string_view pattern,
                                              const std::vector<std::string>& segments) {
  std::vector<std::string> values;
  std::size_t index = 0;
  for (std::size_t begin = 1; begin < pattern.size(); ++index) {
    const auto end = std::min(pattern.find('/', begin), pattern.size());
    const auto part = pattern.substr(begin, end - begin);
    if (index >= segments.size()) return std::nullopt;
    if (part.starts_with('{'))
      values.push_back(segments[index]);
    else if (part != segments[index])
      return std::nullopt;
    begin = end + 1;
  }
  if (index != segments.size()) return std::nullopt;
  return values;
}

bool wants_page(std::string_view accept, const std::map<std::string, std::string>& query) {
  if (const auto f = query.find("f"); f != query.end()) return f->second == "html";
  const double page = accept_quality(accept, "text/html");
  return accept_names(accept, "text/html") && page > 0 && page >= accept_quality(accept, kJson);
}

Response json_response(std::string body, int status = 200) {
  return text_response(status, kJson, std::move(body));
}

bool is_json(std::string_view content_type) {
  const auto type = media_type_of(content_type);
  return type.empty() || type == kJson || type.ends_with("+json");
}

/// Job ids are UUIDs; anything else is no job, whatever it tries to be.
bool is_job_id(std::string_view id) {
  return id.size() == 36 && std::ranges::all_of(id, [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || c == '-';
         });
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

const Api::Route Api::kRoutes[] = {
    {"GET", "/", &Api::landing},
    {"GET", "/api", &Api::api_definition},
    {"GET", "/conformance", &Api::conformance},
    {"GET", "/processes", &Api::process_list},
    {"GET", "/processes/{id}", &Api::process},
    {"POST", "/processes/{id}/execution", &Api::execute},
    {"GET", "/jobs", &Api::job_list},
    {"GET", "/jobs/{id}", &Api::job},
    {"DELETE", "/jobs/{id}", &Api::dismiss},
    {"GET", "/jobs/{id}/results", &Api::results},
    {"GET", "/jobs/{id}/results/{output}", &Api::result},
    {"GET", "/healthz", &Api::healthz},
    {"GET", "/readyz", &Api::readyz},
    {"GET", "/metrics", &Api::metrics},
};

Api::Api(JobManager& jobs, Metrics& metrics, ApiOptions options)
    : jobs_(jobs), metrics_(metrics), options_(std::move(options)) {
  while (options_.public_url.ends_with('/')) options_.public_url.pop_back();
}

Response Api::handle(const Request& request) const {
  const auto start = std::chrono::steady_clock::now();
  std::string_view route = "none";
  Response response;
  try {
    response = dispatch(request, route);
  } catch (const std::exception& error) {
    response = problem_response(problem_kind(ErrorCode::Internal),
                                fmt::format("unexpected: {}", error.what()),
                                request.headers.get("Accept"));
  }
  add_common_headers(request, response);
  const bool known_method = std::ranges::any_of(
      kRoutes, [&](const Route& known) { return known.method == request.method; });
  metrics_.http_request(known_method || request.method == "HEAD" || request.method == "OPTIONS"
                            ? request.method
                            : "other",
                        route, response.status, seconds_since(start));
  return response;
}

Response Api::dispatch(const Request& request, std::string_view& route) const {
  const auto accept = request.headers.get("Accept");
  auto target = parse_target(request.target);
  if (!target)
    return problem_response(problem_kind(target.error().code), target.error().message, accept);
  auto base = base_url(request);
  if (!base) return problem_response(problem_kind(base.error().code), base.error().message, accept);
  if (const auto f = target->query.find("f");
      f != target->query.end() && f->second != "html" && f->second != "json")
    return problem_response(
        problems::kInvalidQuery,
        fmt::format("query parameter `f` is '{}', expected html or json", f->second), accept);

  Call call{request,
            request.method == "HEAD" ? "GET" : request.method,
            *std::move(target),
            *std::move(base),
            {},
            accept};
  std::string allowed;
  for (const auto& candidate : kRoutes) {
    auto values = match(candidate.pattern, call.target.segments);
    if (!values) continue;
    route = candidate.pattern;
    if (candidate.method == call.method) {
      call.values = *std::move(values);
      return (this->*candidate.handler)(call);
    }
    allowed += fmt::format("{}{}, ", candidate.method, candidate.method == "GET" ? ", HEAD" : "");
  }
  if (allowed.empty())
    return problem_response(
        problems::kNoSuchResource,
        fmt::format("there is no resource '{}'; begin at {}/", request.target, call.base), accept);
  allowed += "OPTIONS";
  Response response;
  if (call.method == "OPTIONS") {
    response.status = 204;
    response.headers.set("Access-Control-Allow-Methods", allowed);
    response.headers.set("Access-Control-Allow-Headers", std::string(kAllowedHeaders));
    response.headers.set("Access-Control-Max-Age", "86400");
  } else {
    response = problem_response(
        problems::kMethodNotAllowed,
        fmt::format("method {} is not possible here, expected one of {}", request.method, allowed),
        accept);
  }
  response.headers.set("Allow", allowed);
  return response;
}

Result<std::string> Api::base_url(const Request& request) const {
  if (!options_.public_url.empty()) return options_.public_url;
  const auto host = request.headers.get("Host");
  if (!is_valid_host(host))
    return fail(ErrorCode::InvalidArgument, "the Host header is missing or no host name");
  return "http://" + host;
}

void Api::add_common_headers(const Request& request, Response& response) const {
  auto& headers = response.headers;
  headers.set("X-Content-Type-Options", "nosniff");
  headers.add("Vary", "Accept");
  // States and lists change from one moment to the next.
  if (!headers.has("Cache-Control")) headers.set("Cache-Control", "no-store");
  if (options_.cors_allow_origin.empty() || !request.headers.has("Origin")) return;
  headers.set("Access-Control-Allow-Origin", options_.cors_allow_origin);
  headers.set("Access-Control-Expose-Headers", std::string(kExposedHeaders));
}

Response Api::landing(const Call& call) const {
  if (wants_page(call.accept, call.target.query))
    return page_response(200, landing_page(call.base));
  return json_response(landing_json(call.base));
}

Response Api::conformance(const Call& call) const {
  if (wants_page(call.accept, call.target.query))
    return page_response(200, conformance_page(call.base, conformance_json()));
  return json_response(conformance_json());
}

Response Api::api_definition(const Call& call) const {
  auto document = openapi_json(call.base);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, api_page(call.base, document));
  return text_response(200, kOpenApiMediaType, std::move(document));
}

Response Api::process_list(const Call& call) const {
  constexpr std::uint32_t kMaxLimit = 1000;
  const auto& query = call.target.query;
  const auto known = check_parameters(query, {"limit", "offset"});
  const auto limit = whole_number(query, "limit", kMaxLimit, 1, kMaxLimit);
  const auto offset = whole_number(query, "offset", 0, 0, kMaxLimit);
  if (!known || !limit || !offset)
    return problem_response(problems::kInvalidQuery,
                            !known   ? known.error().message
                            : !limit ? limit.error().message
                                     : offset.error().message,
                            call.accept);
  if (wants_page(call.accept, query)) return page_response(200, process_list_page(call.base));
  return json_response(process_list_json(call.base, *limit, *offset));
}

namespace {

Response no_such_process(std::string_view id, std::string_view accept) {
  return problem_response(
      problems::kNoSuchProcess,
      fmt::format("process '{}' does not exist; available: {}", id, process_ids()), accept);
}

}  // namespace

Response Api::process(const Call& call) const {
  const auto* process = find_process(call.values[0]);
  if (process == nullptr) return no_such_process(call.values[0], call.accept);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, process_page(call.base, *process));
  return json_response(process_description_json(call.base, *process));
}

Response Api::execute(const Call& call) const {
  const auto* process = find_process(call.values[0]);
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
  const auto job = jobs_.submit(*std::move(spec));
  if (!job)
    return problem_response(problem_kind(job.error().code), job.error().message, call.accept);

  auto response = json_response(status_json(call.base, *job), 201);
  response.headers.set("Location", job_url(call.base, *job));
  if (prefers(call.request.headers.get("Prefer"), "respond-async"))
    response.headers.set("Preference-Applied", "respond-async");
  return response;
}

Response Api::job_list(const Call& call) const {
  auto query = parse_job_query(call.target.query);
  if (!query) return problem_response(problems::kInvalidQuery, query.error().message, call.accept);

  // The store selects by process and state; what it cannot select by is left out here. The next
  // page begins behind the last job looked at, so pages neither overlap nor leave gaps.
  const auto wanted = query->filter.limit;
  const auto now = now_ms();
  std::vector<Job> jobs;
  bool more = false;
  for (bool end = false; !end && !more;) {
    auto batch = jobs_.list(query->filter);
    if (!batch)
      return problem_response(problem_kind(batch.error().code), batch.error().message, call.accept);
    end = batch->size() < query->filter.limit;
    for (auto& job : *batch) {
      if (jobs.size() == wanted) {
        more = true;
        break;
      }
      ++query->filter.offset;
      if (selects(*query, job, now)) jobs.push_back(std::move(job));
    }
  }

  const auto url = [&](const std::string& offset) {
    auto parameters = call.target.query;
    parameters.erase("f");
    if (!offset.empty()) parameters["offset"] = offset;
    std::string text = call.base + "/jobs";
    char separator = '?';
    for (const auto& [name, value] : parameters) {
      text += fmt::format("{}{}={}", separator, name, encode_segment(value));
      separator = '&';
    }
    return text;
  };
  const auto next = more ? url(std::to_string(query->filter.offset)) : std::string{};
  if (wants_page(call.accept, call.target.query))
    return page_response(200, job_list_page(call.base, jobs, next));
  return json_response(job_list_json(call.base, jobs, url({}), next));
}

Result<Job> Api::find_job(const Call& call) const {
  const auto& id = call.values[0];
  if (!is_job_id(id))
    return fail(ErrorCode::NotFound,
                fmt::format("job '{}' does not exist; expected the id of a job", id));
  return jobs_.get(id);
}

Response Api::job_error(const Call& call, const Error& error) const {
  const auto& kind =
      error.code == ErrorCode::NotFound ? problems::kNoSuchJob : problem_kind(error.code);
  return problem_response(kind, error.message, call.accept);
}

Response Api::job(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(call, job.error());
  if (wants_page(call.accept, call.target.query))
    return page_response(200, job_page(call.base, *job));
  return json_response(status_json(call.base, *job));
}

Response Api::dismiss(const Call& call) const {
  if (const auto found = find_job(call); !found) return job_error(call, found.error());
  auto job = jobs_.dismiss(call.values[0]);
  if (!job) return job_error(call, job.error());
  if (is_final(job->state) && job->state != JobState::Dismissed)
    return problem_response(problems::kJobIsFinal,
                            fmt::format("job {} is {} and cannot be dismissed any more", job->id,
                                        to_string(job->state)),
                            call.accept);
  return json_response(status_json(call.base, *job));
}

Response Api::not_successful(const Call& call, const Job& job) const {
  switch (job.state) {
    case JobState::Failed: {
      const auto error = job.error.value_or(Error{ErrorCode::Internal, job.message});
      return problem_response(failed_job_kind(error.code), error.message, call.accept,
                              job_url(call.base, job));
    }
    case JobState::Dismissed:
      return problem_response(problems::kResultNotAvailable,
                              fmt::format("job {} was dismissed and has no results", job.id),
                              call.accept);
    default:
      return problem_response(
          problems::kResultNotReady,
          fmt::format("job {} is {}; its results are there once it is successful", job.id,
                      to_string(job.state)),
          call.accept);
  }
}

Response Api::results(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(call, job.error());
  if (job->state != JobState::Successful) return not_successful(call, *job);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, job_page(call.base, *job));
  return results_response(jobs_, *job, call.base, call.accept, options_.max_inline_bytes);
}

Response Api::result(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(call, job.error());
  if (job->state != JobState::Successful) return not_successful(call, *job);
  const auto* file = find_result(*job, call.values[1]);
  if (file == nullptr) {
    std::vector<std::string_view> names;
    for (const auto& result : job->results) names.push_back(result.file_name);
    return problem_response(problems::kNoSuchOutput,
                            fmt::format("job {} has no output '{}'; available: {}", job->id,
                                        call.values[1], fmt::join(names, ", ")),
                            call.accept);
  }
  return file_response(jobs_, *job, *file);
}

Response Api::healthz(const Call&) const { return text_response(200, "text/plain", "ok\n"); }

Response Api::readyz(const Call& call) const {
  const auto reachable = jobs_.list({.limit = 1});
  if (reachable) return text_response(200, "text/plain", "ready\n");
  return problem_response(problem_kind(ErrorCode::Unavailable),
                          "the job store does not answer: " + reachable.error().message,
                          call.accept);
}

Response Api::metrics(const Call&) const {
  return text_response(200, "text/plain; version=0.0.4; charset=utf-8", metrics_.text());
}

}  // namespace citymesh
