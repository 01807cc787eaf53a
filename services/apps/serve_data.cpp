#include "services/apps/serve_data.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "core/processes/inputs.h"
#include "core/source/source.h"
#include "services/catalogue/catalogue.h"
#include "services/catalogue/data_version.h"
#include "services/citydb/citydb.h"
#include "services/citydb/write_back.h"
#include "services/wfs/wfs.h"
#include "services/worker/limited_source.h"

namespace citymesh {
namespace {

/// No job takes more than it may.
SourceFactory within_limits(SourceFactory open, const ServeOptions& options) {
  const JobLimits limits{.buildings = options.max_job_buildings, .points = options.max_job_points};
  return [open = std::move(open), limits]() -> Result<std::unique_ptr<CitySource>> {
    auto source = open();
    if (!source) return source.error();
    return limited(*std::move(source), limits);
  };
}

Result<SourceFactory> open_folder(const ServeOptions& options, Log& log,
                                  const std::stop_token& stop) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(options.data, ignored)) {
    SourceFactory file = [data = options.data] { return open_files({data}, {}); };
    if (auto opened = file(); !opened) return opened.error();
    return file;
  }
  CatalogueOptions catalogue{.data = options.data, .state = default_catalogue(options.data)};
  if (!has_catalogue(catalogue.state)) catalogue.state = options.state / "catalogue";
  RunContext context;
  context.stop = stop;
  context.threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  log.info("indexing", {{"data", options.data.string()}, {"catalogue", catalogue.state.string()}});
  const auto report = update_catalogue(catalogue, context);
  if (!report) return report.error();
  for (const auto& [file, problem] : report->problems)
    log.warning("file_not_read", {{"file", file}, {"message", problem}});
  log.info("indexed", {{"files", report->files},
                       {"buildings", report->buildings},
                       {"new_or_changed", report->indexed},
                       {"removed", report->removed}});
  return SourceFactory([catalogue] { return open_catalogued(catalogue); });
}

Result<SourceFactory> open_database(const ServeOptions& options) {
  auto database = open_citydb({.url = options.source,
                               .schema = options.source_schema,
                               .max_connections = options.source_connections,
                               .statement_timeout_s = options.source_timeout_s});
  if (!database) return database.error();
  return SourceFactory(*std::move(database));
}

Result<void> open_service(const ServeOptions& options, ServedData& served) {
  const auto service = open_wfs({.url = options.source, .max_features = options.max_job_buildings});
  if (!service) return service.error();
  served.open = within_limits([open = *service] { return open(WfsUse::Reading); }, options);
  served.open_to_count =
      within_limits([open = *service] { return open(WfsUse::Counting); }, options);
  return {};
}

Result<void> open_data(const ServeOptions& options, Log& log, const std::stop_token& stop,
                       ServedData& served) {
  auto opened = options.source.empty() ? open_folder(options, log, stop) : open_database(options);
  if (!opened) return opened.error();
  served.open = served.open_to_count = within_limits(*std::move(opened), options);
  return {};
}

Result<void> check_inputs(const Inputs& inputs, double most_km2, bool may_write) {
  if (inputs.write_back && !may_write)
    return fail(ErrorCode::InvalidArgument,
                "input `write_back` is true, but this service writes to no database; expected "
                "false, or a service that reads a 3DCityDB and was started with "
                "--write_back_schema");
  return most_km2 > 0 ? check_area(inputs, most_km2) : Result<void>{};
}

bool is_web(const std::string& source) {
  return source.starts_with("http://") || source.starts_with("https://");
}

}  // namespace

Result<ServedData> open_served_data(const ServeOptions& options, Log& log,
                                    const std::stop_token& stop) {
  ServedData served;
  const auto opened = is_web(options.source) ? open_service(options, served)
                                             : open_data(options, log, stop, served);
  if (!opened) return opened.error();
  if (!options.write_back_schema.empty()) {
    auto write_back = open_write_back(
        {.url = options.write_back_url.empty() ? options.source : options.write_back_url,
         .schema = options.write_back_schema,
         .source_schema = options.source_schema,
         .statement_timeout_s = options.source_timeout_s});
    if (!write_back) return write_back.error();
    served.write_back = *std::move(write_back);
  }
  served.check_inputs = [most = options.max_job_area_km2, may_write = served.write_back != nullptr](
                            const Inputs& inputs) { return check_inputs(inputs, most, may_write); };
  if (options.source.empty()) {
    served.name = options.data.string();
    served.version = [data = options.data] { return data_version(data); };
  } else if (is_web(options.source)) {
    served.name = shown_wfs_url(options.source);
  } else if (auto shown = shown_citydb_url(options.source)) {
    served.name = *std::move(shown);
  }
  return served;
}

}  // namespace citymesh
