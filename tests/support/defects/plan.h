#pragma once

#include <array>
#include <vector>

#include "tests/support/defects/house.h"

namespace citymesh::testing {

/// A roof seen from above: cells that fill the outline without overlap, each with the heights of
/// its corners. Neighbours meet along whole edges. Walls stand where heights differ.
class Plan {
 public:
  using Corners = std::vector<int>;

  /// Index of a new corner.
  int corner(double x_m, double y_m) {
    places_.push_back({x_m, y_m});
    return static_cast<int>(places_.size()) - 1;
  }
  /// A cell with the given exterior (counter-clockwise) and height over it; under it the house
  /// begins at `floor_m`.
  template <class Height>
  void cell(const Corners& exterior, Height&& height, double floor_m = 0) {
    cells_.push_back({{exterior}, {heights(exterior, height)}, floor_m});
  }
  /// A hole (clockwise) in the last cell.
  template <class Height>
  void hole(const Corners& ring, Height&& height) {
    cells_.back().rings.push_back(ring);
    cells_.back().tops_m.push_back(heights(ring, height));
  }

  /// The closed boundary: roofs, walls (one per straight side of the outline), ground.
  House raise() const;

 private:
  struct Cell {
    std::vector<Corners> rings;
    std::vector<std::vector<double>> tops_m;
    double floor_m;
  };

  template <class Height>
  std::vector<double> heights(const Corners& ring, Height&& height) const {
    std::vector<double> result;
    for (const int c : ring) {
      const auto& [x, y] = places_[static_cast<std::size_t>(c)];
      result.push_back(height(x, y));
    }
    return result;
  }

  friend class Raising;
  std::vector<std::array<double, 2>> places_;
  std::vector<Cell> cells_;
};

}  // namespace citymesh::testing
