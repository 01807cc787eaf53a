#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/citymodel/building.h"
#include "tests/support/defects/defects.h"

namespace citymesh::testing {

/// A house of which it is known what it should be.
struct DefectiveHouse {
  Building building{};  ///< LoD2; coordinates in metres from the city's corner, to 0.1 or 1 mm
  std::string_view shape{};
  std::vector<Defect> defects{};  ///< none: a sound house
  double volume_m3 = 0;           ///< of the solid before anything was injected
  double undefined_m3 = 0;        ///< by how much a defect leaves the volume open
};

/// A house of the shape (index into house_shapes()) turned by any angle and put somewhere into a
/// box of 40 m at (`x_m`, `y_m`). The same seed gives the same house.
DefectiveHouse make_house(std::size_t shape, const std::vector<Defect>& defects, std::uint64_t seed,
                          double x_m = 0, double y_m = 0);

struct CityPlan {
  std::uint64_t seed = 1;
  std::size_t sound = 1;    ///< per shape
  std::size_t singles = 1;  ///< per shape and defect
  std::size_t pairs = 1;    ///< per shape and pair of different defects
};

/// Houses side by side that do not touch, named by shape, defects and number.
std::vector<DefectiveHouse> make_city(const CityPlan& plan);

}  // namespace citymesh::testing
