#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

/// An input triangle that a facet is a piece of.
struct Cover {
  std::uint32_t input = 0;  ///< index into the input triangles
  bool along = true;        ///< whether the facet has the input's orientation
};

/// Triangles cut where they meet: two facets have common corners and common edges, nothing else.
struct Arrangement {
  std::vector<GridPoint> points{};
  std::vector<Triangle> facets{};
  std::vector<std::vector<Cover>> covers{};  ///< per facet, by input; several where inputs coincide
};

struct ArrangeOptions {
  double tolerance_m =
      0.002;  ///< no vertex stays closer than this to another vertex, edge or facet
  std::uint32_t max_rounds = 16;
  std::uint64_t max_facets = 200'000;
  std::uint64_t max_cuts = 400'000;  ///< pairs of facets that cross, over all rounds
  std::stop_token stop{};            ///< asked once per facet
};

/// Cuts all triangles where they cross, with exact constructions, rounds what came new to the grid
/// and repeats until nothing crosses (iterated snap rounding, after Halperin and Packer 2002, here
/// in space). Degenerate triangles are ignored. None: a limit was reached before that, or it was
/// stopped.
std::optional<Arrangement> arrange(std::span<const GridPoint> points,
                                   std::span<const Triangle> triangles,
                                   const ArrangeOptions& options);

/// Winding numbers of the cells on both sides of every facet.
struct WindingNumbers {
  std::vector<double> front{}, back{};  ///< per facet; the front is where its normal points
  bool exact = true;  ///< whole numbers, all weights closing up; else means over the cell's facets
};

/// `weights` says per input triangle how often it counts (0: not at all). For closed boundaries the
/// numbers are whole and follow from counting; where boundaries are open they are the generalised
/// ones by solid angles (Jacobson, Kavan, Sorkine-Hornung 2013; van Oosterom and Strackee 1983).
WindingNumbers winding_numbers(const Arrangement& arrangement,
                               std::span<const std::int8_t> weights);

}  // namespace citymesh
