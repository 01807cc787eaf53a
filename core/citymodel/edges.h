#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/citymodel/shell.h"

namespace citymesh {

/// How a face walks an edge.
struct EdgeUse {
  std::uint32_t face = 0;
  bool forward = true;  ///< from the lower to the higher vertex
};

using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;  ///< vertices, lower first
using EdgeUses = std::map<EdgeKey, std::vector<EdgeUse>>;

EdgeUses edge_uses(const Shell& shell);

}  // namespace citymesh
