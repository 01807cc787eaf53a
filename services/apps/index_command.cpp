#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>

#include "services/apps/commands.h"
#include "services/apps/progress_bar.h"
#include "services/apps/signals.h"
#include "services/catalogue/catalogue.h"

namespace citymesh {
namespace {

int index(const IndexArguments& arguments) {
  const CatalogueOptions options{
      .data = arguments.data,
      .state = arguments.state.empty() ? default_catalogue(arguments.data) : arguments.state};
  if (auto opened = open_catalogued(options); !opened) return could_not_run(opened.error());

  const StopOnSignal stop;
  const auto started = std::chrono::steady_clock::now();
  Result<CatalogueReport> report = CatalogueReport{};
  {
    ProgressBar bar(stderr);
    RunContext context;
    context.stop = stop.token();
    context.on_progress = [&bar](const Progress& progress) { bar.show(progress); };
    context.threads = arguments.threads > 0 ? arguments.threads
                                            : std::max(1u, std::thread::hardware_concurrency());
    report = update_catalogue(options, context);
  }
  if (!report) return could_not_run(report.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  for (const auto& [file, problem] : report->problems)
    fmt::print(stderr, "citymesh: warning: {} could not be read: {}\n", file, problem);
  fmt::print(
      "{}: {} files, {} buildings\n  indexed   {} ({:.1f} MB in {:.2f} s)\n  unchanged {}\n  "
      "removed   {}\n  catalogue {}\n",
      options.data.string(), report->files, report->buildings, report->indexed,
      static_cast<double>(report->bytes) / 1e6, seconds, report->unchanged, report->removed,
      options.state.string());
  return report->problems.empty() ? kDone : kDoneWithLosses;
}

}  // namespace

int index_command(const IndexArguments& arguments) {
  try {
    return index(arguments);
  } catch (const std::exception& error) {
    return could_not_run(
        fail(ErrorCode::Internal, fmt::format("unexpected error: {}", error.what())));
  }
}

}  // namespace citymesh
