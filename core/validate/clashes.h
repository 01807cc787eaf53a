#pragma once

#include <array>
#include <vector>

#include "core/validate/boundary.h"

namespace citymesh {

/// Two polygons of a boundary that meet elsewhere than in the corners and edges they share.
struct Clash {
  std::uint32_t polygon = 0, other = 0;
  Point3 at{};  ///< near the first place, metres
};

/// Every such pair once, in order; exact. Ends early after kMaxClashTests pairs of triangles.
std::vector<Clash> find_clashes(const Boundary& boundary);
inline constexpr std::uint64_t kMaxClashTests = 50'000'000;

/// A place where two triangles meet, to the precision of doubles.
Point3 meeting_place(const std::array<GridPoint, 3>& s, const std::array<GridPoint, 3>& t);

}  // namespace citymesh
