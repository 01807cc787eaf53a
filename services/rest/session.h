#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "services/jobs/job_manager.h"
#include "services/rest/api.h"
#include "services/rest/server.h"

namespace boost::asio {
class io_context;
class thread_pool;
namespace ssl {
class context;
}
}  // namespace boost::asio

namespace citymesh {

/// What all connections of a server use; it outlives them.
struct Shared {
  const RestOptions& options;
  JobManager& jobs;
  const Api& api;
  boost::asio::io_context& io;
  boost::asio::thread_pool& handlers;
  const std::atomic<bool>& stopping;
};

/// A connection from its first byte to its last: reads requests, has them handled, writes the
/// answers. Runs on the threads of `io`.
class Session {
 public:
  /// Takes over a connected TCP socket; speaks TLS on it when there is a context.
  Session(const Shared& shared, int socket, std::shared_ptr<boost::asio::ssl::context> tls);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const std::string& peer() const;  ///< address of the other end

  /// Serves until either side ends it, then calls `ended`, once.
  void serve(std::function<void()> ended);
  /// Answers with `why` there is no room for it, whatever it asks, and closes.
  void refuse(std::string why, std::function<void()> ended);
  /// From any thread; what is under way ends soon. `idle_only`: not while a request is answered.
  void close(bool idle_only);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace citymesh
