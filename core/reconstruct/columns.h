#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/citymodel/shell.h"
#include "core/reconstruct/partition.h"

namespace citymesh {

/// What a cell of a partition holds: the space between two levels. A level is one surface, flat or
/// not, that may bound many cells.
struct Column {
  std::uint32_t bottom = 0, top = 0;  ///< levels
  friend bool operator==(const Column&, const Column&) = default;
};
using Columns = std::vector<std::optional<Column>>;  ///< by cell; none: empty

/// How a level looks in the result.
struct LevelFace {
  SurfaceType type = SurfaceType::Unknown;
  std::uint32_t source = 0;
  bool added = false;
};

/// The boundary of all columns. Cells of one level become one face; where neighbours differ in
/// height stands a wall, untyped and `added`. Heights of a level over a vertex come from `height`;
/// those of one vertex that are closer than the tolerance become one, and where two levels cross
/// over an edge, the edge is cut. All walls at a vertex share all its points, so the result is
/// closed; where cells meet only in a vertical line or a point it is not manifold.
Shell boundary_of(
    Partition partition, const Columns& columns, std::span<const LevelFace> levels,
    const std::function<std::int64_t(std::uint32_t level, std::uint32_t vertex)>& height,
    std::int64_t tolerance_steps);

/// Where a shell is not manifold: ends of edges with more than two faces, points with more than one
/// fan; seen from above.
std::vector<GridPoint2> pinches(const Shell& shell);

}  // namespace citymesh
