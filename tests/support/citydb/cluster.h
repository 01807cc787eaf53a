#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh::citydb_support {

/// A private PostgreSQL with PostGIS on a unix socket in a temporary folder. Server and folder go
/// away with this object and with the process that has it, however that ends.
class Cluster {
 public:
  /// Errors: Unimplemented when PostgreSQL or PostGIS is not installed, naming the packages.
  static Result<std::unique_ptr<Cluster>> start();
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  /// postgresql:///NAME?host=… for libpq, as a superuser.
  std::string url(std::string_view database) const;

  Result<void> stop() { return tell("stop"); }  ///< ends all connections, keeps the data
  Result<void> kill() { return tell("kill"); }  ///< as a crash does
  Result<void> start_again() { return tell("start"); }
  Result<void> restart();

 private:
  Cluster(pid_t child, int commands, int answers)
      : child_(child), commands_(commands), answers_(answers) {}
  Result<void> tell(const std::string& command);
  std::string answer();

  pid_t child_;
  int commands_, answers_;
  std::string folder_{};
};

}  // namespace citymesh::citydb_support
