#include "core/reconstruct/fidelity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/triangulation.h"
#include "core/reconstruct/sheets.h"

namespace citymesh {
namespace {

constexpr double kSameWall_m = 0.1;   ///< how far a wall may stand from the one it continues
constexpr double kKept_m = 0.1;       ///< pieces of the input this close to the result are kept
constexpr double kCrumb_m2 = 0.1;     ///< what may be lost
constexpr std::int64_t kReach = 500;  ///< walls this close to each other join, in steps
constexpr double kFinShare = 0.3;     ///< of all area, what walls may have that enclose nothing
constexpr double kCrumbShare = 0.01;  ///< of all area; the larger of the two counts

/// Triangles of a face; none of rings that cross, whose shape nobody knows.
std::vector<Triangle> triangles_of(const Shell& shell, const Face& face) {
  auto triangles = triangulate(shell.points, face.rings);
  return triangles ? std::move(*triangles) : std::vector<Triangle>{};
}

/// Whether lines seen from above enclose an area worth its name.
bool encloses_area(const std::vector<PartitionLine>& lines) {
  constexpr std::size_t kMaxLines = 2000;
  const auto divided = divide(lines, kReach, kMaxLines);
  if (!divided) return true;
  double area_m2 = 0;
  for (std::size_t c = 1; c < divided->cells.size(); ++c) area_m2 += divided->cells[c].area_m2;
  return area_m2 > kCrumb_m2;
}

GridPoint middle(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
}

/// Which places are inside a closed shell.
class Inside {
 public:
  Inside(std::span<const GridPoint> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), tree_(boxes_of(points, triangles)) {}

  bool operator()(const GridPoint& p) const {
    GridBox up = GridBox::of(p);
    up.max.z = 2 * kGridLimit;
    int winding = 0;
    const GridPoint2 o{p.x, p.y};
    tree_.for_each_meeting(up, [&](std::uint32_t i) {
      const GridPoint &a = points_[triangles_[i][0]], &b = points_[triangles_[i][1]],
                      &c = points_[triangles_[i][2]];
      const std::array<GridPoint2, 3> t{project(a, Axis::Z), project(b, Axis::Z),
                                        project(c, Axis::Z)};
      const int facing = orient2d(t[0], t[1], t[2]);
      if (facing == 0) return;
      // A ray moved by nothing much to the north-east meets no edge twice.
      bool hit = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const GridPoint2 &u = t[k], &v = t[(k + 1) % 3];
        if ((u.y > o.y) == (v.y > o.y)) continue;
        const int side = orient2d(u, v, o);
        if (side == 0 ? v.y > u.y : (side > 0) == (v.y > u.y)) hit = !hit;
      }
      if (hit && orient3d(a, b, c, p) * facing < 0) winding += facing;
    });
    return winding > 0;
  }

 private:
  std::span<const GridPoint> points_;
  std::span<const Triangle> triangles_;
  BoxTree tree_;
};

}  // namespace

void name_walls(Shell& result, const Shell& input, std::span<const std::uint32_t> vertical) {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face_of;
  std::vector<GridBox> boxes;
  for (const std::uint32_t f : vertical)
    for (const Triangle& t : sheet_of(input, input.faces[f])) {
      triangles.push_back(t);
      face_of.push_back(f);
      boxes.push_back(box_of(input.points, t));
    }
  const BoxTree tree(boxes);
  const auto reach = static_cast<std::int64_t>(kSameWall_m * kGridStepsPerMetre);
  for (Face& face : result.faces) {
    if (face.type != SurfaceType::Unknown || !face.added || face.source != 0) continue;
    const Point3 normal = ring_normal(result.points, face.rings[0]);
    if (normal.z != 0) continue;
    const auto own = triangles_of(result, face);
    const auto area = [&](const Triangle& t) { return area_m2(result.points, std::span(&t, 1)); };
    const auto largest =
        std::max_element(own.begin(), own.end(),
                         [&](const Triangle& s, const Triangle& t) { return area(s) < area(t); });
    face.type = SurfaceType::WallSurface;
    if (largest == own.end()) continue;
    const GridPoint centre = middle(result.points[(*largest)[0]], result.points[(*largest)[1]],
                                    result.points[(*largest)[2]]);
    double nearest = kSameWall_m;
    tree.for_each_meeting(GridBox::of(centre).grown(reach), [&](std::uint32_t i) {
      const Triangle& t = triangles[i];
      const GridPoint &a = input.points[t[0]], &b = input.points[t[1]], &c = input.points[t[2]];
      const Point3 n = normal_of(a, b, c);
      // Parallel within a few degrees.
      const double cross = n.x * normal.y - n.y * normal.x,
                   lengths = std::hypot(n.x, n.y) * std::hypot(normal.x, normal.y);
      if (lengths == 0 || std::abs(cross) > 0.1 * lengths) return;
      const double d = distance_to_triangle_m(centre, a, b, c);
      if (d > nearest || (d == nearest && !face.added)) return;
      nearest = d;
      const Face& from = input.faces[face_of[i]];
      face.type = from.type;
      face.source = from.source;
      face.added = false;
    });
  }
}

bool is_faithful(const Shell& result, const Shell& input, std::span<const FaceRole> roles) {
  std::vector<Triangle> after;
  for (const Face& face : result.faces) {
    const auto triangles = triangles_of(result, face);
    after.insert(after.end(), triangles.begin(), triangles.end());
  }
  const DistanceField field(result.points, after);
  const Inside inside(result.points, after);
  double total_m2 = 0, lost_m2 = 0, lost_walls_m2 = 0;
  std::vector<PartitionLine> lost_walls;
  for (std::size_t f = 0; f < input.faces.size(); ++f) {
    if (roles[f] == FaceRole::Ignored) continue;
    double face_lost_m2 = 0;
    for (const Triangle& t : triangles_of(input, input.faces[f])) {
      const GridPoint &a = input.points[t[0]], &b = input.points[t[1]], &c = input.points[t[2]];
      const double triangle_m2 = area_m2(input.points, std::span(&t, 1));
      total_m2 += triangle_m2;
      const GridPoint m = middle(a, b, c);
      // Each sample stands for a part of the triangle around it.
      const std::array samples{m,
                               middle(a, a, m),
                               middle(b, b, m),
                               middle(c, c, m),
                               middle(a, b, m),
                               middle(b, c, m),
                               middle(c, a, m)};
      for (const GridPoint& p : samples)
        if (field.distance_m(p) > kKept_m && !inside(p))
          face_lost_m2 += triangle_m2 / static_cast<double>(samples.size());
    }
    if (face_lost_m2 <= 0) continue;
    if (roles[f] == FaceRole::Vertical) {
      lost_walls_m2 += face_lost_m2;
      lost_walls.push_back(seen_from_above(input, input.faces[f]));
    } else {
      lost_m2 += face_lost_m2;
    }
  }
  const double crumbs_m2 = std::max(kCrumb_m2, kCrumbShare * total_m2);
  if (lost_m2 > crumbs_m2) return false;
  return lost_m2 + lost_walls_m2 <= crumbs_m2 ||
         (lost_walls_m2 <= kFinShare * total_m2 && !encloses_area(lost_walls));
}

}  // namespace citymesh
