#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace citymesh {

/// A place in metres: absolute in a CRS, or relative to a local origin (the owner says which).
struct Point3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Point3&, const Point3&) = default;
};

/// Steps of the exact grid in a metre; coordinates of everything that is delivered are whole steps.
inline constexpr double kGridStepsPerMetre = 10000.0;
inline constexpr double kGridStep_m = 0.0001;

/// Largest coordinate (in steps from the origin) for which all predicates stay exact in 128 bits:
/// 214 km.
inline constexpr std::int64_t kGridLimit = (std::int64_t{1} << 31) - 1;

/// A place on the exact grid, k · 0.1 mm from the local origin.
struct GridPoint {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

using Triangle = std::array<std::uint32_t, 3>;

/// Axis-parallel box in metres, closed. Starts empty.
struct Box3 {
  Point3 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
  Point3 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

  bool is_empty() const { return !(min.x <= max.x); }
  void add(const Point3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  void add(const Box3& other) {
    if (other.is_empty()) return;
    add(other.min);
    add(other.max);
  }
};

inline Point3 to_metres(const GridPoint& p) {
  return {static_cast<double>(p.x) / kGridStepsPerMetre,
          static_cast<double>(p.y) / kGridStepsPerMetre,
          static_cast<double>(p.z) / kGridStepsPerMetre};
}

}  // namespace citymesh
