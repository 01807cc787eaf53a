// Bytes as the messages that clients send.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/processes/inputs.h"
#include "services/rpc/messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace citymesh;
  const int bytes = static_cast<int>(size);
  if (v1::SubmitRequest request; request.ParseFromArray(data, bytes)) {
    const JobSpec spec = to_spec(request);
    const auto canonical = canonical_inputs(spec.process, spec.inputs_json);
    if (!canonical && canonical.error().message.empty()) abort();
    Job job;
    job.spec = spec;
    if (to_proto(job).process() != request.process()) abort();
  }
  if (v1::ListRequest request; request.ParseFromArray(data, bytes)) {
    const auto filter = to_filter(request);
    if (filter && (filter->limit < 1 || filter->limit > 1000)) abort();
  }
  return 0;
}
