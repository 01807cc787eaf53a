#pragma once

#include <memory>
#include <vector>

#include "core/source/catalogue.h"
#include "core/source/frame.h"

namespace citymesh::source {

/// A selection and what reading it needs.
struct Plan {
  struct File {
    std::shared_ptr<const FileRecord> record{};
    std::vector<SrsUse> srs{};
    std::vector<BuildingRecord> selected{};  ///< without footprints
  };
  Selection selection{};
  std::vector<File> files{};
};

/// Chooses working CRS, origin and buildings. Errors: as CitySource::select, and the catalogue's.
Result<Plan> make_plan(Catalogue& catalogue, const BuildingQuery& query, const Crs& assumed_crs,
                       const RunContext& context);

/// The source CRS as it is taken: one that is not stated is the one that the query names.
Crs source_crs(const SrsUse& use, const BuildingQuery& query);

}  // namespace citymesh::source
