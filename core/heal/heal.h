#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/building.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"
#include "core/geometry/measure.h"

namespace citymesh {

struct HealOptions {
  double snap_tolerance_m = 0.001;  ///< points closer than this become one point
  double planarity_tolerance_m =
      0.01;                          ///< largest distance of a corner to the plane of a closed hole
  double max_displacement_m = 0.10;  ///< limit of rung `healed`; beyond it the next rung is tried
  double max_hole_area_m2 = 10000;   ///< larger holes are not closed on rung `healed`
  bool block_on_failure = true;      ///< whether rung `lod1_block` may be used
};

/// The judge of a rung: what keeps this shell from being delivered, as issues; empty when it is
/// fit. Given by the caller, who measures the shell as it would be written.
using DeliveryGate = std::function<std::vector<Issue>(const Shell&)>;

/// The end of one building or part on the ladder.
struct Healed {
  std::string rung{};    ///< as_is, healed, lod1_block; empty when dropped
  std::string reason{};  ///< when dropped: no_geometry, no_height, not_healed
  std::string lane{};    ///< 2.5d: no two roof surfaces above each other; else 3d
  Lod lod{};             ///< of the geometry taken
  Shell shell{};         ///< passed the gate; surfaces typed, oriented outwards
  std::vector<Issue>
      issues{};  ///< defects of the first geometry tried, and what the gate held against it
  std::vector<Repair> repairs{};
  double max_displacement_m = 0;
  Deviation deviation{};  ///< two-sided distance to the input, except to faces that close holes
  std::optional<double> volume_before_m3{};  ///< where the input is closed
};

/// The last step of every rung: faces get a type and fall into solids; what the gate takes is cut
/// where others would not find its faces plane, at `cuts`, and judged again. Returns what the gate
/// holds against it: nothing when it is fit.
std::vector<Issue> make_fit(Shell& shell, double planarity_tolerance_m, const DeliveryGate& gate,
                            std::vector<GridPoint>& cuts);

/// Climbs the ladder until the gate holds: the geometry as it is after gridding; healed (snapping,
/// ring cleaning, T-junctions, duplicate faces, orientation, planar holes) with growing tolerances;
/// the LoD1 block of the contract. On every rung faces that are not plane are cut into plane
/// pieces. Takes the first level of detail of `lod` that the building has. Never throws for bad
/// geometry.
Healed heal(const Building& building, std::span<const Lod> lod, const HealOptions& options,
            const DeliveryGate& gate, const RunContext& context);

}  // namespace citymesh
