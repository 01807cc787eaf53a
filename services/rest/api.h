#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/access/access.h"
#include "services/jobs/job_manager.h"
#include "services/rest/cors.h"
#include "services/rest/message.h"
#include "services/telemetry/metrics.h"

namespace citymesh {

class Log;

struct ApiOptions {
  std::string public_url{};         ///< base of all links; empty: http:// and the request's Host
  std::string cors_allow_origin{};  ///< see Cors
  std::uint64_t max_inline_bytes = 16 << 20;
  double sync_wait_s = 30;  ///< how long a synchronous execution is waited for; 0: none is
  /// Who may do what; must outlive the API.
  const Access* access = &Access::for_everybody();
  Log* log = nullptr;  ///< must outlive the API; null: nothing is logged
};

/// The resources of OGC API - Processes 1.0 as a function from request to response; it knows no
/// socket. Thread-safe; may block on the stores.
class Api {
 public:
  Api(JobManager& jobs, Metrics& metrics, ApiOptions options);

  /// Always answers: what is wrong with a request becomes a problem document. A HEAD request gets
  /// the answer of GET; its body is not to be sent. An answer that has to wait for a job says so in
  /// `follow`.
  Response handle(const Request& request) const;

  /// Whether everybody may use a path of the description, whoever else has to show who he is.
  static bool is_open(std::string_view method, std::string_view path);

 private:
  /// A request with what routing found out about it.
  struct Call {
    const Request& request;
    std::string method;  ///< GET also for HEAD
    Target target;
    std::string base;                 ///< scheme, host and prefix of links, no slash at the end
    std::vector<std::string> values;  ///< what the pattern's braces stand for
    std::string accept;
    std::string trace_id;
    Client client{};
  };
  struct Route {
    std::string_view method;
    std::string_view pattern;
    Response (Api::*handler)(const Call& call) const;
    Role needs = Role::None;
  };
  static const Route kRoutes[];

  /// What is told of a request when it has been answered.
  struct Record {
    std::string method{};
    std::string_view route = "none";  ///< its pattern
    std::string trace_id{};
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  };

  Response dispatch(const Request& request, Record& record) const;
  std::optional<Response> refusal(const Route& route, const std::string& address, Call& call) const;
  void tell(const Record& record, int status) const;
  void add_common_headers(const Request& request, Response& response) const;

  Response landing(const Call& call) const;
  Response conformance(const Call& call) const;
  Response api_definition(const Call& call) const;
  Response process_list(const Call& call) const;
  Response process(const Call& call) const;
  Response execute(const Call& call) const;
  Response estimate(const Call& call, const AskedJob& asked) const;
  Response job_list(const Call& call) const;
  Response job(const Call& call) const;
  Response dismiss(const Call& call) const;
  Response events(const Call& call) const;
  Response results(const Call& call) const;
  Response result(const Call& call) const;
  Response healthz(const Call& call) const;
  Response readyz(const Call& call) const;
  Response metrics(const Call& call) const;

  Result<Job> find_job(const Call& call) const;
  Response status_response(const Call& call, const Job& job) const;

  JobManager& jobs_;
  Metrics& metrics_;
  ApiOptions options_;
  Cors cors_;
};

}  // namespace citymesh
