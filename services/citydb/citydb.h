#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/source/source.h"

namespace citymesh {

struct CityDbOptions {
  std::string url{};  ///< as libpq takes it: postgresql://user:password@host:5432/database
  std::string schema = "citydb";
  unsigned max_connections = 4;  ///< at the same time; who needs one more waits
  int connect_timeout_s = 10;
  int statement_timeout_s = 600;  ///< of one statement; 0: none
  std::uint32_t chunk = 500;      ///< buildings read with one set of statements, at most 1000
  ReadLimits limits{};
};

/// Opens sources that read one 3DCityDB of version 4 or 5 (PostgreSQL with PostGIS).
using CityDbFactory = std::function<Result<std::unique_ptr<CitySource>>()>;

/// The sources share their connections. A selection and the reading of it see the same snapshot of
/// the database (REPEATABLE READ, READ ONLY) and hold a connection from the one to the end of the
/// other. `select` is tried once more when its connection turns out to be lost; `read` is not, for
/// the snapshot is gone with the connection: Unavailable. Coordinates count as PostGIS has them, x
/// east. Errors: those of a first look at the database.
Result<CityDbFactory> open_citydb(const CityDbOptions& options);

/// What may be shown of a database's URL: no user, no password.
Result<std::string> shown_citydb_url(const std::string& url);

}  // namespace citymesh
