#include "core/pipeline/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/processes/inputs.h"
#include "core/processes/processes.h"
#include "core/write/write.h"

namespace citymesh {
namespace {

// What cities usually need, for what no table of formats tells.
constexpr double kTrianglesPerBuilding = 60;  // of a source that cannot tell
constexpr double kReportBytes = 2000, kReportBytesPerBuilding = 1000;
constexpr double kErrorsBytesPerTriangle = 32;

std::vector<Estimate::Output> expected_outputs(const ProcessSpec& process, const Inputs& inputs,
                                               double buildings, double triangles) {
  std::vector<Estimate::Output> outputs;
  const auto add = [&](std::string_view id, double bytes) {
    outputs.push_back({std::string(id), static_cast<std::uint64_t>(std::llround(bytes))});
  };
  for (const OutputSpec& output : process.outputs) {
    if (const Format* format = find_format(output.id); format != nullptr) {
      if (std::ranges::find(inputs.formats, output.id) != inputs.formats.end())
        add(output.id, triangles * format->bytes_per_triangle);
    } else if (output.id == "report") {
      add(output.id, kReportBytes + buildings * kReportBytesPerBuilding);
    } else {
      add(output.id, triangles * kErrorsBytesPerTriangle);
    }
  }
  return outputs;
}

std::vector<std::string> problems_of(const Selection& selection) {
  std::vector<std::string> problems;
  for (const InputReport& input : selection.inputs)
    if (input.state == "failed")
      problems.push_back(fmt::format("{} cannot be read: {}", input.file, input.message));
  for (const std::string& id : selection.missing_ids)
    problems.push_back(fmt::format("object `{}` is in none of the inputs", id));
  problems.insert(problems.end(), selection.warnings.begin(), selection.warnings.end());
  if (selection.buildings == 0)
    problems.emplace_back("no building is selected: the result would be empty");
  return problems;
}

}  // namespace

Result<Estimate> estimate(std::string_view process, std::string_view inputs_json,
                          CitySource& source, const RunContext& context) {
  const auto inputs = canonical_inputs(process, inputs_json);
  if (!inputs) return inputs.error();
  const auto selection = source.select(inputs->values.query, context);
  if (!selection) return selection.error();

  Estimate expected;
  expected.process = process;
  expected.buildings = selection->buildings;
  expected.triangles = selection->expected_triangles.value_or(static_cast<std::uint64_t>(
      std::llround(static_cast<double>(selection->buildings) * kTrianglesPerBuilding)));
  expected.outputs = expected_outputs(*find_process(process), inputs->values,
                                      static_cast<double>(expected.buildings),
                                      static_cast<double>(expected.triangles));
  for (const auto& output : expected.outputs) expected.bytes += output.bytes;
  expected.crs = selection->crs.id;
  expected.problems = problems_of(*selection);
  return expected;
}

std::string to_json(const Estimate& estimate) {
  nlohmann::json outputs = nlohmann::json::object();
  for (const auto& output : estimate.outputs) outputs[output.output] = output.bytes;
  const nlohmann::json document{{"process", estimate.process},
                                {"buildings", estimate.buildings},
                                {"expected",
                                 {{"triangles", estimate.triangles},
                                  {"bytes", estimate.bytes},
                                  {"outputs", std::move(outputs)}}},
                                {"crs", estimate.crs},
                                {"problems", estimate.problems}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace citymesh
