#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/geometry/measure.h"
#include "core/heal/steps.h"

namespace citymesh {

void snap_points(Shell& shell, StepContext& context) {
  const auto cell_size = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(context.tolerance_m * kGridStepsPerMetre));
  const auto key_of = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 73856093u ^ static_cast<std::uint64_t>(y) * 19349663u ^
           static_cast<std::uint64_t>(z) * 83492791u;
  };
  const auto cell = [&](std::int64_t v) {
    return v >= 0 ? v / cell_size : -((-v + cell_size - 1) / cell_size);
  };

  // Representatives are chosen in x, y, z order, so the result does not depend on the order of the
  // faces.
  std::vector<std::uint32_t> order(shell.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return shell.points[a] < shell.points[b]; });
  std::unordered_multimap<std::uint64_t, std::uint32_t> representatives;
  representatives.reserve(order.size());
  std::vector<std::uint32_t> moved_to(shell.points.size());
  for (const std::uint32_t i : order) {
    const GridPoint& p = shell.points[i];
    std::uint32_t nearest = i;
    double nearest_m = context.tolerance_m;
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto [first, last] =
              representatives.equal_range(key_of(cell(p.x) + dx, cell(p.y) + dy, cell(p.z) + dz));
          for (auto it = first; it != last; ++it) {
            const double d = distance_m(p, shell.points[it->second]);
            if (d < nearest_m || (d == nearest_m && nearest != i &&
                                  shell.points[it->second] < shell.points[nearest])) {
              nearest = it->second;
              nearest_m = d;
            }
          }
        }
    moved_to[i] = nearest;
    if (nearest == i) {
      representatives.emplace(key_of(cell(p.x), cell(p.y), cell(p.z)), i);
    } else {
      context.note("snapped", p, nearest_m);
    }
  }
  for (Face& face : shell.faces)
    for (Ring& ring : face.rings)
      for (std::uint32_t& corner : ring) corner = moved_to[corner];
}

}  // namespace citymesh
