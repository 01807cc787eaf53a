#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

/// The outline of triangles as loops of corners that walk as the triangles do. Empty when it
/// touches itself: then its loops could be drawn in several ways.
std::vector<std::vector<std::uint32_t>> outline_of(std::span<const Triangle> triangles);

/// The rings of the polygon that such triangles fill, the exterior first; empty when they fill
/// none.
std::vector<std::vector<std::uint32_t>> polygon_of(std::span<const GridPoint> points,
                                                   std::span<const Triangle> triangles);

}  // namespace citymesh
