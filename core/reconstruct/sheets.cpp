#include "core/reconstruct/sheets.h"

#include "core/geometry/triangulation.h"

namespace citymesh {

std::vector<Triangle> sheet_of(const Shell& shell, const Face& face) {
  if (auto triangles = triangulate(shell.points, face.rings)) return std::move(*triangles);
  std::vector<Triangle> fan;
  const Ring& ring = face.rings[0];
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) fan.push_back({ring[0], ring[i], ring[i + 1]});
  return fan;
}

}  // namespace citymesh
