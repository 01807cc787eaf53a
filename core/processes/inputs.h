#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/building.h"
#include "core/source/source.h"
#include "core/write/write.h"

namespace citymesh {

/// The inputs of a process as values; fields are named like the inputs.
struct Inputs {
  bool only_estimate = false;
  BuildingQuery query{};
  std::vector<Lod> lod{};
  std::vector<std::string> formats{};
  bool block_on_failure = true;
  bool keep_installations = false;
  Patches patches = Patches::ByObject;
  double snap_tolerance_m = 0.001;
  double planarity_tolerance_m = 0.01;
  double max_displacement_m = 0.1;
  double max_hole_area_m2 = 10000;
  double gap_threshold_m = 0.1;
  bool merge_parts = false;  ///< parts that touch or overlap become one body
};

/// Reads what canonical_inputs() has checked and completed. Errors: InvalidArgument for values that
/// the table cannot judge (CRS names, empty boxes); Unimplemented for choices that are not built.
Result<Inputs> read_inputs(std::string_view canonical_json);

}  // namespace citymesh
