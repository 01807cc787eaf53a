#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/citymodel/shell.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// z = z0 + gx · (x - at.x) + gy · (y - at.y), in steps.
struct Slope {
  GridPoint2 at{};
  double z0 = 0, gx = 0, gy = 0;
  double z(double x, double y) const {
    return z0 + gx * (x - static_cast<double>(at.x)) + gy * (y - static_cast<double>(at.y));
  }
};

/// A surface that is a function of (x, y): a face that is not vertical, or a plane.
class Level {
 public:
  /// The face must not be vertical.
  Level(const Shell& shell, const Face& face);
  explicit Level(const Slope& plane) : plane_(plane) {}

  /// Height over a place: of the triangles of the face; near its boundary, of the boundary; beyond,
  /// of its plane, not far above or below the face.
  std::int64_t z(const GridPoint2& p, double reach_steps) const;

 private:
  Slope plane_;
  std::vector<GridPoint> corners_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
  std::vector<Triangle> triangles_;
  std::int64_t lowest_ = 0, highest_ = 0;
};

/// Heights that are known over a place.
struct Sounding {
  GridPoint2 at{};
  std::vector<std::int64_t> z{};
};

/// The plane that meets a height of most soundings within the tolerance; none: fewer than
/// `share` of them, or fewer than three.
std::optional<Slope> consensus(std::span<const Sounding> soundings, double tolerance_steps,
                               double share);

}  // namespace citymesh
