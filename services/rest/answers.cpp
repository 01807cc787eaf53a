#include "services/rest/answers.h"

#include <fmt/format.h>

#include "services/jobs/retention.h"
#include "services/offer/offer.h"
#include "services/rest/documents.h"
#include "services/rest/problem.h"

namespace citymesh {
namespace {

constexpr std::string_view kJson = "application/json";

}  // namespace

bool wants_page(std::string_view accept, const std::map<std::string, std::string>& query) {
  if (const auto f = query.find("f"); f != query.end()) return f->second == "html";
  const double page = accept_quality(accept, "text/html");
  return accept_names(accept, "text/html") && page > 0 && page >= accept_quality(accept, kJson);
}

Response json_response(std::string body, int status) {
  return text_response(status, kJson, std::move(body));
}

Response no_such_process(std::string_view id, std::string_view accept) {
  return problem_response(
      problems::kNoSuchProcess,
      fmt::format("process '{}' does not exist; available: {}", id, offered_ids()), accept);
}

Response job_error(const Error& error, std::string_view accept) {
  const auto& kind =
      error.code == ErrorCode::NotFound ? problems::kNoSuchJob : problem_kind(error.code);
  return problem_response(kind, error.message, accept);
}

std::optional<Response> without_results(const Job& job, std::string_view base,
                                        std::string_view accept) {
  switch (job.state) {
    case JobState::Successful:
      if (!has_expired(job)) return std::nullopt;
      return problem_response(problems::kResultNotAvailable,
                              fmt::format("job {}: its {}", job.id, job.message), accept);
    case JobState::Failed: {
      const auto error = job.error.value_or(Error{ErrorCode::Internal, job.message});
      return problem_response(failed_job_kind(error.code), error.message, accept,
                              job_url(base, job));
    }
    case JobState::Dismissed:
      return problem_response(problems::kResultNotAvailable,
                              fmt::format("job {} was dismissed and has no results", job.id),
                              accept);
    case JobState::Accepted:
    case JobState::Running:
      break;
  }
  return problem_response(problems::kResultNotReady,
                          fmt::format("job {} is {}; its results are there once it is successful",
                                      job.id, to_string(job.state)),
                          accept);
}

}  // namespace citymesh
