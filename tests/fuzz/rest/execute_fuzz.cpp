// The body of an execute request, for every process.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/processes/inputs.h"
#include "core/processes/processes.h"
#include "services/rest/execute.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace citymesh;
  const std::string_view body(reinterpret_cast<const char*>(data), size);
  for (const ProcessSpec& process : processes()) {
    const auto spec = decode_execute(process, body);
    if (!spec) continue;
    const auto canonical = canonical_inputs(spec->process, spec->inputs_json);
    if (!canonical) continue;
    // What is canonical stays as it is.
    const auto again = canonical_inputs(spec->process, canonical->json);
    if (!again || again->json != canonical->json) abort();
  }
  return 0;
}
