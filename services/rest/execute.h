#pragma once

#include <string_view>

#include "core/base/result.h"
#include "core/processes/processes.h"
#include "services/jobs/job.h"

namespace citymesh {

/// Reads the body of an execute request (OGC API - Processes 1.0). Inputs may be plain, a
/// bounding-box object, or qualified as {"value": …}; their values are checked by JobManager.
/// Without `outputs` and `response` the results are a document of links; `outputs` without
/// `response` means raw, as the standard says.
/// Errors: InvalidArgument for malformed JSON (with its position), nesting, types and unknown
/// members; Unimplemented for inputs by reference.
Result<JobSpec> decode_execute(const ProcessSpec& process, std::string_view body);

}  // namespace citymesh
