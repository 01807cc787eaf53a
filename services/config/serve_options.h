#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

/// Where a server listens. Port 0: any free one.
struct Endpoint {
  std::string host{};
  std::uint16_t port = 0;
};

/// Reads `HOST:PORT`, `[IPV6]:PORT` or `PORT` (on 127.0.0.1). Errors: InvalidArgument.
Result<Endpoint> parse_endpoint(std::string_view text);
std::string to_string(const Endpoint& endpoint);  ///< as it stands in a URL
bool is_loopback(const Endpoint& endpoint);

/// All settings of `citymesh serve`.
struct ServeOptions {
  // What jobs read: one of the two.
  std::filesystem::path data{};          ///< folder of city models
  std::string source{};                  ///< URL of a 3DCityDB (postgresql://…) or a WFS
  std::string source_schema = "citydb";  ///< of that database
  unsigned source_connections = 4;       ///< to it, at the same time
  int source_timeout_s = 600;            ///< of one statement; 0: none

  std::string write_back_schema{};  ///< where jobs may write back to; empty: they may not
  std::string write_back_url{};     ///< of its database, with a user who may; empty: as `source`

  std::filesystem::path state = "citymesh-state";  ///< jobs and results
  Endpoint listen{"127.0.0.1", 8080};              ///< REST
  Endpoint grpc{"127.0.0.1", 50051};
  std::string public_url{};  ///< base of all links; empty: from the request

  // Who may do what. With neither keys nor tokens everybody may do everything.
  std::filesystem::path api_keys{};  ///< file that `make-key` makes the lines of
  std::string oidc_jwks{};           ///< public keys of those who issue tokens: a file or a URL
  std::string oidc_issuer{};         ///< `iss` of tokens
  std::string oidc_audience{};       ///< `aud` of tokens
  std::string oidc_role_claim = "roles";
  std::string oidc_role_prefix = "citymesh:";  ///< of the names in that claim that count
  std::filesystem::path tls_certificate{};     ///< PEM, of REST and gRPC; empty: no TLS
  std::filesystem::path tls_key{};
  bool insecure = false;          ///< everybody on the network may do everything, and is meant to
  std::string trusted_proxies{};  ///< networks whose forwarded headers are believed
  /// Web pages of other origins that may use the REST API: `*`, or origins by comma; empty: none.
  std::string cors_allow_origin{};

  std::filesystem::path callback_secret{};  ///< file whose content signs messages to subscribers
  bool allow_private_callbacks = false;     ///< subscribers may also be in the own network

  unsigned workers = 1;            ///< jobs worked on at the same time
  unsigned threads = 0;            ///< threads of all workers together; 0: one per core
  double lease_s = 30;             ///< a worker not heard of for so long counts as dead
  std::uint32_t max_attempts = 3;  ///< deaths of a worker after which its job is failed
  double job_timeout_s = 0;        ///< a job that runs longer is failed; 0: no limit

  // What one job may take and make; 0: no limit.
  double max_job_area_km2 = 1000;              ///< of its box
  std::uint64_t max_job_buildings = 200'000;   ///< selected
  std::uint64_t max_job_points = 100'000'000;  ///< of its buildings
  std::uint64_t max_job_bytes = 16ull << 30;   ///< of its results

  std::string result_cache = "on";     ///< off: every job is worked on, also what was asked before
  double keep_results_s = 7 * 86400;   ///< after a job's end; 0: for ever
  double keep_jobs_s = 30 * 86400;     ///< the record of an ended job; 0: for ever
  std::uint64_t max_result_bytes = 0;  ///< of all jobs; the oldest results go first; 0: no limit

  std::uint32_t max_open_jobs = 1000;          ///< accepted and running; more are refused
  std::uint32_t max_client_jobs = 100;         ///< the same of each client; 0: no limit of its own
  std::uint64_t max_body_bytes = 1 << 20;      ///< of a request, REST and gRPC
  std::uint32_t max_connections = 1024;        ///< REST
  std::uint32_t max_client_connections = 256;  ///< the same of one address; 0: no limit of its own
  double idle_timeout_s = 60;                  ///< of a REST connection between two requests
  double header_timeout_s = 10;                ///< for a request's header to come
  double body_timeout_s = 60;                  ///< for a request's body to come
  double sync_wait_s = 30;  ///< longest wait of a synchronous execution; 0: every one is a job
  std::uint32_t max_watches = 256;  ///< gRPC streams open at the same time

  std::string log_level = "info";  ///< debug, info, warning, error
};

/// A text without the passwords of the URLs and connection strings in it.
std::string without_passwords(const std::string& text);

/// Errors: InvalidArgument naming the first setting that cannot be used, its value and what is
/// expected.
Result<void> check(const ServeOptions& options);

}  // namespace citymesh
