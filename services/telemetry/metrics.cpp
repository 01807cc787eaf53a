#include "services/telemetry/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <mutex>
#include <utility>

#include "core/base/version.h"

namespace citymesh {
namespace {

using prometheus::Histogram;

const Histogram::BucketBoundaries kRequestSeconds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                  0.1,   0.25,   0.5,   1,    2.5,   10};
const Histogram::BucketBoundaries kWorkSeconds{0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3600};

std::string text_of(std::string_view text) { return std::string(text); }

}  // namespace

struct Metrics::Impl {
  prometheus::Registry registry{};
  prometheus::Family<prometheus::Counter>& jobs =
      prometheus::BuildCounter()
          .Name("citymesh_jobs_total")
          .Help("Runs of jobs that ended, by process and state")
          .Register(registry);
  prometheus::Family<prometheus::Gauge>& running = prometheus::BuildGauge()
                                                       .Name("citymesh_jobs_running")
                                                       .Help("Jobs being worked on in this process")
                                                       .Register(registry);
  prometheus::Family<prometheus::Histogram>& job_seconds = prometheus::BuildHistogram()
                                                               .Name("citymesh_job_seconds")
                                                               .Help("Time from claim to end")
                                                               .Register(registry);
  prometheus::Family<prometheus::Histogram>& stage_seconds =
      prometheus::BuildHistogram()
          .Name("citymesh_stage_seconds")
          .Help("Time that a job spent in a stage")
          .Register(registry);
  prometheus::Family<prometheus::Counter>& buildings =
      prometheus::BuildCounter()
          .Name("citymesh_buildings_total")
          .Help("Buildings of successful jobs by outcome")
          .Register(registry);
  prometheus::Family<prometheus::Counter>& issues =
      prometheus::BuildCounter()
          .Name("citymesh_issues_total")
          .Help("Issues found in the buildings of successful jobs, by code")
          .Register(registry);
  prometheus::Family<prometheus::Counter>& callbacks =
      prometheus::BuildCounter()
          .Name("citymesh_callbacks_total")
          .Help("Attempts to tell the subscribers of jobs, by outcome")
          .Register(registry);
  prometheus::Counter& cache_hits = prometheus::BuildCounter()
                                        .Name("citymesh_result_cache_hits_total")
                                        .Help("Jobs answered from the results of an earlier one")
                                        .Register(registry)
                                        .Add({});
  prometheus::Gauge& queue_age = prometheus::BuildGauge()
                                     .Name("citymesh_queue_age_seconds")
                                     .Help("Age of the oldest job that waits for a worker")
                                     .Register(registry)
                                     .Add({});
  prometheus::Gauge& queue_length = prometheus::BuildGauge()
                                        .Name("citymesh_queue_length")
                                        .Help("Jobs that wait for a worker")
                                        .Register(registry)
                                        .Add({});
  prometheus::Family<prometheus::Counter>& http = prometheus::BuildCounter()
                                                      .Name("citymesh_http_requests_total")
                                                      .Help("HTTP requests answered")
                                                      .Register(registry);
  prometheus::Family<prometheus::Histogram>& http_seconds =
      prometheus::BuildHistogram()
          .Name("citymesh_http_request_seconds")
          .Help("Time to answer an HTTP request")
          .Register(registry);
  prometheus::Family<prometheus::Counter>& rpc = prometheus::BuildCounter()
                                                     .Name("citymesh_grpc_requests_total")
                                                     .Help("gRPC calls answered")
                                                     .Register(registry);
  prometheus::Family<prometheus::Histogram>& rpc_seconds =
      prometheus::BuildHistogram()
          .Name("citymesh_grpc_request_seconds")
          .Help("Time to answer a gRPC call; streams: until their end")
          .Register(registry);

  mutable std::mutex refresh_mutex{};
  std::function<void()> refresh{};
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {
  prometheus::BuildGauge()
      .Name("citymesh_info")
      .Help("Constant 1, labelled with the version")
      .Register(impl_->registry)
      .Add({{"version", text_of(version())}})
      .Set(1);
  for (const auto* outcome : {"delivered", "retried", "given_up"})
    impl_->callbacks.Add({{"outcome", outcome}});
}

Metrics::~Metrics() = default;

void Metrics::job_started(std::string_view process) {
  impl_->running.Add({{"process", text_of(process)}}).Increment();
}

void Metrics::job_ended(std::string_view process, std::string_view state, double seconds) {
  impl_->running.Add({{"process", text_of(process)}}).Decrement();
  impl_->jobs.Add({{"process", text_of(process)}, {"state", text_of(state)}}).Increment();
  impl_->job_seconds.Add({{"process", text_of(process)}}, kWorkSeconds).Observe(seconds);
}

void Metrics::stage_took(std::string_view process, std::string_view stage, double seconds) {
  impl_->stage_seconds.Add({{"process", text_of(process)}, {"stage", text_of(stage)}}, kWorkSeconds)
      .Observe(seconds);
}

void Metrics::buildings(std::string_view outcome, std::uint64_t count) {
  impl_->buildings.Add({{"outcome", text_of(outcome)}}).Increment(static_cast<double>(count));
}

void Metrics::issues(std::string_view code, std::uint64_t count) {
  impl_->issues.Add({{"code", text_of(code)}}).Increment(static_cast<double>(count));
}

void Metrics::callback(std::string_view outcome) {
  impl_->callbacks.Add({{"outcome", text_of(outcome)}}).Increment();
}

void Metrics::results_reused() { impl_->cache_hits.Increment(); }

void Metrics::set_queue(std::uint64_t jobs, double oldest_age_s) {
  impl_->queue_length.Set(static_cast<double>(jobs));
  impl_->queue_age.Set(oldest_age_s);
}

void Metrics::http_request(std::string_view method, std::string_view route, int status,
                           double seconds) {
  impl_->http
      .Add({{"method", text_of(method)},
            {"route", text_of(route)},
            {"status", std::to_string(status)}})
      .Increment();
  impl_->http_seconds.Add({{"method", text_of(method)}, {"route", text_of(route)}}, kRequestSeconds)
      .Observe(seconds);
}

void Metrics::rpc_request(std::string_view method, std::string_view code, double seconds) {
  impl_->rpc.Add({{"method", text_of(method)}, {"code", text_of(code)}}).Increment();
  impl_->rpc_seconds.Add({{"method", text_of(method)}}, kRequestSeconds).Observe(seconds);
}

void Metrics::on_collect(std::function<void()> refresh) {
  const std::scoped_lock lock(impl_->refresh_mutex);
  impl_->refresh = std::move(refresh);
}

std::string Metrics::text() const {
  {
    const std::scoped_lock lock(impl_->refresh_mutex);
    if (impl_->refresh) impl_->refresh();
  }
  return prometheus::TextSerializer().Serialize(impl_->registry.Collect());
}

}  // namespace citymesh
