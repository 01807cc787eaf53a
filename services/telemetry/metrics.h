#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace citymesh {

/// What an operator plots, in Prometheus' text format. Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void job_started(std::string_view process);
  /// `state`: an OGC job state, or `released` when a shutdown handed the job back.
  void job_ended(std::string_view process, std::string_view state, double seconds);
  void stage_took(std::string_view process, std::string_view stage, double seconds);
  /// `outcome`: delivered, merged, dropped.
  void buildings(std::string_view outcome, std::uint64_t count);
  /// Found in the input; `code` as in the reports: 303, C105.
  void issues(std::string_view code, std::uint64_t count);
  /// An attempt to tell a subscriber. `outcome`: delivered, retried (tried again later), given_up.
  void callback(std::string_view outcome);
  /// A job was answered from those of an earlier one.
  void results_reused();
  void set_queue(std::uint64_t jobs, double oldest_age_s);

  /// `route` is the pattern (`/jobs/{id}`), never the path: labels must stay few.
  void http_request(std::string_view method, std::string_view route, int status, double seconds);
  void rpc_request(std::string_view method, std::string_view code, double seconds);

  /// Called before every text(), to set gauges that are read from elsewhere.
  void on_collect(std::function<void()> refresh);

  std::string text() const;  ///< text/plain; version=0.0.4

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
