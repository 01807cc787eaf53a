#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/heal/steps.h"

namespace citymesh {

void insert_junctions(Shell& shell, StepContext& context) {
  std::vector<char> used(shell.points.size(), 0);
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings)
      for (const std::uint32_t corner : ring) used[corner] = 1;
  std::vector<std::uint32_t> vertices;
  std::vector<GridBox> boxes;
  for (std::uint32_t v = 0; v < shell.points.size(); ++v)
    if (used[v]) {
      vertices.push_back(v);
      boxes.push_back(GridBox::of(shell.points[v]));
    }
  const BoxTree tree(boxes);
  const auto reach = static_cast<std::int64_t>(std::ceil(context.tolerance_m * kGridStepsPerMetre));

  struct Junction {
    double position;
    std::uint32_t vertex;
    double distance_m;
  };
  std::set<std::uint32_t> noted;
  for (Face& face : shell.faces)
    for (Ring& ring : face.rings) {
      Ring result;
      result.reserve(ring.size());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
        result.push_back(a);
        const GridTube around(shell.points[a], shell.points[b], reach);
        std::vector<Junction> junctions;
        tree.for_each_meeting(around, [&](std::uint32_t k) {
          const std::uint32_t v = vertices[k];
          if (v == a || v == b) return;
          double position = 0;
          const double d =
              distance_to_segment_m(shell.points[v], shell.points[a], shell.points[b], &position);
          if (d <= context.tolerance_m && position > 0 && position < 1)
            junctions.push_back({position, v, d});
        });
        std::sort(junctions.begin(), junctions.end(), [](const Junction& s, const Junction& t) {
          return std::tie(s.position, s.vertex) < std::tie(t.position, t.vertex);
        });
        for (const Junction& junction : junctions) {
          result.push_back(junction.vertex);
          if (noted.insert(junction.vertex).second)
            context.note("t_junction", shell.points[junction.vertex], junction.distance_m);
        }
      }
      ring = std::move(result);
    }
}

}  // namespace citymesh
