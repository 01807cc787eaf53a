#pragma once

#include "core/citymodel/building.h"

namespace citymesh {

/// Takes out corners that repeat the one before them, and the tips and one foot of spikes (a, b, a
/// → a), until there are none; a ring of fewer than three corners becomes empty. Whether anything
/// but that last changed. Linear.
bool drop_repeats_and_spikes(Ring& ring);

}  // namespace citymesh
