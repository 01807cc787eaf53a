#pragma once

#include <cstdint>
#include <vector>

#include "core/citymodel/shell.h"
#include "core/geometry/point.h"

namespace citymesh {

/// The closed boundary of a solid in pieces of the faces it was made from.
struct SolidBoundary {
  std::vector<GridPoint> points{};
  std::vector<Triangle> triangles{};     ///< outwards
  std::vector<std::uint32_t> parents{};  ///< per triangle: the input face it continues
};

/// Where more than two triangles meet at an edge, or more than one fan at a vertex, the parts of
/// the solid that touch there draw back from each other by `gap_m`. Edges must have an even number
/// of triangles that do not overlap.
void separate_contacts(SolidBoundary& boundary, double gap_m);

/// Pieces of one input face that hang together become one polygon where they still lie in a plane;
/// other pieces stay triangles. Type, source and `added` are those of the input face; a parent past
/// the last face is a new face.
Shell faces_of(const SolidBoundary& boundary, const Shell& input);

/// As faces_of(), but every piece stays a triangle.
Shell triangles_of(const SolidBoundary& boundary, const Shell& input);

}  // namespace citymesh
