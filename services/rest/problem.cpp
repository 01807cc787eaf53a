#include "services/rest/problem.h"

#include <nlohmann/json.hpp>

#include "services/rest/pages.h"

namespace citymesh {
namespace {

constexpr std::string_view kBlank = "about:blank";

struct ErrorRow {
  ErrorCode code;
  ProblemKind kind;           ///< of a request
  ProblemKind of_failed_job;  ///< of a job that ended with it
};

constexpr ProblemKind kServerError{500, kBlank, "Internal Server Error"};
constexpr ProblemKind kJobInputError{400, kBlank, "The job failed because of its inputs"};
constexpr ProblemKind kJobServerError{500, kBlank, "The job failed"};
constexpr ProblemKind kJobUnavailable{503, kBlank, "The job failed, a new one may succeed"};

constexpr ErrorRow kErrors[] = {
    {ErrorCode::InvalidArgument, {400, kBlank, "Bad Request"}, kJobInputError},
    {ErrorCode::FailedPrecondition, {409, kBlank, "Conflict"}, kJobInputError},
    {ErrorCode::NotFound, {404, kBlank, "Not Found"}, kJobInputError},
    {ErrorCode::AlreadyExists, {409, kBlank, "Conflict"}, kJobServerError},
    {ErrorCode::PermissionDenied, {403, kBlank, "Forbidden"}, kJobServerError},
    {ErrorCode::ResourceExhausted, {429, kBlank, "Too Many Requests"}, kJobInputError},
    {ErrorCode::Cancelled, {503, kBlank, "Service Unavailable"}, kJobUnavailable},
    {ErrorCode::DeadlineExceeded, {504, kBlank, "Gateway Timeout"}, kJobUnavailable},
    {ErrorCode::Unavailable, {503, kBlank, "Service Unavailable"}, kJobUnavailable},
    {ErrorCode::Unimplemented, {501, kBlank, "Not Implemented"}, kJobInputError},
    {ErrorCode::DataLoss, kServerError, kJobServerError},
    {ErrorCode::Internal, kServerError, kJobServerError},
};

constexpr ErrorRow kUnknown{ErrorCode::Internal, kServerError, kJobServerError};

const ErrorRow& row_of(ErrorCode code) {
  for (const auto& row : kErrors)
    if (row.code == code) return row;
  return kUnknown;
}

#define OGC_EXCEPTION "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"

}  // namespace

namespace problems {
const ProblemKind kUnauthorized{401, kBlank, "Unauthorized"};
const ProblemKind kNoSuchProcess{404, OGC_EXCEPTION "no-such-process", "No such process"};
const ProblemKind kNoSuchJob{404, OGC_EXCEPTION "no-such-job", "No such job"};
const ProblemKind kNoSuchOutput{404, OGC_EXCEPTION "no-such-output", "No such output"};
const ProblemKind kNoSuchResource{404, kBlank, "Not Found"};
const ProblemKind kResultNotReady{404, OGC_EXCEPTION "result-not-ready", "Result not ready"};
const ProblemKind kResultNotAvailable{404, OGC_EXCEPTION "result-not-available",
                                      "Result not available"};
const ProblemKind kJobIsFinal{409, kBlank, "The job has ended"};
const ProblemKind kIdempotencyKeyUsed{422, kBlank, "Unprocessable Content"};
const ProblemKind kInvalidQuery{400, OGC_EXCEPTION "invalid-query-parameter-value",
                                "Invalid query parameter"};
const ProblemKind kMethodNotAllowed{405, kBlank, "Method Not Allowed"};
const ProblemKind kUnsupportedMediaType{415, kBlank, "Unsupported Media Type"};
const ProblemKind kBodyTooLarge{413, kBlank, "Payload Too Large"};
const ProblemKind kHeaderTooLarge{431, kBlank, "Request Header Fields Too Large"};
const ProblemKind kTooManyConnections{503, kBlank, "Service Unavailable"};
const ProblemKind kPreconditionFailed{412, kBlank, "Precondition Failed"};
const ProblemKind kRangeNotSatisfiable{416, kBlank, "Range Not Satisfiable"};
}  // namespace problems

const ProblemKind& problem_kind(ErrorCode code) { return row_of(code).kind; }
const ProblemKind& failed_job_kind(ErrorCode code) { return row_of(code).of_failed_job; }

std::string problem_json(const ProblemKind& kind, std::string_view detail,
                         std::string_view instance) {
  nlohmann::ordered_json problem = {
      {"type", kind.type}, {"title", kind.title}, {"status", kind.status}, {"detail", detail}};
  if (!instance.empty()) problem["instance"] = instance;
  return problem.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Response problem_response(const ProblemKind& kind, std::string_view detail, std::string_view accept,
                          std::string_view instance) {
  Response response;
  const bool named_html = accept_names(accept, "text/html");
  const bool named_json = accept_names(accept, "application/json");
  const bool named_problem = accept_names(accept, "application/problem+json");
  if (named_html && !named_json && !named_problem)
    response = page_response(kind.status, problem_page(kind, detail));
  else
    response = text_response(
        kind.status, named_json && !named_problem ? "application/json" : "application/problem+json",
        problem_json(kind, detail, instance));
  if (kind.status == 429 || kind.status == 503) response.headers.set("Retry-After", "5");
  return response;
}

}  // namespace citymesh
