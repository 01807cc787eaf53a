#pragma once

#include <memory>
#include <vector>

#include "core/source/frame.h"
#include "core/source/source.h"

namespace citymesh::source {

/// A selection and what reading it needs.
struct Plan {
  struct File {
    std::shared_ptr<const FileScan> scan{};
    std::vector<SrsUse> srs{};
    std::vector<bool> selected{};  ///< by building
  };
  Selection selection{};
  std::vector<File> files{};
};

/// Chooses working CRS, origin and buildings. Errors: as CitySource::select.
Result<Plan> make_plan(const std::vector<std::shared_ptr<const FileScan>>& scans,
                       const BuildingQuery& query, const Crs& assumed_crs);

/// The source CRS as it is taken: one that is not stated is the one that the query names.
Crs source_crs(const SrsUse& use, const BuildingQuery& query);

}  // namespace citymesh::source
