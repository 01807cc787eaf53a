#include "services/worker/run_offered.h"

#include <fmt/format.h>

#include <utility>

#include "services/offer/echo.h"

namespace citymesh {
namespace {

std::string summary(const RunOutcome& outcome) {
  const auto& counts = outcome.report.counts;
  if (counts.requested == 0) return "no building selected";
  auto text = fmt::format("{} of {} buildings delivered", counts.delivered, counts.requested);
  if (counts.merged > 0) text += fmt::format(", {} merged", counts.merged);
  if (counts.dropped > 0) text += fmt::format(", {} dropped", counts.dropped);
  return text;
}

Result<ProcessOutcome> echo(std::string_view inputs_json, const std::filesystem::path& folder,
                            const RunContext& context) {
  const double start = context.now();
  const auto echoed = run_echo(inputs_json, folder, context);
  if (!echoed) return echoed.error();
  ProcessOutcome outcome;
  for (const auto& output : *echoed)
    outcome.files.push_back(
        {std::string(output.name), std::string(output.file_name), std::string(output.media_type)});
  outcome.timings.total_s = context.now() - start;
  outcome.message =
      fmt::format("{} input{} echoed", echoed->size(), echoed->size() == 1 ? "" : "s");
  return outcome;
}

}  // namespace

Result<ProcessOutcome> run_offered(std::string_view process, std::string_view inputs_json,
                                   const SourceFactory& open, const std::filesystem::path& folder,
                                   const RunContext& context, BodySink* write_back) {
  if (process == kEcho) return echo(inputs_json, folder, context);
  const auto source = open();
  if (!source) return source.error();
  auto outcome = run(process, inputs_json, **source, folder, context, write_back);
  if (!outcome) return outcome.error();
  auto message = summary(*outcome);
  return ProcessOutcome{std::move(outcome->files), std::move(message), std::move(outcome->timings),
                        outcome->report.counts, std::move(outcome->report.issues)};
}

}  // namespace citymesh
