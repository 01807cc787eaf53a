#pragma once

#include <span>
#include <string_view>

#include "core/citymodel/building.h"

namespace citymesh::testing {

/// A building that is none, or that is far too much of one. Large ones have about `size` corners or
/// faces, or as many as are as hard.
struct BadBuilding {
  std::string_view name;
  Building (*make)(std::size_t size);
};

/// All but `far_away` within 200 m of the origin.
std::span<const BadBuilding> bad_buildings();

}  // namespace citymesh::testing
