#include "core/citymodel/edges.h"

#include <algorithm>

namespace citymesh {

EdgeUses::EdgeUses(const Shell& shell) {
  std::vector<std::pair<EdgeKey, EdgeUse>> all;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f)
    for (const Ring& ring : shell.faces[f].rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i], b = ring[i + 1 == ring.size() ? 0 : i + 1];
        all.emplace_back(EdgeKey{std::min(a, b), std::max(a, b)}, EdgeUse{f, a < b});
      }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  uses_.reserve(all.size());
  for (const auto& [edge, use] : all) uses_.push_back(use);
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first + 1;
    while (last < all.size() && all[last].first == all[first].first) ++last;
    entries_.emplace_back(all[first].first, std::span(uses_).subspan(first, last - first));
    first = last;
  }
}

std::span<const EdgeUse> EdgeUses::of(std::uint32_t a, std::uint32_t b) const {
  const EdgeKey key{std::min(a, b), std::max(a, b)};
  const auto at =
      std::lower_bound(entries_.begin(), entries_.end(), key,
                       [](const Entry& entry, const EdgeKey& k) { return entry.first < k; });
  return at == entries_.end() || at->first != key ? std::span<const EdgeUse>{} : at->second;
}

bool is_closed(const Shell& shell) {
  const EdgeUses uses(shell);
  return std::all_of(uses.begin(), uses.end(), [](const EdgeUses::Entry& edge) {
    return edge.second.size() == 2 && edge.second[0].forward != edge.second[1].forward;
  });
}

}  // namespace citymesh
