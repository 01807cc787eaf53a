#pragma once

#include <vector>

#include "core/validate/boundary.h"
#include "core/validate/findings.h"
#include "core/validate/validate.h"

namespace citymesh {

/// Checks the rings and polygons of a boundary one by one (1xx, 2xx). When all are sound, fills its
/// triangles and returns true.
bool check_polygons(Boundary& boundary, const ValidateOptions& options, Findings& findings);

/// Whether each polygon is sound by itself.
std::vector<bool> sound_polygons(const Boundary& boundary, const ValidateOptions& options);

}  // namespace citymesh
