#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

enum class OptionKind { Boolean, Integer, Number, Text, TextList, BoundingBox, Polygon, Json };

std::string_view to_string(OptionKind kind);  ///< for people: "whole number", "list of texts"

/// One line of the option table: feeds CLI help, JSON Schema, OpenAPI and docs.
struct OptionSpec {
  std::string_view name;  ///< unit in the name: `snap_tolerance_m`
  OptionKind kind;
  std::string_view default_json;  ///< `0.001`, `["obj"]`, `null` when there is none
  std::string_view description;
  std::span<const std::string_view> choices{};  ///< allowed texts; empty: any
  double minimum = 0, maximum = 0;              ///< of numbers; equal: not limited
  /// JSON schema, where the kind does not say it all. The value of kind Json is not checked.
  std::string_view schema_json{};
};

struct OutputSpec {
  std::string_view id;  ///< `report` or a format key
  std::string_view media_type;
  std::string_view title;
  std::string_view schema_json{};  ///< empty: an object or bytes, by the media type
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

/// Checks `inputs_json` (a JSON object) against the table of `process`, which need not be one of
/// processes(), and completes it with the defaults, keys sorted. Errors: InvalidArgument naming
/// input, value and what is expected; ResourceExhausted.
Result<std::string> complete_inputs(const ProcessSpec& process, std::string_view inputs_json);

}  // namespace citymesh
