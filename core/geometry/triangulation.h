#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/point.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// Newell's normal of a ring (Sutherland, Sproull, Schumacker 1974): robust against collinear and
/// slightly non-planar corners. Length is twice the area in steps². Zero for degenerate rings.
Point3 ring_normal(std::span<const GridPoint> points, std::span<const std::uint32_t> ring);

/// The axis along which `normal` is longest.
Axis dominant_axis(const Point3& normal);

/// Constrained Delaunay triangulation of one polygon with holes, in the projection along the
/// dominant axis of its exterior's normal; exact on the grid. Triangles use only corners of the
/// rings and have the exterior's orientation, however holes are oriented. Edges that rings use an
/// even number of times do not separate inside from outside. None: the projected rings cross,
/// overlap or put two corners in one place.
std::optional<std::vector<Triangle>> triangulate(std::span<const GridPoint> points,
                                                 std::span<const std::vector<std::uint32_t>> rings);

}  // namespace citymesh
