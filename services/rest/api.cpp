#include "services/rest/api.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>

#include "services/offer/offer.h"
#include "services/rest/answers.h"
#include "services/rest/documents.h"
#include "services/rest/job_query.h"
#include "services/rest/links.h"
#include "services/rest/openapi.h"
#include "services/rest/origin.h"
#include "services/rest/pages.h"
#include "services/rest/problem.h"
#include "services/rest/processes.h"
#include "services/telemetry/log.h"
#include "services/telemetry/trace.h"

namespace citymesh {
namespace {

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

Response unexpected(const std::exception& error, const Request& request) {
  return problem_response(problem_kind(ErrorCode::Internal),
                          fmt::format("unexpected: {}", error.what()),
                          request.headers.get("Accept"));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

const Api::Route Api::kRoutes[] = {
    {"GET", "/", &Api::landing},
    {"GET", "/api", &Api::api_definition},
    {"GET", "/openapi.json", &Api::api_definition},
    {"GET", "/conformance", &Api::conformance},
    {"GET", "/processes", &Api::process_list},
    {"GET", "/processes/{id}", &Api::process},
    {"POST", "/processes/{id}/execution", &Api::execute, Role::Submit},
    {"GET", "/jobs", &Api::job_list, Role::ReadOwn},
    {"GET", "/jobs/{id}", &Api::job, Role::ReadOwn},
    {"DELETE", "/jobs/{id}", &Api::dismiss, Role::Submit},
    {"GET", "/jobs/{id}/events", &Api::events, Role::ReadOwn},
    {"GET", "/jobs/{id}/results", &Api::results, Role::ReadOwn},
    {"GET", "/jobs/{id}/results/{output}", &Api::result, Role::ReadOwn},
    {"GET", "/healthz", &Api::healthz},
    {"GET", "/readyz", &Api::readyz},
    {"GET", "/metrics", &Api::metrics, Role::ReadOwn},
};

Api::Api(JobManager& jobs, Metrics& metrics, ApiOptions options)
    : jobs_(jobs),
      metrics_(metrics),
      options_(std::move(options)),
      cors_(options_.cors_allow_origin) {
  while (options_.public_url.ends_with('/')) options_.public_url.pop_back();
}

Response Api::handle(const Request& request) const {
  Record record{.method = request.method,
                .trace_id = trace_id_of(request.headers.get("traceparent"))};
  Response response;
  try {
    response = dispatch(request, record);
  } catch (const std::exception& error) {
    response = unexpected(error, request);
  }
  add_common_headers(request, response);
  if (!response.follow || response.follow->streams) {
    tell(record, response.status);
    return response;
  }
  // What had to wait gets the same finish when it comes.
  const auto bare =
      std::make_shared<const Request>(Request{request.method, request.target, request.headers, {}});
  response.follow->step = [this, bare, record = std::move(record),
                           step = std::move(response.follow->step)](bool last) {
    FollowStep next;
    try {
      next = step(last);
    } catch (const std::exception& error) {
      next = {{}, std::make_shared<Response>(unexpected(error, *bare)), true};
    }
    if (next.answer) {
      add_common_headers(*bare, *next.answer);
      tell(record, next.answer->status);
    }
    return next;
  };
  return response;
}

void Api::tell(const Record& record, int status) const {
  const bool is_known = std::ranges::any_of(
      kRoutes, [&](const Route& known) { return known.method == record.method; });
  std::string_view method = "other";
  if (is_known || record.method == "HEAD" || record.method == "OPTIONS") method = record.method;
  const auto seconds = seconds_since(record.start);
  metrics_.http_request(method, record.route, status, seconds);
  if (options_.log != nullptr)
    options_.log->debug("request", {{"method", method},
                                    {"route", record.route},
                                    {"status", status},
                                    {"seconds", seconds},
                                    {"trace_id", record.trace_id}});
}

Response Api::dispatch(const Request& request, Record& record) const {
  const auto accept = request.headers.get("Accept");
  auto target = parse_target(request.target);
  if (!target)
    return problem_response(problem_kind(target.error().code), target.error().message, accept);
  const auto origin = origin_of(request, options_.access->trusted_proxies(), options_.public_url);
  if (!origin)
    return problem_response(problem_kind(origin.error().code), origin.error().message, accept);
  if (const auto f = target->query.find("f");
      f != target->query.end() && f->second != "html" && f->second != "json")
    return problem_response(
        problems::kInvalidQuery,
        fmt::format("query parameter `f` is '{}', expected html or json", f->second), accept);

  Call call{request,
            request.method == "HEAD" ? "GET" : request.method,
            *std::move(target),
            origin->base,
            {},
            accept,
            record.trace_id};
  std::string allowed;
  for (const auto& candidate : kRoutes) {
    auto values = match(candidate.pattern, call.target.segments);
    if (!values) continue;
    record.route = candidate.pattern;
    if (candidate.method == call.method) {
      if (auto refused = refusal(candidate, origin->client, call)) return *std::move(refused);
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
    cors_.allow_sending(request.headers, allowed, response.headers);
  } else {
    response = problem_response(
        problems::kMethodNotAllowed,
        fmt::format("method {} is not possible here, expected one of {}", request.method, allowed),
        accept);
  }
  response.headers.set("Allow", allowed);
  return response;
}

/// Finds out whose call it is; the answer when that client may not make it.
std::optional<Response> Api::refusal(const Route& route, const std::string& address,
                                     Call& call) const {
  if (route.method != "GET" && !cors_.may_change(call.request.headers, call.base))
    return problem_response(
        problem_kind(ErrorCode::PermissionDenied),
        fmt::format("a page of '{}' may not do this, expected one of the origins that "
                    "--cors_allow_origin names",
                    call.request.headers.get("Origin")),
        call.accept);
  if (route.needs == Role::None) return std::nullopt;
  const auto& headers = call.request.headers;
  auto client =
      options_.access->identify({headers.get("Authorization"), headers.get("X-API-Key"), address});
  const bool shown = !client || !client->name.empty() || !options_.access->is_required();
  if (!client || !shown) {
    auto answer = problem_response(
        problems::kUnauthorized,
        client ? "this needs an API key or a token, expected `Authorization: Bearer …` or (API "
                 "key) `X-API-Key: …`"
               : client.error().message,
        call.accept);
    answer.headers.set("WWW-Authenticate",
                       client ? R"(Bearer realm="citymesh")"
                              : R"(Bearer realm="citymesh", error="invalid_token")");
    return answer;
  }
  if (const auto allowed = require(*client, route.needs); !allowed)
    return problem_response(problem_kind(allowed.error().code), allowed.error().message,
                            call.accept);
  call.client = *std::move(client);
  return std::nullopt;
}

void Api::add_common_headers(const Request& request, Response& response) const {
  auto& headers = response.headers;
  headers.set("X-Content-Type-Options", "nosniff");
  headers.add("Vary", "Accept");
  // States and lists change from one moment to the next.
  if (!headers.has("Cache-Control")) headers.set("Cache-Control", "no-store");
  cors_.allow_reading(request.headers, headers);
}

Response Api::landing(const Call& call) const {
  if (wants_page(call.accept, call.target.query))
    return page_response(200, landing_page(call.base), landing_json(call.base));
  return json_response(landing_json(call.base));
}

Response Api::conformance(const Call& call) const {
  if (wants_page(call.accept, call.target.query))
    return page_response(200, conformance_page(call.base, conformance_json()));
  return json_response(conformance_json());
}

Response Api::api_definition(const Call& call) const {
  const bool secured = options_.access->is_required();
  auto document = openapi_json(call.base, secured ? &Api::is_open : nullptr);
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
  auto document = process_list_json(call.base, *limit, *offset);
  if (wants_page(call.accept, query))
    return page_response(200, process_list_page(call.base), document);
  return json_response(std::move(document));
}

Response Api::process(const Call& call) const {
  const auto* process = find_offered(call.values[0]);
  if (process == nullptr) return no_such_process(call.values[0], call.accept);
  auto document = process_description_json(call.base, *process);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, process_page(call.base, *process), document);
  return json_response(std::move(document));
}

bool Api::is_open(std::string_view method, std::string_view path) {
  const auto target = parse_target(path);
  for (const auto& route : kRoutes)
    if (target && equal_without_case(route.method, method) &&
        match(route.pattern, target->segments))
      return route.needs == Role::None;
  return false;
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
