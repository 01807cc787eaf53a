#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/point.h"

namespace citymesh {

/// A fingerprint of a set of oriented triangles that depends neither on their order nor on how
/// points are numbered. Equal sets have equal fingerprints and fingerprints add up; different sets
/// differ but for a chance of 2^-64.
std::uint64_t signature(std::span<const GridPoint> points, std::span<const Triangle> triangles);

}  // namespace citymesh
