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

struct RpcOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 50051;  ///< 0: any free port, which start() returns
  int max_message_bytes = 1 << 20;
  std::uint32_t max_watches = 256;  ///< Watch streams at the same time; more: RESOURCE_EXHAUSTED
  std::filesystem::path tls_certificate{};  ///< PEM, read again when it changes; empty: no TLS
  std::filesystem::path tls_key{};
  std::string links_base{};  ///< of REST: what subscribers are told has links that begin with it
  const Access* access = nullptr;  ///< who may do what, outlives the server; null: everybody all
  Log* log = nullptr;              ///< outlives the server; null: nothing is logged
};

/// The service Jobs of proto/citymesh/v1 with health and reflection. Translates to and from
/// JobManager; keeps no state of its own.
class RpcServer {
 public:
  /// `jobs` and `metrics` must outlive the server.
  RpcServer(JobManager& jobs, Metrics& metrics, RpcOptions options);
  ~RpcServer();  ///< stops
  RpcServer(const RpcServer&) = delete;
  RpcServer& operator=(const RpcServer&) = delete;

  /// Serves on threads of its own; returns the port. Errors: Unavailable when it cannot listen,
  /// InvalidArgument for TLS files that are not there.
  Result<std::uint16_t> start();

  /// Ends open streams and returns when all calls have ended. May be called twice.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
