#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/processes/inputs.h"
#include "core/processes/processes.h"

namespace citymesh {

// What the service offers: the processes of the core, and `echo`, which has nothing to do with
// cities.

std::span<const ProcessSpec> offered_processes();
const ProcessSpec* find_offered(std::string_view id);
std::string offered_ids();  ///< "export-for-simulation, heal, validate, echo" for messages

struct CheckedInputs {
  std::string json{};               ///< complete_inputs() of core/processes
  std::optional<Inputs> of_city{};  ///< the same as values; none of a process that reads no city
};

/// As canonical_inputs() of core/processes, for every process offered.
Result<CheckedInputs> checked_inputs(std::string_view process, std::string_view inputs_json);

/// Whether a request that names no outputs gets this one: the report and the formats; of a process
/// without a report everything.
bool is_default_output(const ProcessSpec& process, const OutputSpec& output);

/// What `done` and `total` of the progress count, for people.
std::string_view progress_unit(std::string_view process);

}  // namespace citymesh
