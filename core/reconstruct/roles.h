#pragma once

#include <cstdint>

#include "core/citymodel/shell.h"
#include "core/reconstruct/partition.h"

namespace citymesh {

/// What a face can be to a building that is seen from above.
enum class FaceRole : std::uint8_t {
  Ignored,  ///< inside the building, or no face at all
  Vertical,
  Up,     ///< told by its type: bounds from above
  Down,   ///< told by its type: bounds from below
  Either  ///< neither vertical nor told by its type
};

FaceRole role_of(const Shell& shell, const Face& face, std::int64_t tolerance_steps);

/// The line over which a vertical face stands.
PartitionLine seen_from_above(const Shell& shell, const Face& face);

/// The same faces without repeated corners and spikes in their rings, and those untangled that can
/// be.
Shell with_clean_rings(const Shell& shell);

}  // namespace citymesh
