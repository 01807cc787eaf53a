#include "core/geometry/patch.h"

#include <cmath>
#include <limits>

#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

constexpr double kUprightSlope = 0.1;  ///< of the normal, within 6 degrees of the horizontal
constexpr double kUprightWeight = 0.25;

double weight(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const Point3 n = normal_of(a, b, c);
  const double area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  return std::abs(n.z) <= kUprightSlope * area ? kUprightWeight * area : area;
}

}  // namespace

std::optional<std::vector<Triangle>> minimal_patch(std::span<const GridPoint> points,
                                                   std::span<const std::uint32_t> loop) {
  const std::size_t n = loop.size();
  if (n < 3 || n > kMaxPatchCorners) return {};
  // best[i][j]: of the part of the loop from i to j, closed by the chord j→i.
  std::vector<double> best(n * n, 0);
  std::vector<std::uint32_t> apex(n * n, 0);
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      double lowest = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sum = best[i * n + k] + best[k * n + j] +
                           weight(points[loop[i]], points[loop[k]], points[loop[j]]);
        if (sum < lowest) {
          lowest = sum;
          apex[i * n + j] = static_cast<std::uint32_t>(k);
        }
      }
      best[i * n + j] = lowest;
    }
  std::vector<Triangle> triangles;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, n - 1}};
  while (!parts.empty()) {
    const auto [i, j] = parts.back();
    parts.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    triangles.push_back({loop[i], loop[k], loop[j]});
    parts.emplace_back(i, k);
    parts.emplace_back(k, j);
  }
  return triangles;
}

}  // namespace citymesh
