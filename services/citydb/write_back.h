#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "services/jobs/write_back.h"

namespace citymesh {

struct WriteBackOptions {
  std::string url{};            ///< as libpq takes it, of a user who may write
  std::string schema{};         ///< a 3DCityDB of version 4 or 5
  std::string source_schema{};  ///< that jobs read; must be another one, in whatever database
  int connect_timeout_s = 10;
  int statement_timeout_s = 600;  ///< of one statement; 0: none
};

/// Jobs write to one 3DCityDB as its importers do: a building with its gml:id, its solids and
/// boundary surfaces, in the CRS of the schema. `lineage` is the id of the job, `reason_for_update`
/// names process and rung. Each attempt has one connection and one transaction. Versions of a
/// building that were current before get the termination date of the transaction. Interior shells
/// have no place in 3DCityDB: they are left out, with a warning.
///
/// Errors: InvalidArgument for the schema that is read, those of a first look at the database.
Result<std::unique_ptr<WriteBackStore>> open_write_back(WriteBackOptions options);

}  // namespace citymesh
