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
  /// `mode`: what would be processed is asked for, not the result.
  bool only_estimate = false;
  BuildingQuery query{};
  double area_km2 = 0;  ///< of box or polygon, near enough for a limit; 0 without
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
  bool write_back = false;   ///< to the database, besides the files
  bool merge_parts = false;  ///< parts that touch or overlap become one body
};

/// The same text and values: canonical inputs of the same meaning have the same text.
struct CanonicalInputs {
  std::string json{};  ///< complete_inputs()
  Inputs values{};
};

/// Checks, completes and reads the inputs of one of processes(). Asks PROJ for every CRS named: 0.5
/// ms each, so once per request. Errors: NotFound for an unknown process; those of
/// complete_inputs(); InvalidArgument for values that the table cannot judge (CRS names, empty
/// boxes); Unimplemented for choices that are not built.
Result<CanonicalInputs> canonical_inputs(std::string_view process, std::string_view inputs_json);

/// Whether canonical inputs ask for `write_back`.
bool asks_to_write_back(std::string_view canonical_json);

}  // namespace citymesh
