#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/predicates.h"

namespace citymesh {

/// A straight piece of the boundary of an area, or (`area` kNoArea) a line that only divides.
struct PartitionLine {
  static constexpr std::uint32_t kNoArea = ~0u;
  GridPoint2 a{}, b{};
  std::uint32_t area = kNoArea;
};

/// The plane divided by lines: no two edges cross, and no vertex comes closer than the tolerance to
/// another one or to an edge that it does not end.
struct Partition {
  static constexpr std::uint32_t kOutside = 0;  ///< the unbounded cell

  struct Edge {
    std::uint32_t from = 0, to = 0;     ///< vertices
    std::uint32_t left = 0, right = 0;  ///< cells, seen from `from` to `to`
  };
  struct Cell {
    std::vector<std::uint32_t> areas{};  ///< that cover it, ascending
    double area_m2 = 0;
    GridPoint2 inside{};  ///< a place well inside
  };
  std::vector<GridPoint2> vertices{};
  std::vector<Edge> edges{};
  std::vector<Cell> cells{};
  std::map<GridPoint2, std::uint32_t> vertex_of{};  ///< where the ends of the lines went
};

/// Divides the plane. An area is what the closed walks of its lines enclose an odd number of times:
/// rings that cross or touch themselves are areas too. Crossings are rounded to the grid; ends of
/// lines keep their places as far as the tolerance lets them. None: more than `max_edges` pieces,
/// or the pieces do not come to rest.
std::optional<Partition> divide(std::span<const PartitionLine> lines, std::int64_t tolerance_steps,
                                std::size_t max_edges);

}  // namespace citymesh
