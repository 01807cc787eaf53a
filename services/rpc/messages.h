#pragma once

#include "citymesh/v1/jobs.pb.h"
#include "core/base/result.h"
#include "core/pipeline/estimate.h"
#include "core/processes/processes.h"
#include "services/jobs/job.h"

namespace citymesh {

// Between the types of the service and the messages of the wire.

v1::Job to_proto(const Job& job);
v1::EstimateReply to_proto(const Estimate& estimate);
v1::Process to_proto(const ProcessSpec& process);
JobSpec to_spec(const v1::SubmitRequest& request);
/// Errors: InvalidArgument naming the member, its value and what is expected.
Result<JobFilter> to_filter(const v1::ListRequest& request);

}  // namespace citymesh
