#pragma once

#include <string_view>
#include <vector>

#include "core/citymodel/building.h"

namespace citymesh::testing {

struct BadBuilding {
  std::string_view name;
  Building building{};
};

/// Buildings that are none, or that are far too much of one; all but `far_away` within 200 m of the
/// origin. `size` is the number of faces of the large ones.
std::vector<BadBuilding> bad_buildings(std::size_t size);

}  // namespace citymesh::testing
