#include "services/rest/documents.h"

#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "core/base/version.h"
#include "services/jobs/retention.h"
#include "services/rest/links.h"
#include "services/rest/message.h"
#include "services/rest/problem.h"

namespace citymesh {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kJson = "application/json";
constexpr std::string_view kHtml = "text/html";

Json job_links(std::string_view base, const Job& job) {
  const auto self = job_url(base, job);
  Json links = {link_json<Json>(self, "self", kJson, "Status of this job"),
                link_json<Json>(self, "monitor", kJson, "Status of this job"),
                link_json<Json>(self, "alternate", kHtml, "This job as a page"),
                link_json<Json>(self + "/events", "alternate", "text/event-stream",
                                "Changes of this job as they come"),
                link_json<Json>(fmt::format("{}/jobs", base), "up", kJson, "Jobs")};
  if (job.state == JobState::Failed)
    links.push_back(link_json<Json>(self + "/results", rel::kExceptions, "application/problem+json",
                                    "Why the job failed"));
  if (job.state != JobState::Successful || has_expired(job)) return links;
  links.push_back(link_json<Json>(self + "/results", rel::kResults, kJson, "Results"));
  for (const auto& file : job.results) {
    auto link =
        link_json<Json>(result_url(base, job, file), "item", file.media_type, file.file_name);
    link["length"] = file.bytes;
    links.push_back(std::move(link));
  }
  return links;
}

Json status_document(std::string_view base, const Job& job) {
  Json status = {
      {"processID", job.spec.process},  {"type", "process"},      {"jobID", job.id},
      {"status", to_string(job.state)}, {"message", job.message}, {"progress", job.percent},
      {"created", rfc3339(job.created)}};
  if (job.started) status["started"] = rfc3339(*job.started);
  if (job.finished) status["finished"] = rfc3339(*job.finished);
  status["updated"] = rfc3339(job.updated);
  if (!job.progress.stage.empty() && job.state != JobState::Successful)
    status["stage"] = job.progress.stage;
  if (job.progress.total > 0) {
    status["done"] = job.progress.done;
    status["total"] = job.progress.total;
  }
  if (job.cached) status["cached"] = true;
  if (job.state == JobState::Failed) {
    const auto error = job.error.value_or(Error{ErrorCode::Internal, job.message});
    status["exception"] = Json::parse(problem_json(failed_job_kind(error.code), error.message));
  }
  status["links"] = job_links(base, job);
  return status;
}

}  // namespace

std::string rfc3339(TimeMs time) {
  const std::time_t seconds = static_cast<std::time_t>(time / 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900,
                     utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, time % 1000);
}

std::string job_url(std::string_view base, const Job& job) {
  return fmt::format("{}/jobs/{}", base, job.id);
}

std::string result_url(std::string_view base, const Job& job, const ResultFile& file) {
  return fmt::format("{}/results/{}", job_url(base, job), encode_segment(file.file_name));
}

std::string landing_json(std::string_view base) {
  const auto at = [&](std::string_view path) { return fmt::format("{}{}", base, path); };
  return dump(
      Json{{"title", "citymesh"},
           {"description",
            "Turns 3D city models into closed, 2-manifold, simulation-ready meshes (OGC API - "
            "Processes)."},
           {"version", version()},
           {"links",
            {link_json<Json>(at("/"), "self", kJson, "This document"),
             link_json<Json>(at("/"), "alternate", kHtml, "This document as a page"),
             link_json<Json>(at("/api"), "service-desc", kOpenApiMediaType, "API definition"),
             link_json<Json>(at("/api?f=html"), "service-doc", kHtml, "API documentation"),
             link_json<Json>(at("/conformance"), rel::kConformance, kJson, "Conformance classes"),
             link_json<Json>(at("/processes"), rel::kProcesses, kJson, "Processes"),
             link_json<Json>(at("/jobs"), rel::kJobList, kJson, "Jobs")}}});
}

std::string conformance_json() {
  Json classes = Json::array();
  for (const auto* name : {"core", "ogc-process-description", "json", "html", "oas30", "job-list",
                           "callback", "dismiss"})
    classes.push_back(
        fmt::format("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/{}", name));
  return dump(Json{{"conformsTo", std::move(classes)}});
}

std::string status_json(std::string_view base, const Job& job) {
  return dump(status_document(base, job));
}

std::string job_list_json(std::string_view base, const std::vector<Job>& jobs,
                          std::string_view self, std::string_view next) {
  Json list = Json::array();
  for (const auto& job : jobs) list.push_back(status_document(base, job));
  Json links = {
      link_json<Json>(self, "self", kJson, "Jobs"),
      link_json<Json>(fmt::format("{}/jobs", base), "alternate", kHtml, "Jobs as a page")};
  if (!next.empty()) links.push_back(link_json<Json>(next, "next", kJson, "Next page"));
  return dump(Json{{"jobs", std::move(list)}, {"links", std::move(links)}});
}

}  // namespace citymesh
