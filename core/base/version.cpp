#include "core/base/version.h"

namespace citymesh {

std::string_view version() { return CITYMESH_VERSION; }

}  // namespace citymesh
