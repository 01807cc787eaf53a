#pragma once

#include <vector>

#include "core/geometry/arrangement.h"

namespace citymesh {

/// Triangles over the vertices of an arrangement that close its boundary: with them every edge is
/// walked as often one way as the other. Loops that are too long to patch stay open.
std::vector<Triangle> closing_triangles(const Arrangement& arrangement);

}  // namespace citymesh
