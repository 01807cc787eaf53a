#include <algorithm>
#include <iterator>
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
  for (const Face& broken : context.broken) {
    const std::set<std::uint32_t> wanted = corners_of(broken);
    for (Face& face : shell.faces) {
      if (!face.added || face.source != 0) continue;
      std::vector<std::uint32_t> common;
      const std::set<std::uint32_t> corners = corners_of(face);
      std::set_intersection(wanted.begin(), wanted.end(), corners.begin(), corners.end(),
                            std::back_inserter(common));
      // Most of the new face's corners are corners of the broken one: it stands in its place.
      if (common.size() < 3 || 2 * common.size() <= corners.size()) continue;
      face.type = broken.type;
      face.source = broken.source;
      face.added = false;
    }
  }
}

}  // namespace citymesh
