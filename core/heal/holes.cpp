#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/citymodel/edges.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/patch.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

constexpr std::size_t kMaxChordSearch = 200;  ///< corners of a loop up to which chords are tried
constexpr std::size_t kMaxSearch =
    10'000'000;  ///< work limit, of all loops: corners of pieces tried

constexpr double kUprightSlope = 0.1;       ///< of the normal, within 6 degrees of the horizontal
constexpr double kUprightPreference = 100;  ///< of areas

struct Plane {
  Point3 normal{};   ///< unit length; zero for a degenerate loop
  Point3 through{};  ///< in steps
  double distance_m(const GridPoint& p) const {
    return std::abs(normal.x * (static_cast<double>(p.x) - through.x) +
                    normal.y * (static_cast<double>(p.y) - through.y) +
                    normal.z * (static_cast<double>(p.z) - through.z)) *
           kGridStep_m;
  }
};

Plane plane_of(const Shell& shell, const Ring& loop) {
  Plane plane;
  const Point3 n = ring_normal(shell.points, loop);
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (length > 0) plane.normal = {n.x / length, n.y / length, n.z / length};
  for (const std::uint32_t corner : loop) {
    plane.through.x += static_cast<double>(shell.points[corner].x);
    plane.through.y += static_cast<double>(shell.points[corner].y);
    plane.through.z += static_cast<double>(shell.points[corner].z);
  }
  const auto n_corners = static_cast<double>(loop.size());
  plane.through = {plane.through.x / n_corners, plane.through.y / n_corners,
                   plane.through.z / n_corners};
  return plane;
}

double area_m2(const Shell& shell, const Ring& loop) {
  const Point3 n = ring_normal(shell.points, loop);
  return std::hypot(n.x, n.y, n.z) / 2 * kGridStep_m * kGridStep_m;
}

bool is_planar(const Shell& shell, const Ring& loop, double tolerance_m) {
  if (loop.size() < 3) return false;
  const Plane plane = plane_of(shell, loop);
  if (plane.normal == Point3{}) return false;
  return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t corner) {
    return plane.distance_m(shell.points[corner]) <= tolerance_m;
  });
}

/// Loops that walk every free edge against the face it belongs to, cut where they touch themselves.
std::vector<Ring> free_loops(const Shell& shell) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;
  for (const auto& [edge, uses] : EdgeUses(shell)) {
    if (uses.size() != 1) continue;
    if (uses[0].forward)
      next[edge.second].push_back(edge.first);
    else
      next[edge.first].push_back(edge.second);
  }
  std::vector<Ring> loops;
  for (auto& start : next) {
    while (!start.second.empty()) {
      Ring path{start.first};
      std::map<std::uint32_t, std::size_t> position{{start.first, 0}};
      while (true) {
        auto out = next.find(path.back());
        if (out == next.end() || out->second.empty()) break;
        const std::uint32_t to = out->second.back();
        out->second.pop_back();
        const auto seen = position.find(to);
        if (seen == position.end()) {
          position[to] = path.size();
          path.push_back(to);
          continue;
        }
        const auto from = static_cast<std::ptrdiff_t>(seen->second);
        loops.emplace_back(path.begin() + from, path.end());
        for (auto it = path.begin() + from + 1; it != path.end(); ++it) position.erase(*it);
        path.erase(path.begin() + from + 1, path.end());
        if (path.size() == 1 && next[path[0]].empty()) break;
      }
    }
  }
  return loops;
}

/// Cuts planar pieces off a loop along chords, upright ones first, as what misses are mostly walls,
/// and the largest first of those; what is left may not be planar.
void split_into_planar(const Shell& shell, Ring loop, double tolerance_m, std::size_t& work,
                       std::vector<Ring>& planar, std::vector<Ring>& rest) {
  while (!is_planar(shell, loop, tolerance_m)) {
    const std::size_t n = loop.size();
    if (n <= kMaxChordSearch) work += n * n * n / 2;
    if (n < 4 || n > kMaxChordSearch || work > kMaxSearch) {
      rest.push_back(std::move(loop));
      return;
    }
    double best_area = 0;
    Ring best_piece, best_remainder;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t length = 2; length + 1 < n; ++length) {
        Ring piece;
        for (std::size_t k = 0; k <= length; ++k) piece.push_back(loop[(i + k) % n]);
        if (!is_planar(shell, piece, tolerance_m)) continue;
        const Point3 normal = ring_normal(shell.points, piece);
        double area = std::hypot(normal.x, normal.y, normal.z);
        if (std::abs(normal.z) <= kUprightSlope * area) area *= kUprightPreference;
        if (area <= best_area) continue;
        Ring remainder;
        for (std::size_t k = length; k <= n; ++k) remainder.push_back(loop[(i + k) % n]);
        best_area = area;
        best_piece = std::move(piece);
        best_remainder = std::move(remainder);
      }
    if (best_piece.empty()) {
      rest.push_back(std::move(loop));
      return;
    }
    planar.push_back(std::move(best_piece));
    loop = std::move(best_remainder);
  }
  planar.push_back(std::move(loop));
}

Ring sorted(Ring ring) {
  std::sort(ring.begin(), ring.end());
  return ring;
}

bool inside(const Shell& shell, const Ring& ring, const GridPoint& point, Axis axis) {
  bool result = false;
  const GridPoint2 p = project(point, axis);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint2 a = project(shell.points[ring[i]], axis),
                     b = project(shell.points[ring[(i + 1) % ring.size()]], axis);
    if ((a.y > p.y) != (b.y > p.y) && (orient2d(a, b, p) > 0) == (b.y > a.y)) result = !result;
  }
  return result;
}

}  // namespace

void close_holes(Shell& shell, StepContext& context) {
  std::vector<Ring> planar, rest;
  std::size_t work = 0;
  for (Ring& loop : free_loops(shell))
    split_into_planar(shell, std::move(loop), context.planarity_tolerance_m, work, planar, rest);

  // A face that hangs free is no hole: closing its outline would only double it.
  std::set<Ring> outlines;
  for (const Face& face : shell.faces) outlines.insert(sorted(face.rings[0]));
  std::erase_if(planar, [&](const Ring& loop) { return outlines.contains(sorted(loop)); });
  for (const Ring& loop : rest) {
    const std::size_t n = std::min(loop.size(), kMaxPatchCorners);
    work += n * n * n / 6;
    if (work > 2 * kMaxSearch) break;
    if (const auto patch = minimal_patch(shell.points, loop))
      for (const Triangle& t : *patch) planar.push_back({t[0], t[1], t[2]});
  }
  std::erase_if(planar,
                [&](const Ring& loop) { return area_m2(shell, loop) > context.max_hole_area_m2; });

  // A loop inside another one in the same plane, walked the other way round, is a hole of the
  // other's face: the courtyard of a missing ground.
  std::vector<Plane> planes;
  planes.reserve(planar.size());
  for (const Ring& loop : planar) planes.push_back(plane_of(shell, loop));
  std::vector<std::size_t> owner(planar.size());
  std::vector<GridBox> boxes;
  for (const Ring& loop : planar) {
    GridBox box = GridBox::of(shell.points[loop[0]]);
    for (const std::uint32_t corner : loop) box.add(shell.points[corner]);
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  // Off the plane by the tolerance, a place over a ring may be off its box by more.
  const auto reach =
      static_cast<std::int64_t>(std::ceil(4 * context.planarity_tolerance_m * kGridStepsPerMetre));
  for (std::size_t i = 0; i < planar.size(); ++i) {
    owner[i] = i;
    const GridPoint& corner = shell.points[planar[i][0]];
    std::size_t first = planar.size();
    tree.for_each_meeting(GridBox::of(corner).grown(reach), [&](std::uint32_t j) {
      if (i == j || j > first) return;
      const Point3 &n = planes[i].normal, &m = planes[j].normal;
      if (n.x * m.x + n.y * m.y + n.z * m.z > -0.99) return;
      if (planes[j].distance_m(corner) <= context.planarity_tolerance_m &&
          inside(shell, planar[j], corner, dominant_axis(m)))
        first = j;
    });
    if (first < planar.size()) owner[i] = first;
  }
  std::vector<Face> faces(planar.size());
  for (std::size_t i = 0; i < planar.size(); ++i)
    if (owner[i] == i)
      faces[i].rings.insert(faces[i].rings.begin(), planar[i]);
    else if (owner[owner[i]] == owner[i])
      faces[owner[i]].rings.push_back(planar[i]);
  for (std::size_t i = 0; i < planar.size(); ++i) {
    if (owner[i] != i) continue;
    constexpr double kGroundSlope = 0.17;  // within 10 degrees of the vertical it is no ground
    faces[i].type = planes[i].normal.z < -kGroundSlope ? SurfaceType::GroundSurface
                                                       : SurfaceType::ClosureSurface;
    context.note("hole_closed", shell.points[planar[i][0]]);
    faces[i].added = true;
    shell.faces.push_back(std::move(faces[i]));
  }
}

}  // namespace citymesh
