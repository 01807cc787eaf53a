#pragma once

#include "core/reconstruct/reconstruct.h"

namespace citymesh {

/// For buildings whose roof is a function of (x, y) and whose walls are vertical: the faces that
/// are not vertical divide the plane, every cell is the space between the lowest and the highest of
/// them, and walls stand where neighbours differ (cases of Goebbels and Pohle-Fröhlich 2016,
/// section 3.4, in strict order). Missing roofs and grounds are continued from what is around. None
/// when there is air between two faces above each other, or when a piece of the input would be
/// lost.
std::optional<Shell> rebuild_2_5d(const Shell& input, const ReconstructOptions& options,
                                  const RunContext& context);

}  // namespace citymesh
