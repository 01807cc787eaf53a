#include "core/geometry/triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>

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

/// How a polygon is seen along the axis that its normal is nearest to.
struct View {
  Axis axis{};
  bool from_front = true;
};

std::optional<View> view_of(std::span<const GridPoint> points,
                            std::span<const std::uint32_t> ring) {
  const Point3 normal = ring_normal(points, ring);
  const Axis axis = dominant_axis(normal);
  const double along = axis == Axis::X ? normal.x : axis == Axis::Y ? normal.y : normal.z;
  if (along == 0.0) return {};
  return View{axis, along > 0};
}

/// A strictly convex quadrilateral is cut so that its flattest triangle is least flat; none: not
/// strictly convex in the projection.
std::optional<std::vector<Triangle>> split_quadrilateral(std::span<const GridPoint> points,
                                                         const std::vector<std::uint32_t>& ring,
                                                         const View& seen) {
  GridPoint2 corner[4];
  for (std::size_t i = 0; i < 4; ++i) corner[i] = project(points[ring[i]], seen.axis);
  const int wanted = seen.from_front ? 1 : -1;
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

/// Rings in numbers of their own: corners in the order in which the rings name them.
struct Polygon {
  std::vector<GridPoint> corners{};
  std::vector<std::uint32_t> rings{};  ///< one after the other
  std::vector<std::uint32_t> ends{};   ///< of each ring
  friend bool operator==(const Polygon&, const Polygon&) = default;

  std::span<const std::uint32_t> ring(std::size_t r) const {
    const std::uint32_t first = r == 0 ? 0 : ends[r - 1];
    return std::span(rings).subspan(first, ends[r] - first);
  }
  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t r = 0; r < ends.size(); ++r) {
      const auto corners_of_ring = ring(r);
      for (std::size_t i = 0; i < corners_of_ring.size(); ++i)
        visit(corners_of_ring[i], corners_of_ring[i + 1 == corners_of_ring.size() ? 0 : i + 1]);
    }
  }
};

/// `numbers`: of the polygon's corners among `points`.
Polygon polygon_of(std::span<const GridPoint> points,
                   std::span<const std::vector<std::uint32_t>> rings,
                   std::vector<std::uint32_t>& numbers) {
  Polygon polygon;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;  // corner among points, place
  for (const auto& ring : rings) {
    for (const std::uint32_t corner : ring)
      places.emplace_back(corner, static_cast<std::uint32_t>(places.size()));
    polygon.ends.push_back(static_cast<std::uint32_t>(places.size()));
  }
  std::sort(places.begin(), places.end());
  // Every place learns where its corner is named first.
  polygon.rings.resize(places.size());
  for (std::size_t i = 0, first = 0; i < places.size(); ++i) {
    if (places[i].first != places[first].first) first = i;
    polygon.rings[places[i].second] = places[first].second;
  }
  std::size_t place = 0;
  std::vector<std::uint32_t> number_at(places.size());
  for (const auto& ring : rings)
    for (const std::uint32_t corner : ring) {
      if (polygon.rings[place] == place) {
        number_at[place] = static_cast<std::uint32_t>(numbers.size());
        numbers.push_back(corner);
        polygon.corners.push_back(points[corner]);
      }
      polygon.rings[place] = number_at[polygon.rings[place]];
      ++place;
    }
  return polygon;
}

std::optional<std::vector<Triangle>> triangulate(const Polygon& polygon) {
  const auto seen = view_of(polygon.corners, polygon.ring(0));
  if (!seen) return {};
  std::vector<Edge> uses;  // sorted
  bool repeats = false;
  polygon.for_each_edge([&](std::uint32_t a, std::uint32_t b) {
    repeats = repeats || a == b;
    uses.push_back(edge_of(a, b));
  });
  if (repeats) return {};
  std::sort(uses.begin(), uses.end());

  Cdt cdt;
  try {
    std::vector<Cdt::Vertex_handle> vertices;
    Cdt::Face_handle hint;
    for (const GridPoint& corner : polygon.corners) {
      const GridPoint2 p = project(corner, seen->axis);
      const auto before = cdt.number_of_vertices();
      vertices.push_back(cdt.insert({static_cast<double>(p.x), static_cast<double>(p.y)}, hint));
      if (cdt.number_of_vertices() == before) return {};  // two corners in one place
      vertices.back()->info() = static_cast<std::uint32_t>(vertices.size() - 1);
      hint = vertices.back()->face();
    }
    polygon.for_each_edge(
        [&](std::uint32_t a, std::uint32_t b) { cdt.insert_constraint(vertices[a], vertices[b]); });
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
        const auto [first, last] = std::equal_range(
            uses.begin(), uses.end(),
            edge_of(face->vertex(Cdt::cw(i))->info(), face->vertex(Cdt::ccw(i))->info()));
        if (first == last) return {};
        if ((last - first) % 2 == 1) side = side == 1 ? 2 : 1;
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
    if (!seen->from_front) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  if (triangles.empty()) return {};
  return triangles;
}

std::size_t hash_of(const Polygon& polygon) {
  std::uint64_t hash = polygon.rings.size();
  for (const GridPoint& p : polygon.corners)
    for (const std::int64_t number : {p.x, p.y, p.z})
      hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
  return static_cast<std::size_t>(hash);
}

/// A step of healing, a gate and a check look at the same polygons in turn: each thread remembers
/// those it saw last.
std::optional<std::vector<Triangle>> remembered(Polygon polygon) {
  struct Slot {
    Polygon polygon{};
    std::optional<std::vector<Triangle>> triangles{};
  };
  constexpr std::size_t kSlots = 1024, kMaxCorners = 256;
  if (polygon.rings.size() > kMaxCorners) return triangulate(polygon);
  static thread_local std::vector<Slot> slots(kSlots);
  Slot& slot = slots[hash_of(polygon) % kSlots];
  if (slot.polygon != polygon) {
    slot.triangles = triangulate(polygon);
    slot.polygon = std::move(polygon);
  }
  return slot.triangles;
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
  if (rings.size() == 1 && rings[0].size() <= 4) {
    const auto seen = view_of(points, rings[0]);
    if (!seen) return {};
    if (rings[0].size() == 3) return std::vector<Triangle>{{rings[0][0], rings[0][1], rings[0][2]}};
    if (auto quad = split_quadrilateral(points, rings[0], *seen)) return quad;
  }
  std::vector<std::uint32_t> numbers;
  Polygon polygon = polygon_of(points, rings, numbers);
  auto triangles = remembered(std::move(polygon));
  if (triangles)
    for (Triangle& t : *triangles)
      for (std::uint32_t& corner : t) corner = numbers[corner];
  return triangles;
}

}  // namespace citymesh
