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
  std::vector<char> shared{};  ///< per triangle: another body has it too; empty where none does
};

inline constexpr double kContactGap_m = 0.005;  ///< between parts of a solid that only touch

/// Where more than two triangles meet at an edge, or more than one fan at a vertex, the parts of
/// the solid that touch there draw back from each other by `gap_m`. Edges must have an even number
/// of triangles that do not overlap.
void separate_contacts(SolidBoundary& boundary, double gap_m);

/// Pieces of one input face that hang together become one polygon where they still lie in a plane;
/// other pieces stay triangles. Type, source and `added` are those of the input face; a parent past
/// the last face is a new face. Pieces shared with another body become a polygon only where both
/// see the same plane however they cut it.
Shell faces_of(const SolidBoundary& boundary, const Shell& input);

/// As faces_of(), but every piece stays a triangle.
Shell triangles_of(const SolidBoundary& boundary, const Shell& input);

/// faces_of(), or triangles_of() where polygons that were cut and rounded are not plane enough to
/// be triangulated anew.
Shell shell_of(const SolidBoundary& boundary, const Shell& input);

}  // namespace citymesh
