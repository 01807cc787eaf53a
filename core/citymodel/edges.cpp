#include "core/citymodel/edges.h"

#include <algorithm>

namespace citymesh {

EdgeUses edge_uses(const Shell& shell) {
  EdgeUses uses;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f)
    for (const Ring& ring : shell.faces[f].rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
        uses[{std::min(a, b), std::max(a, b)}].push_back({f, a < b});
      }
  return uses;
}

}  // namespace citymesh
