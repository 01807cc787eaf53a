#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/version.h"
#include "services/jobs/stores.h"

namespace citymesh {

/// Under which the results of a job are found again. Equal for jobs that give the same files: of
/// the same process, inputs, version of the source and program, and, unless results are `shared`,
/// of the same owner. Empty, never found: for an unknown version of the source (empty), for jobs
/// that write back, and for processes that read nothing.
std::string cache_key(const Job& job, std::string_view source_version, bool shared,
                      std::string_view program = version());

/// Puts the results that an earlier job left under `cache_key` into the staged folder of the claim,
/// and returns that job. Nothing: there are none, or not any more; the folder has to be staged
/// again.
std::optional<Job> reuse_results(JobStore& jobs, ResultStore& results, const std::string& cache_key,
                                 const Claim& claim);

}  // namespace citymesh
