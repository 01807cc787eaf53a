#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/validate/body.h"
#include "core/validate/boundary.h"
#include "core/validate/findings.h"

namespace citymesh {

/// Checks how the sound shells of a solid lie to each other (4xx); the first is the exterior. Gives
/// the solid when all is well.
std::optional<SolidBody> check_solid_level(std::span<const Boundary> shells, std::string name,
                                           Findings& findings);

/// Checks how the solids of a CompositeSolid lie to each other (501, 502, 503).
void check_composite(std::span<const SolidBody> solids, Findings& findings);

/// Reports every pair whose interiors have points in common, with `code`; false: there is one.
bool check_overlaps(std::span<const SolidBody* const> solids, int code, Findings& findings);

}  // namespace citymesh
