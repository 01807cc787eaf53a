#include "core/mesh/mesh.h"

#include "core/geometry/triangulation.h"

namespace citymesh {

Meshed mesh(const Shell& shell) {
  TriangleMesh result;
  result.surface_ids = shell.surface_ids;
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> index_of(shell.points.size(), kUnused);
  for (const Face& face : shell.faces) {
    const auto triangles = triangulate(shell.points, face.rings);
    if (!triangles)
      return Issue{face.rings.size() > 1 ? 201 : 104, shell.surface_ids[face.source], 0};
    Face& compact_face = result.faces.emplace_back(face);
    for (Ring& ring : compact_face.rings)
      for (std::uint32_t& corner : ring) {
        std::uint32_t& index = index_of[corner];
        if (index == kUnused) {
          index = static_cast<std::uint32_t>(result.points.size());
          result.points.push_back(shell.points[corner]);
        }
        corner = index;
      }
    for (const Triangle& triangle : *triangles) {
      const Triangle compact{index_of[triangle[0]], index_of[triangle[1]], index_of[triangle[2]]};
      result.triangles.push_back(compact);
      result.surface_types.push_back(face.type);
      result.source_surfaces.push_back(face.source);
    }
  }
  return result;
}

}  // namespace citymesh
