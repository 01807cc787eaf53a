#include "core/geometry/place.h"

#include <fmt/format.h>

namespace citymesh {

std::string place_text(const GridPoint& p) {
  const Point3 m = to_metres(p);
  return fmt::format("({:.4f} {:.4f} {:.4f})", m.x, m.y, m.z);
}

}  // namespace citymesh
