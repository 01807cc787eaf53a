#include "core/write/solids.h"

#include <algorithm>

#include "core/base/union_find.h"

namespace citymesh {
namespace {

/// Cuts faces into shells that share no point, where the order of the faces allows it.
std::vector<FaceRange> split_shells(const TriangleMesh& mesh, FaceRange faces) {
  UnionFind shells_of_points(mesh.points.size());
  for (std::size_t f = faces.begin; f < faces.end; ++f)
    for (const Ring& ring : mesh.faces[f].rings)
      for (const std::uint32_t corner : ring)
        shells_of_points.join(corner, mesh.faces[f].rings[0][0]);

  const auto shell_of = [&](std::size_t f) {
    return shells_of_points.root(mesh.faces[f].rings[0][0]);
  };
  std::vector<std::size_t> last_face(mesh.points.size(), 0);
  for (std::size_t f = faces.begin; f < faces.end; ++f) last_face[shell_of(f)] = f;
  std::vector<FaceRange> shells;
  std::size_t begin = faces.begin, last = faces.begin;
  for (std::size_t f = faces.begin; f < faces.end; ++f) {
    last = std::max(last, last_face[shell_of(f)]);
    if (f < last) continue;
    shells.push_back({begin, f + 1});
    begin = f + 1;
    last = begin;
  }
  return shells;
}

}  // namespace

std::vector<SolidFaces> solids_of(const TriangleMesh& mesh) {
  std::vector<SolidFaces> solids;
  for (std::size_t begin = 0; begin < mesh.faces.size();) {
    const bool cavity = mesh.faces[begin].cavity;
    std::size_t end = begin + 1;
    while (end < mesh.faces.size() && mesh.faces[end].cavity == cavity) ++end;
    if (cavity && !solids.empty()) {
      solids.back().interiors = split_shells(mesh, {begin, end});
    } else {
      for (const FaceRange& exterior : split_shells(mesh, {begin, end}))
        solids.push_back({exterior, {}});
    }
    begin = end;
  }
  return solids;
}

}  // namespace citymesh
