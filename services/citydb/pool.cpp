#include "services/citydb/pool.h"

#include <utility>

namespace citymesh::postgres {

Pool::Pool(ConnectionOptions options, std::string schema, unsigned max_connections)
    : options_(std::move(options)), schema_(std::move(schema)), max_connections_(max_connections) {}

Result<Pool::Lease> Pool::lease(const std::stop_token& stop) {
  std::unique_ptr<Connection> connection;
  {
    std::unique_lock lock(mutex_);
    if (!freed_.wait(lock, stop, [&] { return lent_ < max_connections_; }))
      return fail(ErrorCode::Cancelled, "stopped while waiting for a connection to the database");
    ++lent_;
    if (!idle_.empty()) {
      connection = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!connection) {
    auto opened = connect(stop);
    if (!opened) {
      take_back(nullptr);
      return opened.error();
    }
    connection = *std::move(opened);
  }
  return Lease(shared_from_this(), std::move(connection));
}

void Pool::drop_idle() {
  std::vector<std::unique_ptr<Connection>> dropped;
  const std::scoped_lock lock(mutex_);
  dropped.swap(idle_);
}

void Pool::take_back(std::unique_ptr<Connection> connection) {
  if (connection) connection->roll_back();
  {
    const std::scoped_lock lock(mutex_);
    --lent_;
    if (connection && connection->usable()) idle_.push_back(std::move(connection));
  }
  freed_.notify_one();
}

Result<std::unique_ptr<Connection>> Pool::connect(const std::stop_token& stop) {
  auto opened = Connection::open(options_);
  if (!opened) return opened.error();
  auto connection = std::make_unique<Connection>(*std::move(opened));
  if (auto chosen = connection->set_schema(schema_, stop); !chosen) return chosen.error();
  return connection;
}

}  // namespace citymesh::postgres
