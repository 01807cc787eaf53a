#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

/// Corners of a loop up to which minimal_patch() works: its cost grows with their third power.
inline constexpr std::size_t kMaxPatchCorners = 160;

/// The triangles over a loop's corners with the least weighted area, by dynamic programming
/// (Barequet and Sharir 1995). Upright triangles weigh a quarter: what misses in buildings are
/// walls, and lids and floors over the same loop exist already. Triangles walk as the loop does.
/// None: fewer than three or too many corners.
std::optional<std::vector<Triangle>> minimal_patch(std::span<const GridPoint> points,
                                                   std::span<const std::uint32_t> loop);

}  // namespace citymesh
