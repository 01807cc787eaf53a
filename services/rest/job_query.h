#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "services/jobs/job.h"

namespace citymesh {

/// The query parameters of GET /jobs.
struct JobQuery {
  JobFilter filter{};  ///< what the store can select by; `offset` counts in its order
  std::optional<TimeMs> created_from{}, created_to{};
  std::optional<double> min_duration_s{}, max_duration_s{};
};

/// Errors: InvalidArgument naming the parameter, its value and what is expected.
Result<JobQuery> parse_job_query(const std::map<std::string, std::string>& query);

/// Whether the job satisfies what the store cannot select by. A job's duration is the time that it
/// has been running, or ran.
bool selects(const JobQuery& query, const Job& job, TimeMs now);

/// A whole number from `minimum` to `maximum`; `fallback` when the parameter is absent.
Result<std::uint32_t> whole_number(const std::map<std::string, std::string>& query,
                                   const std::string& name, std::uint32_t fallback,
                                   std::uint32_t minimum, std::uint32_t maximum);

/// Refuses parameters that the resource does not have: a filter that is ignored gives wrong
/// answers.
Result<void> check_parameters(const std::map<std::string, std::string>& query,
                              std::initializer_list<std::string_view> known);

}  // namespace citymesh
