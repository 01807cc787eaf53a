#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "services/rest/message.h"

namespace citymesh {

/// What a problem document says beside its detail (RFC 7807).
struct ProblemKind {
  int status;
  std::string_view type;  ///< an OGC URI where the standard names one
  std::string_view title;
};

/// The one table from error codes to HTTP.
const ProblemKind& problem_kind(ErrorCode code);
/// The same for an error that ended a job: what was wrong with its request stays the client's
/// fault.
const ProblemKind& failed_job_kind(ErrorCode code);

/// Problems with a meaning of their own in HTTP or OGC API - Processes.
namespace problems {
extern const ProblemKind kUnauthorized;
extern const ProblemKind kNoSuchProcess;
extern const ProblemKind kNoSuchJob;
extern const ProblemKind kNoSuchOutput;
extern const ProblemKind kNoSuchResource;
extern const ProblemKind kResultNotReady;
extern const ProblemKind kResultNotAvailable;
extern const ProblemKind kJobIsFinal;
extern const ProblemKind kIdempotencyKeyUsed;
extern const ProblemKind kInvalidQuery;
extern const ProblemKind kMethodNotAllowed;
extern const ProblemKind kUnsupportedMediaType;
extern const ProblemKind kBodyTooLarge;
extern const ProblemKind kHeaderTooLarge;
extern const ProblemKind kTooManyConnections;
extern const ProblemKind kPreconditionFailed;
extern const ProblemKind kRangeNotSatisfiable;
}  // namespace problems

/// The members of a problem document.
std::string problem_json(const ProblemKind& kind, std::string_view detail,
                         std::string_view instance = {});

/// The problem in the form the client's Accept header asks for: `application/problem+json`,
/// `application/json` when that is named and problem+json is not, or a page for browsers.
Response problem_response(const ProblemKind& kind, std::string_view detail, std::string_view accept,
                          std::string_view instance = {});

}  // namespace citymesh
