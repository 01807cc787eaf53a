#include <algorithm>
#include <bit>
#include <cmath>

#include "core/gates/gates.h"

namespace citymesh {
namespace {

// A decimal with four places is one rounding to double away from its grid point.
constexpr double kTextTolerance_steps = 1e-3;

// Beyond this a float32 may be nearer to another grid point than to the one that was meant.
constexpr double kFloat32Limit_m = 1024.0;

/// How far rounding to float32 moves a value, in grid steps: half a unit in its last place.
double float32_tolerance_steps(double value) {
  if (value == 0.0) return kTextTolerance_steps;
  return std::ldexp(1.0, std::ilogb(value) - 24) * kGridStepsPerMetre + kTextTolerance_steps;
}

bool to_grid(double value, bool float32, double centre, std::int64_t& steps) {
  const double scaled = value * kGridStepsPerMetre;
  if (!(std::abs(scaled) <= static_cast<double>(kGridLimit))) return false;
  if (float32 && !(std::abs(value - centre) <= kFloat32Limit_m)) return false;
  steps = std::llround(scaled);
  const double tolerance = float32 ? float32_tolerance_steps(value - centre) : kTextTolerance_steps;
  return std::abs(scaled - static_cast<double>(steps)) <= tolerance;
}

/// Open addressing over the points seen so far; small, and the same order for every run.
class PointIndex {
 public:
  explicit PointIndex(std::size_t expected)
      : slots_(std::bit_ceil(std::max<std::size_t>(16, 2 * expected)), 0) {}

  std::uint32_t index_of(const GridPoint& p, std::vector<GridPoint>& points) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = hash(p) & mask;; at = (at + 1) & mask) {
      if (slots_[at] == 0) {
        points.push_back(p);
        slots_[at] = static_cast<std::uint32_t>(points.size());
      }
      if (points[slots_[at] - 1] == p) return slots_[at] - 1;
    }
  }

 private:
  static std::size_t hash(const GridPoint& p) {
    std::uint64_t h = static_cast<std::uint64_t>(p.x) * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(p.y)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(p.z)) * 0x94D049BB133111EBull;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }

  std::vector<std::uint32_t> slots_;  // index + 1; 0: free
};

}  // namespace

Result<WeldedBody> weld(const ParsedBody& body) {
  WeldedBody welded;
  PointIndex index(body.points.size());
  std::vector<std::uint32_t> welded_index(body.points.size());
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    const Point3& p = body.points[i];
    GridPoint grid;
    if (!to_grid(p.x, body.float32, body.centre.x, grid.x) ||
        !to_grid(p.y, body.float32, body.centre.y, grid.y) ||
        !to_grid(p.z, body.float32, body.centre.z, grid.z))
      return fail(ErrorCode::DataLoss, "body \"" + body.name + "\": point " + std::to_string(i) +
                                           " (" + std::to_string(p.x) + ", " + std::to_string(p.y) +
                                           ", " + std::to_string(p.z) +
                                           ") is not on the 0.1 mm grid");
    welded_index[i] = index.index_of(grid, welded.points);
  }
  welded.triangles.reserve(body.triangles.size());
  for (const Triangle& t : body.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= body.points.size())
      return fail(ErrorCode::DataLoss, "body \"" + body.name + "\": a corner is point " +
                                           std::to_string(std::max({t[0], t[1], t[2]})) + " of " +
                                           std::to_string(body.points.size()));
    welded.triangles.push_back({welded_index[t[0]], welded_index[t[1]], welded_index[t[2]]});
  }
  return welded;
}

}  // namespace citymesh
