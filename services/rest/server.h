#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.h"

namespace citymesh {

class Access;
class JobManager;
class Log;
class Metrics;

/// PEM files. Empty: no TLS.
struct TlsFiles {
  std::filesystem::path certificate{};  ///< with those that issued it behind it
  std::filesystem::path key{};
};

struct RestOptions {
  std::string host = "127.0.0.1";  ///< address to listen on
  std::uint16_t port = 8080;       ///< 0: any free port, which start() returns
  std::string public_url{};        ///< base of all links; empty: http:// and the request's Host
  std::uint64_t max_body_bytes = 1 << 20;
  std::uint32_t max_header_bytes = 16 << 10;
  std::uint32_t max_connections = 1024;  ///< more are answered with 503 and closed
  /// The same of one address, if that is neither on this machine nor a trusted proxy; 0: no limit.
  std::uint32_t max_client_connections = 0;
  std::uint64_t max_inline_bytes = 16 << 20;  ///< larger results in a document are given as links
  double sync_wait_s = 30;  ///< longest wait of a synchronous execution, then a job is the answer
  unsigned io_threads = 2;
  /// Store and result files are read here, never on an I/O thread. Most of them wait for the disk,
  /// and what waits together is committed together.
  unsigned handler_threads = 32;
  double idle_timeout_s = 60;       ///< of an open connection between two requests
  double header_timeout_s = 10;     ///< from a header's first byte to its last; of TLS's greeting
  double body_timeout_s = 60;       ///< until a request's body is complete
  double write_timeout_s = 60;      ///< without any progress of a response
  double drain_timeout_s = 5;       ///< responses under way get this long when stopping
  std::string cors_allow_origin{};  ///< see Cors
  TlsFiles tls{};
  const Access* access = nullptr;  ///< who may do what, outlives the server; null: everybody all
  Log* log = nullptr;              ///< outlives the server; null: nothing is logged
};

/// OGC API - Processes 1.0 over HTTP/1.1. Translates to and from JobManager; keeps no state of its
/// own.
class RestServer {
 public:
  /// `jobs` and `metrics` must outlive the server.
  RestServer(JobManager& jobs, Metrics& metrics, RestOptions options);
  ~RestServer();  ///< stops
  RestServer(const RestServer&) = delete;
  RestServer& operator=(const RestServer&) = delete;

  /// Listens and serves on threads of its own; returns the port. Errors: InvalidArgument for a host
  /// that is no address and for TLS files that cannot be used, Unavailable when the port is taken.
  Result<std::uint16_t> start();

  /// Accepts nothing new, lets responses under way finish within `drain_timeout_s`, then closes.
  /// May be called twice.
  void stop();

  /// Reads the TLS files again if they have changed, for connections to come; from one thread at a
  /// time. After an error those read before stay in use.
  Result<void> reload_tls();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
