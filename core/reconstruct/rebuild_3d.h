#pragma once

#include "core/reconstruct/reconstruct.h"

namespace citymesh {

/// All faces are cut where they meet; the cells of space between them are told apart by their
/// winding number, and the boundary between inside and outside is the result (Jacobson, Kavan,
/// Sorkine-Hornung 2013; exact constructions, then rounded to the grid until nothing crosses).
std::optional<Shell> rebuild_3d(const Shell& input, const ReconstructOptions& options,
                                const RunContext& context);

}  // namespace citymesh
