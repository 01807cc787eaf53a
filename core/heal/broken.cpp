#include <map>
#include <set>

#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

std::set<std::uint32_t> corners_of(const Face& face) {
  std::set<std::uint32_t> corners;
  for (const Ring& ring : face.rings) corners.insert(ring.begin(), ring.end());
  return corners;
}

}  // namespace

void drop_broken_faces(Shell& shell, StepContext& context) {
  std::erase_if(shell.faces, [&](Face& face) {
    if (triangulate(shell.points, face.rings)) return false;
    context.note("broken_face_dropped", shell.surface_ids[face.source]);
    context.broken.push_back(std::move(face));
    return true;
  });
}

void restore_broken_faces(Shell& shell, StepContext& context) {
  if (context.broken.empty()) return;
  std::map<std::uint32_t, std::vector<std::uint32_t>> new_faces_at;  // by corner
  std::vector<std::size_t> corners(shell.faces.size(), 0);
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    if (!shell.faces[f].added || shell.faces[f].source != 0) continue;
    const std::set<std::uint32_t> own = corners_of(shell.faces[f]);
    corners[f] = own.size();
    for (const std::uint32_t corner : own) new_faces_at[corner].push_back(f);
  }
  for (const Face& broken : context.broken) {
    std::map<std::uint32_t, std::size_t> common;  // by new face
    for (const std::uint32_t corner : corners_of(broken))
      if (const auto at = new_faces_at.find(corner); at != new_faces_at.end())
        for (const std::uint32_t f : at->second) ++common[f];
    for (const auto& [f, count] : common) {
      Face& face = shell.faces[f];
      // Most of the new face's corners are corners of the broken one: it stands in its place.
      if (!face.added || count < 3 || 2 * count <= corners[f]) continue;
      face.type = broken.type;
      face.source = broken.source;
      face.added = false;
    }
  }
}

}  // namespace citymesh
