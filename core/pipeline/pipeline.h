#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/citymodel/report.h"
#include "core/source/source.h"

namespace citymesh {

enum class OptionKind { Boolean, Integer, Number, Text, TextList, BoundingBox };

std::string_view to_string(OptionKind kind);  ///< for people: "whole number", "list of texts"

/// One line of the option table: feeds CLI help, JSON Schema, OpenAPI and docs.
struct OptionSpec {
  std::string_view name;  ///< unit in the name: `snap_tolerance_m`
  OptionKind kind;
  std::string_view default_json;  ///< `0.001`, `["obj"]`, `null` when there is none
  std::string_view description;
  std::span<const std::string_view> choices{};  ///< allowed texts; empty: any
  double minimum = 0, maximum = 0;              ///< of numbers; equal: not limited
};

struct OutputSpec {
  std::string_view id;  ///< `report` or a format key
  std::string_view media_type;
  std::string_view title;
};

/// A recipe: which rooms run, with which options.
struct ProcessSpec {
  std::string_view id;
  std::string_view title;
  std::string_view description;
  bool async_only = false;
  std::span<const OptionSpec> inputs;
  std::span<const OutputSpec> outputs;
};

std::span<const ProcessSpec> processes();
const ProcessSpec* find_process(std::string_view id);
std::string process_ids();  ///< "export-for-simulation, heal, validate" for messages

/// Checks `inputs_json` (a JSON object) against the table and completes it with the defaults, keys
/// sorted. Errors: NotFound for an unknown process; InvalidArgument naming input, value and what is
/// expected.
Result<std::string> canonical_inputs(std::string_view process, std::string_view inputs_json);

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

/// Runs a process on a source and writes its files to `folder`, which must exist and be empty.
/// Errors: those of the source; Cancelled when stopped; DataLoss naming body, gate and format when
/// a finished file fails its gates; Unavailable when the disk fails.
Result<RunOutcome> run(std::string_view process, std::string_view inputs_json, CitySource& source,
                       const std::filesystem::path& folder, const RunContext& context);

}  // namespace citymesh
