#include "core/citymodel/spikes.h"

#include <cstddef>
#include <utility>

namespace citymesh {

bool drop_repeats_and_spikes(Ring& ring) {
  Ring kept;
  kept.reserve(ring.size());
  for (const std::uint32_t corner : ring)
    if (kept.size() > 1 && kept[kept.size() - 2] == corner)
      kept.pop_back();
    else if (kept.empty() || kept.back() != corner)
      kept.push_back(corner);
  // What is left of them lies around the start.
  std::size_t first = 0;
  while (kept.size() - first > 1) {
    const std::size_t last = kept.size() - 1;
    if (kept[last] == kept[first]) {
      ++first;
    } else if (last - first > 1 && kept[last] == kept[first + 1]) {
      first += 2;
    } else if (last - first > 1 && kept[last - 1] == kept[first]) {
      kept.pop_back();
      ++first;
    } else {
      break;
    }
  }
  kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(first));
  const bool changed = kept.size() != ring.size();
  if (kept.size() < 3) kept.clear();
  ring = std::move(kept);
  return changed;
}

}  // namespace citymesh
