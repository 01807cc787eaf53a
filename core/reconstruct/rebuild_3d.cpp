#include "core/reconstruct/rebuild_3d.h"

#include <cmath>
#include <utility>

#include "core/geometry/predicates.h"
#include "core/reconstruct/boundary.h"
#include "core/reconstruct/cut_faces.h"

namespace citymesh {
namespace {

constexpr double kMaxLost = 1.0 / 3;  ///< of the area of the input, outside of the result

double area(const std::vector<GridPoint>& points, const Triangle& t) {
  const Point3 n = normal_of(points[t[0]], points[t[1]], points[t[2]]);
  return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

std::optional<SolidBoundary> solid_of(const Shell& input, const ReconstructOptions& options,
                                      const RunContext& context) {
  const auto cut = cut_and_closed_faces(input, options.tolerance_m, context);
  if (!cut) return {};
  const Arrangement& arrangement = cut->arrangement;
  const std::vector<std::int8_t> weights(cut->face_of.size(), 1);
  const WindingNumbers winding = winding_numbers(arrangement, weights);

  SolidBoundary boundary;
  boundary.points = arrangement.points;
  double lost = 0, all = 0;
  for (std::uint32_t f = 0; f < arrangement.facets.size(); ++f) {
    const bool front = is_inside(winding.front[f]), back = is_inside(winding.back[f]);
    const std::uint32_t parent = parent_of(arrangement.covers[f], back, cut->face_of, input);
    const double size = area(arrangement.points, arrangement.facets[f]);
    if (parent < input.faces.size()) {
      all += size;
      if (!front && !back) lost += size;
    }
    if (front == back) continue;
    Triangle t = arrangement.facets[f];
    if (front) std::swap(t[1], t[2]);
    boundary.triangles.push_back(t);
    boundary.parents.push_back(parent);
  }
  if (boundary.triangles.empty() || lost > kMaxLost * all) return {};
  separate_contacts(boundary, kContactGap_m);
  return boundary;
}

}  // namespace

std::optional<Shell> rebuild_3d(const Shell& input, const ReconstructOptions& options,
                                const RunContext& context) {
  const auto boundary = solid_of(input, options, context);
  if (!boundary) return {};
  return shell_of(*boundary, input);
}

}  // namespace citymesh
