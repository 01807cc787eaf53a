#include "core/geometry/triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <map>

namespace citymesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
// Info of a face: 0 not visited, 1 outside, 2 inside.
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<char, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge_of(std::uint32_t a, std::uint32_t b) { return a < b ? Edge{a, b} : Edge{b, a}; }

double squared_length(const GridPoint& a, const GridPoint& b) {
  const auto x = static_cast<double>(a.x - b.x), y = static_cast<double>(a.y - b.y),
             z = static_cast<double>(a.z - b.z);
  return x * x + y * y + z * z;
}

/// Square of the smallest height.
double flatness(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const Point3 n = normal_of(a, b, c);
  return (n.x * n.x + n.y * n.y + n.z * n.z) /
         std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
}

/// A strictly convex quadrilateral is cut so that its flattest triangle is least flat; none: not
/// strictly convex in the projection.
std::optional<std::vector<Triangle>> split_quadrilateral(std::span<const GridPoint> points,
                                                         const std::vector<std::uint32_t>& ring,
                                                         Axis axis, bool seen_from_front) {
  GridPoint2 corner[4];
  for (std::size_t i = 0; i < 4; ++i) corner[i] = project(points[ring[i]], axis);
  const int wanted = seen_from_front ? 1 : -1;
  for (std::size_t i = 0; i < 4; ++i)
    if (orient2d(corner[i], corner[(i + 1) % 4], corner[(i + 2) % 4]) != wanted) return {};
  const auto worst = [&](std::size_t i) {  // of the cut from corner i to the opposite one
    const GridPoint &a = points[ring[i]], &b = points[ring[i + 1]], &c = points[ring[(i + 2) % 4]],
                    &d = points[ring[(i + 3) % 4]];
    return std::min(flatness(a, b, c), flatness(a, c, d));
  };
  if (worst(0) >= worst(1))
    return std::vector<Triangle>{{ring[0], ring[1], ring[2]}, {ring[0], ring[2], ring[3]}};
  return std::vector<Triangle>{{ring[1], ring[2], ring[3]}, {ring[1], ring[3], ring[0]}};
}

}  // namespace

Point3 ring_normal(std::span<const GridPoint> points, std::span<const std::uint32_t> ring) {
  Point3 normal;
  if (ring.empty()) return normal;
  const GridPoint& base =
      points[ring[0]];  // relative to a corner: no cancellation far from the origin
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point3 add = normal_of(base, points[ring[i]], points[ring[(i + 1) % ring.size()]]);
    normal.x += add.x, normal.y += add.y, normal.z += add.z;
  }
  return normal;
}

Axis dominant_axis(const Point3& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (z >= x && z >= y) return Axis::Z;
  return x >= y ? Axis::X : Axis::Y;
}

std::optional<std::vector<Triangle>> triangulate(
    std::span<const GridPoint> points, std::span<const std::vector<std::uint32_t>> rings) {
  if (rings.empty() || rings[0].size() < 3) return {};
  const Point3 normal = ring_normal(points, rings[0]);
  const Axis axis = dominant_axis(normal);
  const double along = axis == Axis::X ? normal.x : axis == Axis::Y ? normal.y : normal.z;
  if (along == 0.0) return {};
  const bool seen_from_front = along > 0;

  if (rings.size() == 1 && rings[0].size() == 3)
    return std::vector<Triangle>{{rings[0][0], rings[0][1], rings[0][2]}};
  if (rings.size() == 1 && rings[0].size() == 4)
    if (auto quad = split_quadrilateral(points, rings[0], axis, seen_from_front)) return quad;

  Cdt cdt;
  std::map<std::uint32_t, Cdt::Vertex_handle> vertex_of;
  std::map<Edge, int> uses;
  try {
    Cdt::Face_handle hint;
    for (const auto& ring : rings)
      for (const std::uint32_t index : ring) {
        if (vertex_of.contains(index)) continue;
        const GridPoint2 p = project(points[index], axis);
        const auto before = cdt.number_of_vertices();
        const auto vertex = cdt.insert({static_cast<double>(p.x), static_cast<double>(p.y)}, hint);
        if (cdt.number_of_vertices() == before) return {};  // two corners in one place
        vertex->info() = index;
        hint = vertex->face();
        vertex_of.emplace(index, vertex);
      }
    for (const auto& ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
        if (a == b) return {};
        if (++uses[edge_of(a, b)] == 1) cdt.insert_constraint(vertex_of[a], vertex_of[b]);
      }
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return {};
  }
  if (cdt.dimension() < 2) return {};

  // Parity from the outside in. A constraint that runs through a corner is split there by CGAL:
  // such an edge is not in `uses`, so the rings overlap.
  for (const auto face : cdt.all_face_handles()) face->info() = 0;
  std::vector<Cdt::Face_handle> stack{cdt.infinite_face()};
  cdt.infinite_face()->info() = 1;
  std::vector<Triangle> triangles;
  while (!stack.empty()) {
    const auto face = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto next = face->neighbor(i);
      char side = face->info();
      if (face->is_constrained(i)) {
        const auto found =
            uses.find(edge_of(face->vertex(Cdt::cw(i))->info(), face->vertex(Cdt::ccw(i))->info()));
        if (found == uses.end()) return {};
        if (found->second % 2 == 1) side = side == 1 ? 2 : 1;
      }
      if (next->info() != 0) {
        if (next->info() != side) return {};
        continue;
      }
      next->info() = side;
      stack.push_back(next);
    }
  }
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (face->info() != 2) continue;
    Triangle t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    if (!seen_from_front) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  if (triangles.empty()) return {};
  return triangles;
}

}  // namespace citymesh
