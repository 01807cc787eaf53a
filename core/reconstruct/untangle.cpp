#include "core/reconstruct/untangle.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

constexpr std::size_t kMaxCorners = 40;  ///< of a ring that is tried: work grows with the cube

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using EdgeCounts = std::map<Edge, std::int32_t>;

void count(EdgeCounts& counts, const Ring& ring, std::int32_t by) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    counts[std::minmax(ring[i], ring[(i + 1) % ring.size()])] += by;
}

std::size_t shared_edges(const EdgeCounts& counts, const Ring& ring) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto found = counts.find(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
    shared += found != counts.end() && found->second > 0;
  }
  return shared;
}

/// The ring with one run of corners turned round that shares most edges, more than `best_shared`;
/// the shortest run of those.
std::optional<Ring> untangled(const Shell& shell, const EdgeCounts& others, const Ring& ring,
                              std::size_t best_shared) {
  std::optional<Ring> best;
  const std::size_t n = ring.size();
  for (std::size_t length = 2; length + 1 < n; ++length)
    for (std::size_t first = 0; first < n; ++first) {
      Ring turned = ring;
      for (std::size_t k = 0; k < length; ++k)
        turned[(first + k) % n] = ring[(first + length - 1 - k) % n];
      const std::size_t shared = shared_edges(others, turned);
      if (shared <= best_shared) continue;
      if (!triangulate(shell.points, std::vector<Ring>{turned})) continue;
      best_shared = shared;
      best = std::move(turned);
    }
  return best;
}

}  // namespace

void untangle(Shell& shell) {
  EdgeCounts counts;
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings) count(counts, ring, 1);
  for (Face& face : shell.faces)
    for (Ring& ring : face.rings) {
      if (ring.size() < 4 || ring.size() > kMaxCorners) continue;
      count(counts, ring, -1);
      const std::size_t shared = shared_edges(counts, ring);
      if (shared + 1 < ring.size()) {
        const bool crosses = !triangulate(shell.points, std::vector<Ring>{ring});
        const std::size_t enough = crosses ? shared : ring.size() - 1;
        if (auto better = untangled(shell, counts, ring, enough)) ring = std::move(*better);
      }
      count(counts, ring, 1);
    }
}

}  // namespace citymesh
