#pragma once

#include "core/citymodel/shell.h"

namespace citymesh {

/// Rings that cross themselves because a run of their corners is in reverse order (bow-ties) get
/// the order that shares most edges with other faces; so do rings that cross nothing, where turning
/// a run makes all their edges those of other faces. Rings that no single reversal helps stay.
void untangle(Shell& shell);

}  // namespace citymesh
