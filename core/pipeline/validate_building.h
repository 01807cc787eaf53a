#pragma once

#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/report.h"
#include "core/pipeline/process_building.h"
#include "core/processes/inputs.h"
#include "core/validate/neighbours.h"

namespace citymesh {

struct ValidatedBuilding {
  BuildingReport report{};
  std::vector<SolidBody> solids{};  ///< to compare with its neighbours
};

/// Finds the defects of one building and its parts and changes nothing.
ValidatedBuilding validate_building(const NamedBuilding& named, const Inputs& inputs);

/// Validates buildings batch by batch, each also against those that came before it.
class Validation {
 public:
  explicit Validation(const Inputs& inputs);

  /// Reports in the order of the batch; some are missing when a stop was requested.
  std::vector<BuildingReport> validate(std::span<const NamedBuilding> batch,
                                       const RunContext& context);

  /// false: there were more buildings than neighbours can be looked for among.
  bool compared_all() const { return neighbours_.complete(); }

 private:
  const Inputs& inputs_;
  Neighbours neighbours_;
};

}  // namespace citymesh
