#pragma once

#include <optional>

#include "core/base/run_context.h"
#include "core/citymodel/shell.h"

namespace citymesh {

struct ReconstructOptions {
  double tolerance_m = 0.001;  ///< what lies closer together than this may become one
};

/// A way to make the boundary of a solid from faces that bound none: open, inverted, doubled,
/// crossing. The result stands on the grid, is oriented outwards, keeps type and source of the
/// faces that it continues and marks others `added`. None: this way does not apply, or its work
/// limit is reached. What comes out is for the delivery gates to judge.
using Reconstruction = std::optional<Shell> (*)(const Shell& input,
                                                const ReconstructOptions& options,
                                                const RunContext& context);

}  // namespace citymesh
