#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/pipeline/process_building.h"

namespace citymesh {

/// Bodies of a building and its parts that overlap become bodies that touch: see share_space.h for
/// who gives way. Bodies that do not overlap stay as they are. A part of which nothing is left is
/// `merged` into the one that has most of its space. Where a result passes no gate the bodies stay
/// as they are; pairs that still overlap in the end are reported (C121). Installations are not
/// looked at.
void separate_parts(BuildingReport& report, std::vector<Body>& bodies,
                    std::vector<std::uint64_t>& fingerprints, const Inputs& inputs,
                    const std::vector<OpenFormat>& formats, const RunContext& context);

}  // namespace citymesh
