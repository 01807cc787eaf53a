#pragma once

#include <functional>
#include <string>

#include "core/pipeline/estimate.h"
#include "services/jobs/job.h"
#include "services/worker/run_offered.h"

namespace citymesh {

struct EstimateLimits {
  unsigned at_once = 4;        ///< more are refused with ResourceExhausted
  TimeMs longest_ms = 10'000;  ///< then DeadlineExceeded
};

/// What jobs would process, told outside of the queue by asking the source. May be called from
/// several threads. Errors: those of core/pipeline's estimate() and those of the limits.
std::function<Result<Estimate>(const std::string& process, const std::string& inputs_json)>
estimator(SourceFactory open, EstimateLimits limits = {});

}  // namespace citymesh
