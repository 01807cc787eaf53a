#pragma once

#include "core/reconstruct/reconstruct.h"

namespace citymesh {

/// For soups that nothing else closes: wrapped from outside, then the corners are moved back onto
/// the planes of the input as far as nothing crosses. A missing ground is closed first, so that the
/// wrap does not walk in. The volume decides on the ball: a result that is thin against what the
/// building covers is wrapped again with a larger one, a result that swells beyond the columns
/// between its lowest and highest faces with a smaller one; what stays wrong is refused. The ball
/// grows with the tolerance.
std::optional<Shell> wrap(const Shell& input, const ReconstructOptions& options,
                          const RunContext& context);

}  // namespace citymesh
