#include <fmt/format.h>

#include <algorithm>

#include "services/rest/answers.h"
#include "services/rest/api.h"
#include "services/rest/conditional.h"
#include "services/rest/documents.h"
#include "services/rest/job_query.h"
#include "services/rest/pages.h"
#include "services/rest/problem.h"
#include "services/rest/results.h"

namespace citymesh {
namespace {

/// Job ids are UUIDs; anything else is no job, whatever it tries to be.
bool is_job_id(std::string_view id) {
  return id.size() == 36 && std::ranges::all_of(id, [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || c == '-';
         });
}

}  // namespace

Response Api::job_list(const Call& call) const {
  auto query = parse_job_query(call.target.query);
  if (!query) return problem_response(problems::kInvalidQuery, query.error().message, call.accept);

  if (call.client.role != Role::Admin) query->filter.owner = call.client.name;
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
    return page_response(200, job_list_page(call.base, jobs, next),
                         job_list_json(call.base, jobs, url({}), next));
  return json_response(job_list_json(call.base, jobs, url({}), next));
}

/// A job that the client may not see does not exist for it.
Result<Job> Api::find_job(const Call& call) const {
  const auto& id = call.values[0];
  if (!is_job_id(id))
    return fail(ErrorCode::NotFound,
                fmt::format("job '{}' does not exist; expected the id of a job", id));
  auto job = jobs_.get(id);
  if (job && !may_see(call.client, job->owner))
    return fail(ErrorCode::NotFound, fmt::format("job '{}' does not exist", id));
  return job;
}

Response Api::status_response(const Call& call, const Job& job) const {
  auto status = status_json(call.base, job);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, job_page(call.base, job), status);
  return json_response(std::move(status));
}

Response Api::job(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(job.error(), call.accept);
  return status_response(call, *job);
}

Response Api::dismiss(const Call& call) const {
  if (const auto found = find_job(call); !found) return job_error(found.error(), call.accept);
  auto job = jobs_.dismiss(call.values[0]);
  if (!job) return job_error(job.error(), call.accept);
  if (is_final(job->state) && job->state != JobState::Dismissed)
    return problem_response(problems::kJobIsFinal,
                            fmt::format("job {} is {} and cannot be dismissed any more", job->id,
                                        to_string(job->state)),
                            call.accept);
  return status_response(call, *job);
}

Response Api::results(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(job.error(), call.accept);
  if (auto answer = without_results(*job, call.base, call.accept)) return *std::move(answer);
  if (wants_page(call.accept, call.target.query))
    return page_response(200, job_page(call.base, *job), result_links_json(call.base, *job));
  return conditional(
      call.request,
      results_response(jobs_, *job, call.base, call.accept, options_.max_inline_bytes),
      call.accept);
}

Response Api::result(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(job.error(), call.accept);
  if (auto answer = without_results(*job, call.base, call.accept)) return *std::move(answer);
  const auto* file = find_result(*job, call.values[1]);
  if (file == nullptr) {
    std::vector<std::string_view> names;
    names.reserve(job->results.size());
    for (const auto& result : job->results) names.push_back(result.file_name);
    return problem_response(problems::kNoSuchOutput,
                            fmt::format("job {} has no output '{}'; available: {}", job->id,
                                        call.values[1], fmt::join(names, ", ")),
                            call.accept);
  }
  return conditional(call.request, file_response(jobs_, *job, *file), call.accept);
}

}  // namespace citymesh
