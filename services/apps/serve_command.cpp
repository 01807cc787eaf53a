#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <iostream>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/version.h"
#include "core/processes/inputs.h"
#include "core/processes/processes.h"
#include "core/source/source.h"
#include "services/access/access.h"
#include "services/apps/commands.h"
#include "services/apps/signals.h"
#include "services/callbacks/address_guard.h"
#include "services/callbacks/sender.h"
#include "services/callbacks/signature.h"
#include "services/catalogue/catalogue.h"
#include "services/catalogue/data_version.h"
#include "services/jobs/job_manager.h"
#include "services/jobs/retention.h"
#include "services/rest/results.h"
#include "services/rest/server.h"
#include "services/rpc/server.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/stores/state_folder.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "services/worker/estimates.h"
#include "services/worker/limited_source.h"
#include "services/worker/worker.h"

namespace citymesh {
namespace {

LogLevel log_level(std::string_view name) {
  if (name == "debug") return LogLevel::Debug;
  if (name == "warning") return LogLevel::Warning;
  if (name == "error") return LogLevel::Error;
  return LogLevel::Info;
}

TimeMs milliseconds(double seconds) { return static_cast<TimeMs>(std::llround(seconds * 1000)); }

WorkerOptions worker_options(const ServeOptions& options, const Access& access) {
  const auto threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  WorkerOptions worker{.workers = options.workers,
                       .threads_per_job = std::max(1u, threads / options.workers),
                       .lease_ms = milliseconds(options.lease_s),
                       .job_timeout_ms = milliseconds(options.job_timeout_s),
                       .max_job_bytes = options.max_job_bytes};
  if (options.result_cache == "on")
    worker.source_version = [data = options.data] { return data_version(data); };
  // Where clients are told apart, none may learn what another has asked for.
  worker.share_results = !access.is_required();
  return worker;
}

AccessOptions access_options(const ServeOptions& options) {
  return {.api_keys = options.api_keys,
          .oidc_jwks = {.source = options.oidc_jwks},
          .token_rules = {.issuer = options.oidc_issuer,
                          .audience = options.oidc_audience,
                          .role_claim = options.oidc_role_claim,
                          .role_prefix = options.oidc_role_prefix},
          .trusted_proxies = options.trusted_proxies};
}

RestOptions rest_options(const ServeOptions& options, const Access& access, Log& log) {
  RestOptions rest;
  rest.host = options.listen.host;
  rest.port = options.listen.port;
  rest.public_url = options.public_url;
  rest.cors_allow_origin = options.cors_allow_origin;
  rest.max_body_bytes = options.max_body_bytes;
  rest.max_connections = options.max_connections;
  rest.max_client_connections = options.max_client_connections;
  rest.sync_wait_s = options.sync_wait_s;
  rest.idle_timeout_s = options.idle_timeout_s;
  rest.header_timeout_s = options.header_timeout_s;
  rest.body_timeout_s = options.body_timeout_s;
  rest.tls = {options.tls_certificate, options.tls_key};
  rest.access = &access;
  rest.log = &log;
  return rest;
}

Result<SenderOptions> sender_options(const ServeOptions& options) {
  SenderOptions sender;
  sender.post.allow_private = options.allow_private_callbacks;
  if (options.callback_secret.empty()) return sender;
  auto secret = read_secret(options.callback_secret.string());
  if (!secret) return secret.error();
  sender.secret = *std::move(secret);
  return sender;
}

std::string rest_url(const ServeOptions& options, std::uint16_t port) {
  if (!options.public_url.empty()) return options.public_url;
  return (options.tls_certificate.empty() ? "http://" : "https://") +
         to_string(Endpoint{options.listen.host, port});
}

RpcOptions rpc_options(const ServeOptions& options, std::string links_base, const Access& access,
                       Log& log) {
  return {.host = options.grpc.host,
          .port = options.grpc.port,
          .max_message_bytes = static_cast<int>(options.max_body_bytes),
          .max_watches = options.max_watches,
          .tls_certificate = options.tls_certificate,
          .tls_key = options.tls_key,
          .links_base = std::move(links_base),
          .access = &access,
          .log = &log};
}

/// Does `work` now and then until it is stopped.
std::jthread start_repeating(std::chrono::seconds pause, std::function<void()> work) {
  return std::jthread([pause, work = std::move(work)](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    do work();
    while (!wake.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); }) &&
           !stop.stop_requested());
  });
}

/// Keys and certificates change while the service runs.
std::jthread start_reading_access(Access& access, RestServer& rest, Log& log) {
  constexpr auto kPause = std::chrono::seconds(5);
  return start_repeating(kPause, [&access, &rest, &log, told = std::string()]() mutable {
    const auto changed = access.reload();
    const auto tls = rest.reload_tls();
    if (changed && *changed) log.info("access_read", {{"message", "keys have changed"}});
    const auto problem = !changed ? changed.error().message : !tls ? tls.error().message : "";
    if (!problem.empty() && problem != told)
      log.error("access_not_read",
                {{"message", problem + "; what was read before stays in force"}});
    told = problem;
  });
}

/// Removes what is kept long enough, now and then, until it is stopped.
std::jthread start_sweeping(EmbeddedStore& store, ResultStore& results, const ServeOptions& options,
                            Log& log) {
  constexpr auto kPause = std::chrono::seconds(30);
  const RetentionOptions retention{.keep_results_ms = milliseconds(options.keep_results_s),
                                   .keep_jobs_ms = milliseconds(options.keep_jobs_s),
                                   .max_result_bytes = options.max_result_bytes};
  return start_repeating(kPause, [&store, &results, &log, retention] {
    if (const auto swept = sweep(store, results, retention, now_ms()); !swept)
      log.error("sweep_failed", {{"message", swept.error().message}});
    else if (swept->bytes_freed > 0 || swept->jobs_forgotten > 0)
      log.info("swept", {{"results_expired", swept->results_expired},
                         {"jobs_forgotten", swept->jobs_forgotten},
                         {"bytes_freed", swept->bytes_freed}});
  });
}

void announce(Log& log, const ServeOptions& options, const Endpoint& rest, const Endpoint& rpc) {
  const bool tls = !options.tls_certificate.empty();
  const auto url = (tls ? "https://" : "http://") + to_string(rest);
  log.info("listening", {{"rest", url},
                         {"grpc", to_string(rpc)},
                         {"public_url", options.public_url},
                         {"data", options.data.string()},
                         {"state", options.state.string()},
                         {"workers", options.workers},
                         {"version", version()}});
  for (const auto& endpoint : {rest, rpc})
    if (!is_loopback(endpoint) && (options.insecure || !tls))
      log.warning(
          "open_to_the_network",
          {{"address", to_string(endpoint)},
           {"message", options.insecure
                           ? "anyone who reaches this address may submit and read jobs"
                           : "without TLS here or in a proxy keys travel for all to read"}});
  fmt::print(stderr, "citymesh {} serves {}\n  REST  {}/\n  gRPC  {}\n", version(),
             options.data.string(), url, to_string(rpc));
}

/// No job takes more than it may.
SourceFactory within_limits(SourceFactory open, const ServeOptions& options) {
  const JobLimits limits{.buildings = options.max_job_buildings, .points = options.max_job_points};
  return [open = std::move(open), limits]() -> Result<std::unique_ptr<CitySource>> {
    auto source = open();
    if (!source) return source.error();
    return limited(*std::move(source), limits);
  };
}

/// No box is larger than it may be.
std::function<Result<void>(const std::string&, const std::string&)> area_check(double max_km2) {
  if (max_km2 <= 0) return {};
  return [max_km2](const std::string& process, const std::string& inputs_json) -> Result<void> {
    if (find_process(process) == nullptr) return {};  // reads no buildings
    const auto inputs = read_inputs(inputs_json);
    return inputs ? check_area(inputs->query, max_km2) : inputs.error();
  };
}

/// What jobs read: a folder through its catalogue, which is brought up to date now rather than in
/// the first job; a single file as it is.
Result<SourceFactory> open_data(const ServeOptions& options, Log& log, const StopOnSignal& stop) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(options.data, ignored)) {
    SourceFactory file = [data = options.data] { return open_files({data}, {}); };
    if (auto opened = file(); !opened) return opened.error();
    return within_limits(std::move(file), options);
  }
  CatalogueOptions catalogue{.data = options.data, .state = default_catalogue(options.data)};
  if (!has_catalogue(catalogue.state)) catalogue.state = options.state / "catalogue";
  RunContext context;
  context.stop = stop.token();
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
  return within_limits([catalogue] { return open_catalogued(catalogue); }, options);
}

Result<void> serve(const ServeOptions& options) {
  if (auto checked = check(options); !checked) return checked;
  const StopOnSignal stop;
  Log log(std::cout, log_level(options.log_level));
  const auto access = Access::open(access_options(options));
  if (!access) return access.error();
  auto state = StateFolder::open(options.state);
  if (!state) return state.error();
  const auto source = open_data(options, log, stop);
  if (!source) return source.error();
  auto store = EmbeddedStore::open(state->jobs_file(), {.max_attempts = options.max_attempts});
  if (!store) return store.error();
  auto results = FolderResultStore::open(state->results_folder());
  if (!results) return results.error();
  if (state->alone()) {
    const auto recovered = (*store)->recover();
    if (!recovered) return recovered.error();
    if (*recovered > 0) log.warning("jobs_recovered", {{"jobs", *recovered}});
  }
  if (auto shared = state->share(); !shared) return shared;

  Metrics metrics;
  metrics.on_collect([&queue = **store, &metrics] {
    if (const auto waiting = queue.waiting())
      metrics.set_queue(
          waiting->tasks,
          waiting->tasks == 0 ? 0 : static_cast<double>(now_ms() - waiting->oldest) / 1000.0);
  });
  auto sending = sender_options(options);
  if (!sending) return sending.error();
  JobManager jobs(
      **store, **store, **results,
      {.max_open_jobs = options.max_open_jobs,
       .max_open_jobs_per_owner = options.max_client_jobs,
       .check_inputs = area_check(options.max_job_area_km2),
       .estimate = estimator(*source),
       .check_callback = [allow_private = options.allow_private_callbacks](const std::string& uri) {
         return check_callback_uri(uri, allow_private);
       }});
  CallbackSender callbacks(**store, callback_json, log, metrics, *std::move(sending));
  WorkerPool workers(**store, **store, **results, *source, log, metrics,
                     worker_options(options, **access));
  RestServer rest(jobs, metrics, rest_options(options, **access, log));
  const auto rest_port = rest.start();
  if (!rest_port) return rest_port.error();
  RpcServer rpc(jobs, metrics, rpc_options(options, rest_url(options, *rest_port), **access, log));
  const auto rpc_port = rpc.start();
  if (!rpc_port) return rpc_port.error();
  workers.start();
  callbacks.start();
  const auto sweeper = start_sweeping(**store, **results, options, log);
  const auto reader = start_reading_access(**access, rest, log);
  announce(log, options, {options.listen.host, *rest_port}, {options.grpc.host, *rpc_port});

  stop.wait();
  log.info("stopping", {});
  rest.stop();
  rpc.stop();
  workers.stop();
  callbacks.stop();
  log.info("stopped", {});
  return {};
}

}  // namespace

int serve_command(const ServeOptions& options) {
  try {
    const auto served = serve(options);
    return served ? kDone : could_not_run(served.error());
  } catch (const std::exception& error) {
    return could_not_run(
        fail(ErrorCode::Internal, fmt::format("unexpected error: {}", error.what())));
  }
}

}  // namespace citymesh
