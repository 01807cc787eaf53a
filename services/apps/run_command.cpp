#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>

#include "core/pipeline/estimate.h"
#include "core/pipeline/pipeline.h"
#include "core/processes/inputs.h"
#include "core/processes/processes.h"
#include "core/source/source.h"
#include "services/apps/commands.h"
#include "services/apps/input.h"
#include "services/apps/output_folder.h"
#include "services/apps/progress_bar.h"
#include "services/apps/signals.h"

namespace citymesh {
namespace {

constexpr std::string_view kValidate = "validate";

using Histogram = std::vector<std::pair<std::string, std::uint64_t>>;

void print_histogram(std::string_view title, const Histogram& histogram) {
  if (histogram.empty()) return;
  std::string line;
  for (const auto& [name, count] : histogram)
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, name);
  fmt::print("  {:<10}{}\n", title, line);
}

/// What a person wants to know at the end, on stdout.
void print_summary(const RunOutcome& outcome, const OutputFolder& output) {
  const auto& report = outcome.report;
  const auto& counts = report.counts;
  fmt::print("{}: {} buildings selected\n", report.process, counts.requested);
  if (report.process == kValidate) {
    fmt::print("  {:<10}{}\n  {:<10}{}\n", "valid", counts.requested - outcome.invalid_buildings,
               "defective", outcome.invalid_buildings);
  } else {
    fmt::print("  {:<10}{}\n", "delivered", counts.delivered);
    print_histogram("  by rung", report.rungs);
    fmt::print("  {:<10}{}\n  {:<10}{}\n", "merged", counts.merged, "dropped", counts.dropped);
    print_histogram("  because", report.drop_reasons);
    fmt::print("  {:<10}{} bodies, {} triangles\n", "mesh", report.bodies, report.triangles);
  }
  if (!report.crs.id.empty())
    fmt::print("  {:<10}{}, origin {:.0f} {:.0f} {:.0f}\n", "crs", report.crs.id, report.origin.x,
               report.origin.y, report.origin.z);
  fmt::print("files\n");
  for (const auto& file : outcome.files)
    fmt::print("  {}\n", (output.folder() / file.file_name).string());
}

void print_warnings(const RunReport& report) {
  for (const auto& input : report.inputs)
    if (input.state == "failed")
      fmt::print(stderr, "citymesh: warning: {} could not be read: {}\n", input.file,
                 input.message);
  for (const auto& warning : report.warnings)
    fmt::print(stderr, "citymesh: warning: {}\n", warning);
  if (report.counts.requested == 0 && report.warnings.empty())
    fmt::print(stderr, "citymesh: warning: no building selected\n");
}

Result<void> print_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return fail(ErrorCode::Unavailable, fmt::format("cannot read '{}' again", path.string()));
  std::cout << file.rdbuf() << std::flush;
  if (!std::cout) return fail(ErrorCode::Unavailable, "cannot write to standard output");
  return {};
}

int exit_code(const RunOutcome& outcome) {
  // Only `validate` was asked for defects; an export has healed or dropped what it found.
  const auto defects = outcome.report.process == kValidate && outcome.invalid_buildings > 0;
  return outcome.complete && !defects ? kDone : kDoneWithLosses;
}

RunContext context_of(const RunArguments& arguments, const StopOnSignal& stop) {
  RunContext context;
  context.stop = stop.token();
  context.now_s = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  context.threads =
      arguments.threads > 0 ? arguments.threads : std::max(1u, std::thread::hardware_concurrency());
  return context;
}

int print_estimate(const RunArguments& arguments, const std::string& inputs) {
  const StopOnSignal stop;
  const auto source = open_input(arguments.files);
  if (!source) return could_not_run(source.error());
  const auto expected = estimate(arguments.process, inputs, **source, context_of(arguments, stop));
  if (!expected) return could_not_run(expected.error());
  fmt::print("{}\n", to_json(*expected));
  return expected->problems.empty() ? kDone : kDoneWithLosses;
}

Result<RunOutcome> run_files(const RunArguments& arguments, const std::string& inputs,
                             const std::filesystem::path& folder, const StopOnSignal& stop) {
  auto source = open_input(arguments.files);
  if (!source) return source.error();
  ProgressBar bar(stderr);
  auto context = context_of(arguments, stop);
  context.on_progress = [&bar](const Progress& progress) { bar.show(progress); };
  return run(arguments.process, inputs, **source, folder, context);
}

int run_to_folder(const RunArguments& arguments) {
  const auto* process = find_process(arguments.process);
  if (process == nullptr)
    return could_not_run(
        fail(ErrorCode::NotFound, fmt::format("process '{}' does not exist; available: {}",
                                              arguments.process, process_ids())));
  const auto inputs = inputs_of(*process, arguments.inputs);
  if (!inputs) return could_not_run(inputs.error());
  for (const auto& file : arguments.files) {  // before a folder is made for nothing
    std::error_code error;
    if (!std::filesystem::exists(file, error))
      return could_not_run(
          fail(ErrorCode::NotFound, fmt::format("input '{}' does not exist", file.string())));
  }

  if (inputs->values.only_estimate) return print_estimate(arguments, inputs->json);
  const auto to_stdout = arguments.output.empty();
  if (to_stdout && arguments.process != kValidate)
    return could_not_run(
        fail(ErrorCode::InvalidArgument, "--output is missing, expected a folder for the results"));

  const StopOnSignal stop;
  auto output = to_stdout ? OutputFolder::temporary()
                          : OutputFolder::open(arguments.output, arguments.overwrite);
  if (!output) return could_not_run(output.error());
  const auto outcome = run_files(arguments, inputs->json, output->staged(), stop);
  if (!outcome) return could_not_run(outcome.error());

  print_warnings(outcome->report);
  if (to_stdout) {
    if (auto printed = print_file(output->staged() / "report.json"); !printed)
      return could_not_run(printed.error());
    return exit_code(*outcome);
  }
  std::vector<std::string> names;
  for (const auto& file : outcome->files) names.push_back(file.file_name);
  if (auto published = output->publish(names); !published) return could_not_run(published.error());
  print_summary(*outcome, *output);
  return exit_code(*outcome);
}

}  // namespace

int could_not_run(const Error& error) {
  fmt::print(stderr, "citymesh: {}\n", error.message);
  return kCouldNotRun;
}

int run_command(const RunArguments& arguments) {
  try {
    return run_to_folder(arguments);
  } catch (const std::bad_alloc&) {
    return could_not_run(fail(ErrorCode::ResourceExhausted, "not enough memory"));
  } catch (const std::exception& error) {
    return could_not_run(
        fail(ErrorCode::Internal, fmt::format("unexpected error: {}", error.what())));
  }
}

}  // namespace citymesh
