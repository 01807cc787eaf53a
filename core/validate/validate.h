#pragma once

#include <vector>

#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"

namespace citymesh {

struct ValidateOptions {
  double planarity_tolerance_m = 0.01;  ///< of 203
};

/// Finds the defects of a gridded boundary with val3dity's codes: rings (101, 102, 104), polygons
/// (201, 203), the shell (301, 302, 303, 307). Intersections of faces (306) are the gates'
/// business. Rings and polygons are reported one by one, of the shell's edges the first with their
/// number as the measured value. Changes nothing.
std::vector<Issue> validate(const Shell& shell, const ValidateOptions& options);

}  // namespace citymesh
