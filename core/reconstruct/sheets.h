#pragma once

#include <vector>

#include "core/citymodel/shell.h"

namespace citymesh {

/// Triangles of a face; of a face whose rings cross, a fan over its exterior.
std::vector<Triangle> sheet_of(const Shell& shell, const Face& face);

}  // namespace citymesh
