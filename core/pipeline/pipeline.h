#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/citymodel/report.h"
#include "core/source/source.h"

namespace citymesh {

struct OutputFile {
  std::string output;  ///< id of the output it belongs to: `report`, `obj`, …
  std::string file_name;
  std::string media_type;
};

struct RunOutcome {
  RunReport report{};
  RunTimings timings{};  ///< as in run.json
  std::vector<OutputFile>
      files{};           ///< all files written, the contract's always-written ones included
  bool complete = true;  ///< false: objects were dropped or an input could not be read
  std::uint64_t invalid_buildings = 0;  ///< of `validate`: buildings with defects
};

class BodySink;

/// Runs a process on a source and writes its files to `folder`, which must exist and be empty.
/// `write_back` takes the bodies of a run that asks for it. Errors: those of the source; Cancelled
/// when stopped; DataLoss naming body, gate and format when a finished file fails its gates;
/// Unavailable when the disk fails.
Result<RunOutcome> run(std::string_view process, std::string_view inputs_json, CitySource& source,
                       const std::filesystem::path& folder, const RunContext& context,
                       BodySink* write_back = nullptr);

}  // namespace citymesh
