#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/arrangement.h"

namespace citymesh {

/// The cells of space between the facets of an arrangement, for winding numbers of several sets of
/// input triangles. Keeps the arrangement by reference.
class Cells {
 public:
  explicit Cells(const Arrangement& arrangement);

  /// As winding_numbers().
  WindingNumbers winding(std::span<const std::int8_t> weights) const;

 private:
  const Arrangement& arrangement_;
  std::vector<std::uint32_t> cell_of_side_;  ///< sides 2f, the front, and 2f + 1 of facet f
  std::vector<std::vector<std::uint32_t>> facets_of_cell_;
  std::vector<std::uint32_t> set_of_facet_;  ///< connected sets, by a facet of theirs
};

}  // namespace citymesh
