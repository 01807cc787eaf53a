#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "tests/support/citydb/database.h"
#include "tests/support/citydb/loader.h"
#include "tests/support/citydb/stored_feature.h"

namespace citymesh::citydb_support {

/// Collects the rows of buildings and writes them.
class Store {
 public:
  virtual ~Store() = default;
  virtual void add(const StoredFeature& feature) = 0;
  virtual std::size_t bytes() const = 0;
  virtual Result<void> flush() = 0;
};

/// Ids go on behind those of the database.
Result<std::unique_ptr<Store>> open_store_v4(Database& database, const LoadOptions& options,
                                             LoadReport& report);
Result<std::unique_ptr<Store>> open_store_v5(Database& database, const LoadOptions& options,
                                             LoadReport& report);

}  // namespace citymesh::citydb_support
