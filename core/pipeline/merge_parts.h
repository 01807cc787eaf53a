#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/pipeline/process_building.h"

namespace citymesh {

/// The bodies of a building and its parts become one body that bears the building's name: common
/// walls vanish, what overlaps counts once, contacts along a line or in a point are drawn apart.
/// Installations stay bodies of their own. Where the union passes no gate, the bodies stay as they
/// are and the report says so (C120).
void merge_parts(const Building& building, BuildingReport& report, std::vector<Body>& bodies,
                 std::vector<std::uint64_t>& fingerprints, const Inputs& inputs,
                 const std::vector<OpenFormat>& formats, const RunContext& context);

}  // namespace citymesh
