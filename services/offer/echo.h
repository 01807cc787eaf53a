#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/processes/processes.h"

namespace citymesh {

inline constexpr std::string_view kEcho = "echo";

/// Gives every input back as the output of the same name: for those who write or test clients, the
/// official test suite among them. One input of each kind that OGC API - Processes knows.
const ProcessSpec& echo_process();

/// As canonical_inputs() of core/processes. What an object holds, where a box lies and in which CRS
/// is nobody's business here.
Result<std::string> checked_echo_inputs(std::string_view inputs_json);

/// An output, and the file in which it is.
struct EchoedFile {
  std::string_view name;
  std::string_view file_name;
  std::string_view media_type;
};

/// Writes one file per input given to `folder`, after the pause that was asked for. Cancelled when
/// stopped in it.
Result<std::vector<EchoedFile>> run_echo(std::string_view inputs_json,
                                         const std::filesystem::path& folder,
                                         const RunContext& context);

}  // namespace citymesh
