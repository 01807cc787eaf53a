#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "services/citydb/postgres.h"

namespace citymesh::postgres {

/// Connections that are used again. Thread-safe; must outlive its leases, hence shared.
class Pool : public std::enable_shared_from_this<Pool> {
 public:
  /// `schema` comes first on the search path of each connection.
  Pool(ConnectionOptions options, std::string schema, unsigned max_connections);

  /// A connection on loan, given back when it goes.
  class Lease {
   public:
    Lease(std::shared_ptr<Pool> pool, std::unique_ptr<Connection> connection)
        : pool_(std::move(pool)), connection_(std::move(connection)) {}
    Lease(Lease&&) noexcept = default;
    Lease& operator=(Lease&&) noexcept = default;
    ~Lease() {
      if (connection_) pool_->take_back(std::move(connection_));
    }
    Connection& operator*() const { return *connection_; }
    Connection* operator->() const { return connection_.get(); }

   private:
    std::shared_ptr<Pool> pool_;
    std::unique_ptr<Connection> connection_;
  };

  /// Waits for a connection to become free. Errors: Cancelled when stopped, those of
  /// Connection::open.
  Result<Lease> lease(const std::stop_token& stop);
  /// Those that nobody uses are closed: one of them turned out to be lost.
  void drop_idle();

 private:
  void take_back(std::unique_ptr<Connection> connection);
  Result<std::unique_ptr<Connection>> connect(const std::stop_token& stop);

  const ConnectionOptions options_;
  const std::string schema_;
  const unsigned max_connections_;
  std::mutex mutex_{};
  std::condition_variable_any freed_{};
  unsigned lent_ = 0;
  std::vector<std::unique_ptr<Connection>> idle_{};
};

}  // namespace citymesh::postgres
