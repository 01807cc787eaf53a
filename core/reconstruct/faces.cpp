#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/union_find.h"
#include "core/geometry/around_edge.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/outline.h"
#include "core/geometry/predicates.h"
#include "core/geometry/triangulation.h"
#include "core/reconstruct/boundary.h"

namespace citymesh {
namespace {

constexpr double kFlat_m = 0.005;  ///< a polygon's corners lie this close to its plane

double length(const Point3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

bool is_shared(const SolidBoundary& boundary, std::uint32_t f) {
  return !boundary.shared.empty() && boundary.shared[f];
}

/// Whether all corners lie in one plane wherever coordinates are rounded to: a plane across an
/// axis, or an upright one between two columns of corners.
bool is_plane_for_all(const std::vector<GridPoint>& points, const std::vector<Ring>& rings) {
  const GridPoint &first = points[rings[0][0]], *second = nullptr;
  bool x = true, y = true, z = true, columns = true;
  for (const Ring& ring : rings)
    for (const std::uint32_t v : ring) {
      const GridPoint& p = points[v];
      x = x && p.x == first.x;
      y = y && p.y == first.y;
      z = z && p.z == first.z;
      if (p.x == first.x && p.y == first.y) continue;
      if (!second) second = &p;
      columns = columns && p.x == second->x && p.y == second->y;
    }
  return x || y || z || columns;
}

/// Triangles of one parent, connected across edges that only two triangles share.
std::map<std::uint32_t, std::vector<std::uint32_t>> regions_of(const SolidBoundary& boundary) {
  UnionFind sets(boundary.triangles.size());
  for (const auto& [edge, fan] : edge_fans(boundary.triangles))
    if (fan.size() == 2 && boundary.parents[fan[0].facet] == boundary.parents[fan[1].facet] &&
        is_shared(boundary, fan[0].facet) == is_shared(boundary, fan[1].facet))
      sets.join(fan[0].facet, fan[1].facet);
  std::map<std::uint32_t, std::vector<std::uint32_t>> regions;
  for (std::uint32_t f = 0; f < boundary.triangles.size(); ++f) regions[sets.root(f)].push_back(f);
  return regions;
}

/// The polygon of a region; none when it is not one plane polygon.
std::vector<Ring> polygon_of(const SolidBoundary& boundary,
                             const std::vector<std::uint32_t>& region) {
  std::vector<Triangle> triangles;
  triangles.reserve(region.size());
  Point3 normal;
  for (const std::uint32_t f : region) {
    const Triangle& t = triangles.emplace_back(boundary.triangles[f]);
    const Point3 n = normal_of(boundary.points[t[0]], boundary.points[t[1]], boundary.points[t[2]]);
    normal = {normal.x + n.x, normal.y + n.y, normal.z + n.z};
  }
  std::vector<Ring> loops = polygon_of(boundary.points, triangles);
  if (loops.empty()) return {};
  if (is_shared(boundary, region[0]) && !is_plane_for_all(boundary.points, loops)) return {};

  const double size = length(normal);
  const GridPoint& base = boundary.points[loops[0][0]];
  double low = 0, high = 0;
  for (const Ring& loop : loops)
    for (const std::uint32_t v : loop) {
      const GridPoint& p = boundary.points[v];
      const double height =
          dot(normal, {static_cast<double>(p.x - base.x), static_cast<double>(p.y - base.y),
                       static_cast<double>(p.z - base.z)}) /
          size;
      low = std::min(low, height);
      high = std::max(high, height);
    }
  if ((high - low) * kGridStep_m > kFlat_m) return {};

  const auto filled = triangulate(boundary.points, loops);
  if (!filled) return {};
  double area = 0;
  for (const Triangle& t : *filled)
    area += length(normal_of(boundary.points[t[0]], boundary.points[t[1]], boundary.points[t[2]]));
  if (std::abs(area - size) > 0.001 * size) return {};
  return loops;
}

/// Collects faces that continue those of the input.
class Continued {
 public:
  Continued(const SolidBoundary& boundary, const Shell& input) : input_(input) {
    shell_.points = boundary.points;
    shell_.surface_ids = input.surface_ids;
  }

  void add(std::vector<Ring> rings, std::uint32_t parent) {
    Face face;
    if (parent < input_.faces.size()) {
      face = input_.faces[parent];
    } else {
      face.added = true;
    }
    face.rings = std::move(rings);
    shell_.faces.push_back(std::move(face));
  }
  void add_triangle(const Triangle& t, std::uint32_t parent) {
    add({Ring(t.begin(), t.end())}, parent);
  }

  Shell take() { return std::move(shell_); }

 private:
  const Shell& input_;
  Shell shell_;
};

/// Whether triangles of the faces meet elsewhere than in common corners and edges.
bool is_crossing(const Shell& shell) {
  std::vector<Triangle> triangles;
  for (const Face& face : shell.faces) {
    const auto pieces = triangulate(shell.points, face.rings);
    if (!pieces) return true;
    triangles.insert(triangles.end(), pieces->begin(), pieces->end());
  }
  const std::vector<GridBox> boxes = boxes_of(shell.points, triangles);
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

}  // namespace

Shell faces_of(const SolidBoundary& boundary, const Shell& input) {
  Continued shell(boundary, input);
  for (const auto& [root, region] : regions_of(boundary)) {
    std::vector<Ring> polygon = polygon_of(boundary, region);
    if (polygon.empty())
      for (const std::uint32_t f : region)
        shell.add_triangle(boundary.triangles[f], boundary.parents[f]);
    else
      shell.add(std::move(polygon), boundary.parents[root]);
  }
  return shell.take();
}

Shell triangles_of(const SolidBoundary& boundary, const Shell& input) {
  Continued shell(boundary, input);
  for (std::size_t f = 0; f < boundary.triangles.size(); ++f)
    shell.add_triangle(boundary.triangles[f], boundary.parents[f]);
  return shell.take();
}

Shell shell_of(const SolidBoundary& boundary, const Shell& input) {
  Shell polygons = faces_of(boundary, input);
  return is_crossing(polygons) ? triangles_of(boundary, input) : std::move(polygons);
}

}  // namespace citymesh
