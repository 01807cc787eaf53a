#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/jobs/job.h"

namespace citymesh {

// JSON documents of OGC API - Processes 1.0 about the service and its jobs. `base` is the URL that
// all links begin with, without a slash at its end.

std::string landing_json(std::string_view base);
std::string conformance_json();

/// statusInfo with 1.0's field names; beside them `stage` (until successful), `done`, `total`,
/// and `exception` when failed.
std::string status_json(std::string_view base, const Job& job);

/// `self` and `next` are complete URLs; `next` may be empty.
std::string job_list_json(std::string_view base, const std::vector<Job>& jobs,
                          std::string_view self, std::string_view next);

std::string job_url(std::string_view base, const Job& job);
std::string result_url(std::string_view base, const Job& job, const ResultFile& file);

/// RFC 3339 in UTC with milliseconds.
std::string rfc3339(TimeMs time);

}  // namespace citymesh
