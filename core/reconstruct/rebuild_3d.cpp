#include "core/reconstruct/rebuild_3d.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/arrangement.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/predicates.h"
#include "core/geometry/triangulation.h"
#include "core/reconstruct/boundary.h"
#include "core/reconstruct/close_chain.h"

namespace citymesh {
namespace {

constexpr double kMinTolerance_m = 0.0015;     ///< above the height that the gates ask of triangles
constexpr std::size_t kMaxTriangles = 20'000;  ///< of the input; work limits
constexpr std::uint64_t kMaxFacets = 60'000;
constexpr std::uint64_t kMaxCuts = 8'000;
constexpr double kGap_m = 0.005;      ///< between parts that only touch
constexpr double kMaxLost = 1.0 / 3;  ///< of the area of the input, outside of the result

bool is_inside(double winding) { return std::abs(winding) >= 0.5; }

double area(const std::vector<GridPoint>& points, const Triangle& t) {
  const Point3 n = normal_of(points[t[0]], points[t[1]], points[t[2]]);
  return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

/// The input face that a piece continues: one that faces the same way before one that does not, one
/// of the source before one that healing added; one past the last for what closes a gap.
std::uint32_t parent_of(const std::vector<Cover>& covers, bool along,
                        const std::vector<std::uint32_t>& face_of, const Shell& input) {
  const auto rank = [&](const Cover& cover) {
    const std::uint32_t face = face_of[cover.input];
    const bool added = face == input.faces.size() || input.faces[face].added;
    return (cover.along == along ? 0 : 1) + (added ? 2 : 0);
  };
  const auto best =
      std::min_element(covers.begin(), covers.end(),
                       [&](const Cover& s, const Cover& t) { return rank(s) < rank(t); });
  return face_of[best->input];
}

/// Arranges again with triangles that close the gaps; their input index is `gap`.
std::optional<Arrangement> closed(Arrangement first, std::uint32_t gap,
                                  const ArrangeOptions& limits) {
  const std::vector<Triangle> patches = closing_triangles(first);
  if (patches.empty()) return first;
  std::vector<Triangle> all = first.facets;
  all.insert(all.end(), patches.begin(), patches.end());
  auto second = arrange(first.points, all, limits);
  if (!second) return {};
  for (std::vector<Cover>& covers : second->covers) {
    std::vector<Cover> resolved;
    for (const Cover& cover : covers)
      if (cover.input >= first.facets.size())
        resolved.push_back({gap, cover.along});
      else
        for (const Cover& original : first.covers[cover.input])
          resolved.push_back({original.input, original.along == cover.along});
    covers = std::move(resolved);
  }
  return second;
}

/// Whether triangles of the faces meet elsewhere than in common corners and edges.
bool is_crossing(const Shell& shell) {
  std::vector<Triangle> triangles;
  for (const Face& face : shell.faces) {
    const auto pieces = triangulate(shell.points, face.rings);
    if (!pieces) return true;
    triangles.insert(triangles.end(), pieces->begin(), pieces->end());
  }
  std::vector<GridBox> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) boxes.push_back(box_of(shell.points, t));
  const BoxTree tree(boxes);
  const auto corners = [&](std::uint32_t f) {
    const Triangle& t = triangles[f];
    return std::array<GridPoint, 3>{shell.points[t[0]], shell.points[t[1]], shell.points[t[2]]};
  };
  bool crossing = false;
  for (std::uint32_t f = 0; f < triangles.size() && !crossing; ++f)
    tree.for_each_meeting(boxes[f], [&](std::uint32_t g) {
      crossing = crossing || (g > f && triangles_clash(corners(f), corners(g)));
    });
  return crossing;
}

std::optional<SolidBoundary> solid_of(const Shell& input, const ReconstructOptions& options,
                                      const RunContext& context) {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face_of;
  for (std::uint32_t f = 0; f < input.faces.size(); ++f)
    if (const auto pieces = triangulate(input.points, input.faces[f].rings)) {
      triangles.insert(triangles.end(), pieces->begin(), pieces->end());
      face_of.resize(triangles.size(), f);
    }
  if (triangles.size() > kMaxTriangles) return {};

  ArrangeOptions limits;
  limits.max_facets = kMaxFacets;
  limits.max_cuts = kMaxCuts;
  limits.stop = context.stop;
  limits.tolerance_m = std::max(options.tolerance_m, kMinTolerance_m);
  auto arrangement = arrange(input.points, triangles, limits);
  if (!arrangement || context.stopped()) return {};
  const auto gap = static_cast<std::uint32_t>(triangles.size());
  arrangement = closed(std::move(*arrangement), gap, limits);
  if (!arrangement || context.stopped()) return {};
  const auto gap_face = static_cast<std::uint32_t>(input.faces.size());
  face_of.push_back(gap_face);
  const std::vector<std::int8_t> weights(face_of.size(), 1);
  const WindingNumbers winding = winding_numbers(*arrangement, weights);

  SolidBoundary boundary;
  boundary.points = arrangement->points;
  double lost = 0, all = 0;
  for (std::uint32_t f = 0; f < arrangement->facets.size(); ++f) {
    const bool front = is_inside(winding.front[f]), back = is_inside(winding.back[f]);
    const std::uint32_t parent = parent_of(arrangement->covers[f], back, face_of, input);
    const double size = area(arrangement->points, arrangement->facets[f]);
    if (parent != gap_face) {
      all += size;
      if (!front && !back) lost += size;
    }
    if (front == back) continue;
    Triangle t = arrangement->facets[f];
    if (front) std::swap(t[1], t[2]);
    boundary.triangles.push_back(t);
    boundary.parents.push_back(parent);
  }
  if (boundary.triangles.empty() || lost > kMaxLost * all) return {};
  separate_contacts(boundary, kGap_m);
  return boundary;
}

}  // namespace

std::optional<Shell> rebuild_3d(const Shell& input, const ReconstructOptions& options,
                                const RunContext& context) {
  const auto boundary = solid_of(input, options, context);
  if (!boundary) return {};
  // Polygons that were cut and rounded are not always plane enough to be triangulated anew.
  Shell polygons = faces_of(*boundary, input);
  return is_crossing(polygons) ? triangles_of(*boundary, input) : std::move(polygons);
}

}  // namespace citymesh
