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
#include "services/access/access.h"
#include "services/apps/commands.h"
#include "services/apps/serve_data.h"
#include "services/apps/signals.h"
#include "services/callbacks/address_guard.h"
#include "services/callbacks/sender.h"
#include "services/callbacks/signature.h"
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

WorkerOptions worker_options(const ServeOptions& options, const ServedData& data,
                             const Access& access) {
  const auto threads =
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  WorkerOptions worker{.workers = options.workers,
                       .threads_per_job = std::max(1u, threads / options.workers),
                       .lease_ms = milliseconds(options.lease_s),
                       .job_timeout_ms = milliseconds(options.job_timeout_s),
                       .max_job_bytes = options.max_job_bytes};
  if (options.result_cache == "on") worker.source_version = data.version;
  // Where clients are told apart, none may learn what another has asked for.
  worker.share_results = !access.is_required();
  worker.write_back = data.write_back.get();
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

void announce(Log& log, const ServeOptions& options, const std::string& data, const Endpoint& rest,
              const Endpoint& rpc) {
  const bool tls = !options.tls_certificate.empty();
  const auto url = (tls ? "https://" : "http://") + to_string(rest);
  log.info("listening", {{"rest", url},
                         {"grpc", to_string(rpc)},
                         {"public_url", options.public_url},
                         {"data", data},
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
  fmt::print(stderr, "citymesh {} serves {}\n  REST  {}/\n  gRPC  {}\n", version(), data, url,
             to_string(rpc));
}

Result<void> serve(const ServeOptions& options) {
  if (auto checked = check(options); !checked) return checked;
  const StopOnSignal stop;
  Log log(std::cout, log_level(options.log_level));
  const auto access = Access::open(access_options(options));
  if (!access) return access.error();
  auto state = StateFolder::open(options.state);
  if (!state) return state.error();
  const auto data = open_served_data(options, log, stop.token());
  if (!data) return data.error();
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
       .check_inputs = data->check_inputs,
       .estimate = estimator(data->open_to_count),
       .check_callback = [allow_private = options.allow_private_callbacks](const std::string& uri) {
         return check_callback_uri(uri, allow_private);
       }});
  CallbackSender callbacks(**store, callback_json, log, metrics, *std::move(sending));
  WorkerPool workers(**store, **store, **results, data->open, log, metrics,
                     worker_options(options, *data, **access));
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
  announce(log, options, data->name, {options.listen.host, *rest_port},
           {options.grpc.host, *rpc_port});

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
