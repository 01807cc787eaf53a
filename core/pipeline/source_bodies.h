#pragma once

#include <vector>

#include "core/pipeline/process_building.h"

namespace citymesh {

/// The boundaries that the building and its members have in the source, on the grid, each with the
/// issues that the report has of it. What cannot stand on the grid is left out.
std::vector<SourceBody> source_bodies(const NamedBuilding& named, const Inputs& inputs,
                                      const BuildingReport& report);

}  // namespace citymesh
