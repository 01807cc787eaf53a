#pragma once

#include <span>
#include <string_view>

#include "tests/support/defects/house.h"
#include "tests/support/defects/random.h"

namespace citymesh::testing {

/// A kind of house; its sizes are random, its corner is at the origin, its ground at height 0.
struct HouseShape {
  std::string_view name;
  House (*build)(Random& random);
};

/// Flat, gabled, hipped … houses, with courtyards, dormers, steps and passages.
std::span<const HouseShape> house_shapes();

}  // namespace citymesh::testing
