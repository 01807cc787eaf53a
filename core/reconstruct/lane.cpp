#include "core/reconstruct/lane.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/predicates.h"
#include "core/geometry/triangulation.h"

namespace citymesh {

std::string lane_of(const Shell& shell) {
  std::vector<std::array<GridPoint2, 3>> roofs;
  std::vector<GridBox> boxes;
  for (const Face& face : shell.faces) {
    const auto triangles = triangulate(shell.points, face.rings);
    if (!triangles) continue;
    for (const Triangle& t : *triangles) {
      const std::array<GridPoint2, 3> flat{project(shell.points[t[0]], Axis::Z),
                                           project(shell.points[t[1]], Axis::Z),
                                           project(shell.points[t[2]], Axis::Z)};
      if (orient2d(flat[0], flat[1], flat[2]) <= 0) continue;
      GridBox box = GridBox::of({flat[0].x, flat[0].y, 0});
      for (const GridPoint2& p : flat) box.add(GridPoint{p.x, p.y, 0});
      roofs.push_back(flat);
      boxes.push_back(box);
    }
  }
  // Interiors of two counter-clockwise triangles are disjoint when an edge of one has the other
  // wholly on its right.
  const auto separates = [](const auto& s, const auto& t) {
    for (std::size_t i = 0; i < 3; ++i)
      if (std::all_of(t.begin(), t.end(),
                      [&](const GridPoint2& p) { return orient2d(s[i], s[(i + 1) % 3], p) <= 0; }))
        return true;
    return false;
  };
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < roofs.size(); ++i) {
    bool overlap = false;
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      overlap =
          overlap || (j > i && !separates(roofs[i], roofs[j]) && !separates(roofs[j], roofs[i]));
    });
    if (overlap) return "3d";
  }
  return "2.5d";
}

}  // namespace citymesh
