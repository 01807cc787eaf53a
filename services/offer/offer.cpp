#include "services/offer/offer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/write/write.h"
#include "services/offer/echo.h"

namespace citymesh {
namespace {

constexpr std::string_view kReport = "report";

}  // namespace

std::span<const ProcessSpec> offered_processes() {
  static const auto kOffered = [] {
    const auto of_cities = processes();
    std::vector<ProcessSpec> all(of_cities.begin(), of_cities.end());
    all.push_back(echo_process());
    return all;
  }();
  return kOffered;
}

const ProcessSpec* find_offered(std::string_view id) {
  const auto all = offered_processes();
  const auto found = std::ranges::find(all, id, &ProcessSpec::id);
  return found == all.end() ? nullptr : &*found;
}

std::string offered_ids() {
  std::string text;
  for (const auto& process : offered_processes()) {
    if (!text.empty()) text += ", ";
    text += process.id;
  }
  return text;
}

Result<CheckedInputs> checked_inputs(std::string_view process, std::string_view inputs_json) {
  const auto* spec = find_offered(process);
  if (spec == nullptr)
    return fail(ErrorCode::NotFound,
                fmt::format("process '{}' does not exist; available: {}", process, offered_ids()));
  if (spec->id == kEcho) {
    auto json = checked_echo_inputs(inputs_json);
    if (!json) return json.error();
    return CheckedInputs{*std::move(json), std::nullopt};
  }
  auto inputs = canonical_inputs(process, inputs_json);
  if (!inputs) return inputs.error();
  return CheckedInputs{std::move(inputs->json), std::move(inputs->values)};
}

bool is_default_output(const ProcessSpec& process, const OutputSpec& output) {
  const bool reports =
      std::ranges::find(process.outputs, kReport, &OutputSpec::id) != process.outputs.end();
  return !reports || output.id == kReport || find_format(output.id) != nullptr;
}

std::string_view progress_unit(std::string_view process) {
  return process == kEcho ? "seconds" : "buildings";
}

}  // namespace citymesh
