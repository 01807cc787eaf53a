#pragma once

#include "core/validate/boundary.h"
#include "core/validate/findings.h"

namespace citymesh {

enum class ShellKind { Closed, Surface };  ///< a CompositeSurface need not be closed

/// Checks how the sound polygons of a boundary fit together (3xx); true: they do. The order is
/// val3dity's: too few polygons; edges, vertices and orientation; pieces and holes; intersections
/// are looked for only where all else is well.
bool check_shell_level(const Boundary& boundary, ShellKind kind, Findings& findings);

}  // namespace citymesh
