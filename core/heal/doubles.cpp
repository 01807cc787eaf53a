#include <algorithm>
#include <span>

#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {

void drop_double_triangles(Shell& shell, StepContext& context) {
  struct Copy {
    Triangle corners;  ///< sorted
    std::uint32_t face;
    std::uint32_t triangle;
    bool even;  ///< an even permutation of the sorted corners: which way it faces
  };
  std::vector<std::vector<Triangle>> triangles(shell.faces.size());
  std::vector<Copy> all;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    auto found = triangulate(shell.points, shell.faces[f].rings);
    if (!found) return;  // a face that has no triangles is for the gate to refuse
    triangles[f] = std::move(*found);
    for (std::uint32_t t = 0; t < triangles[f].size(); ++t) {
      Triangle key = triangles[f][t];
      std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
      const bool even = key[1] < key[2];
      if (!even) std::swap(key[1], key[2]);
      all.push_back({key, f, t, even});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Copy& a, const Copy& b) { return a.corners < b.corners; });
  std::vector<std::vector<char>> gone(shell.faces.size());
  bool any = false;
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    while (last < all.size() && all[last].corners == all[first].corners) ++last;
    const std::span<const Copy> copies(all.data() + first, last - first);
    // A face that closes a hole over an existing one closed the wrong hole: that is for the gate to
    // refuse.
    if (copies.size() < 2 || std::any_of(copies.begin(), copies.end(),
                                         [&](const Copy& c) { return shell.faces[c.face].added; }))
      continue;
    const auto even = static_cast<std::size_t>(
        std::count_if(copies.begin(), copies.end(), [](const Copy& c) { return c.even; }));
    const bool inner = 2 * even == copies.size();
    const bool keep_even = 2 * even > copies.size();
    bool kept = inner;
    for (const Copy& copy : copies) {
      if (!kept && copy.even == keep_even) {
        kept = true;
        continue;
      }
      gone[copy.face].resize(triangles[copy.face].size(), 0);
      gone[copy.face][copy.triangle] = 1;
    }
    any = true;
    context.note(inner ? "inner_face_dropped" : "duplicate_face_dropped",
                 shell.points[copies[0].corners[0]]);
  }
  if (!any) return;
  std::vector<Face> kept;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    if (gone[f].empty()) {
      kept.push_back(std::move(shell.faces[f]));
      continue;
    }
    for (std::uint32_t t = 0; t < triangles[f].size(); ++t) {
      if (gone[f][t]) continue;
      Face rest = shell.faces[f];
      rest.rings = {{triangles[f][t][0], triangles[f][t][1], triangles[f][t][2]}};
      kept.push_back(std::move(rest));
    }
  }
  shell.faces = std::move(kept);
}

}  // namespace citymesh
