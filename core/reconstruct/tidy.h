#pragma once

#include "core/citymodel/shell.h"

namespace citymesh {

/// Vertical faces of one source that lie in one plane and share an edge become one face; corners
/// that only two faces have, both on a straight line, go.
void tidy(Shell& shell);

}  // namespace citymesh
