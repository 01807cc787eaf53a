#include <fmt/format.h>

#include <string>

#include "core/processes/processes.h"
#include "services/apps/commands.h"

namespace citymesh {
namespace {

std::string values(const OptionSpec& option) {
  std::string text(to_string(option.kind));
  if (!option.choices.empty())
    text = fmt::format("{}{}", option.kind == OptionKind::TextList ? "list of " : "",
                       fmt::join(option.choices, " | "));
  if (option.minimum < option.maximum)
    text += fmt::format(" from {} to {}", option.minimum, option.maximum);
  return text;
}

}  // namespace

int processes_command() {
  for (const auto& process : processes()) {
    fmt::print("{}\n  {}\n\n  inputs\n", process.id, process.description);
    for (const auto& option : process.inputs)
      fmt::print("    {} = {}\n        {} ({})\n", option.name, option.default_json,
                 option.description, values(option));
    fmt::print("\n  outputs\n");
    for (const auto& output : process.outputs)
      fmt::print("    {:<12} {} ({})\n", output.id, output.title, output.media_type);
    fmt::print("\n");
  }
  return kDone;
}

}  // namespace citymesh
