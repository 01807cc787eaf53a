#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/pipeline/pipeline.h"
#include "core/source/source.h"

namespace citymesh {

/// Opens what jobs read from.
using SourceFactory = std::function<Result<std::unique_ptr<CitySource>>()>;

/// What a run leaves behind.
struct ProcessOutcome {
  std::vector<OutputFile> files{};
  std::string message{};  ///< for people: what came out
  RunTimings timings{};
  Counts buildings{};
  std::vector<std::pair<std::string, std::uint64_t>> issues{};  ///< found in the input, by code
};

/// Runs a process and writes its files to `folder`, which must exist and be empty. `open` is called
/// only by a process that reads a source, `write_back` fed where the inputs ask for it. Errors:
/// those of core/pipeline's run().
Result<ProcessOutcome> run_offered(std::string_view process, std::string_view inputs_json,
                                   const SourceFactory& open, const std::filesystem::path& folder,
                                   const RunContext& context, BodySink* write_back = nullptr);

}  // namespace citymesh
