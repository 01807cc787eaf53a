#include "core/reconstruct/rebuild_3d.h"

namespace citymesh {

std::optional<Shell> rebuild_3d(const Shell&, const ReconstructOptions&, const RunContext&) {
  return {};
}

}  // namespace citymesh
