#include "core/geometry/arrangement_cut.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

#include <cmath>

#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Exact::FT;
using ExactPoint = Exact::Point_3;
using CutVertexBase = CGAL::Triangulation_vertex_base_with_info_2<GridPoint, Exact>;
using CutFaceBase = CGAL::Constrained_triangulation_face_base_2<Exact>;
using CutCdt = CGAL::Constrained_Delaunay_triangulation_2<
    Exact, CGAL::Triangulation_data_structure_2<CutVertexBase, CutFaceBase>,
    CGAL::Exact_intersections_tag>;

ExactPoint exact(const GridPoint& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Exact::Triangle_3 exact(const Corners& t) { return {exact(t[0]), exact(t[1]), exact(t[2])}; }

/// Nearest whole number; halves go up, for every way in which the number was found.
std::int64_t rounded(const Number& value) {
  auto [low, high] = CGAL::to_interval(value);
  if (std::floor(high + 0.5) - std::floor(low + 0.5) > 1) {
    value.exact();
    std::tie(low, high) = CGAL::to_interval(value);
  }
  const double below = std::floor(low + 0.5), above = std::floor(high + 0.5);
  return static_cast<std::int64_t>(below == above || value < Number(above - 0.5) ? below : above);
}

/// The plane of a triangle, seen along its dominant axis.
class CutPlane {
 public:
  explicit CutPlane(const Corners& t)
      : axis_(dominant_axis(t[0], t[1], t[2])),
        origin_(exact(t[0])),
        normal_(CGAL::cross_product(exact(t[1]) - origin_, exact(t[2]) - origin_)) {}

  Exact::Point_2 project(const ExactPoint& p) const {
    switch (axis_) {
      case Axis::X:
        return {p.y(), p.z()};
      case Axis::Y:
        return {p.z(), p.x()};
      case Axis::Z:
        break;
    }
    return {p.x(), p.y()};
  }

  GridPoint lift(const Exact::Point_2& p) const {
    const auto third = [&](const Number& u0, const Number& v0, const Number& w0, const Number& nu,
                           const Number& nv, const Number& nw) {
      return Number(w0 - (nu * (p.x() - u0) + nv * (p.y() - v0)) / nw);
    };
    const std::int64_t u = rounded(p.x()), v = rounded(p.y());
    const ExactPoint& o = origin_;
    const Exact::Vector_3& n = normal_;
    switch (axis_) {
      case Axis::X:
        return {rounded(third(o.y(), o.z(), o.x(), n.y(), n.z(), n.x())), u, v};
      case Axis::Y:
        return {v, rounded(third(o.z(), o.x(), o.y(), n.z(), n.x(), n.y())), u};
      case Axis::Z:
        break;
    }
    return {u, v, rounded(third(o.x(), o.y(), o.z(), n.x(), n.y(), n.z()))};
  }

  bool seen_from_front() const {
    const Number& along = axis_ == Axis::X   ? normal_.x()
                          : axis_ == Axis::Y ? normal_.y()
                                             : normal_.z();
    return CGAL::is_positive(along);
  }

 private:
  Axis axis_;
  ExactPoint origin_;
  Exact::Vector_3 normal_;
};

}  // namespace

std::vector<Corners> cut_triangle(const Corners& facet, std::span<const Corners> others) {
  const CutPlane plane(facet);
  CutCdt cdt;
  for (const GridPoint& corner : facet) cdt.insert(plane.project(exact(corner)));
  const Exact::Triangle_3 whole = exact(facet);
  const auto add_point = [&](const ExactPoint& p) { cdt.insert(plane.project(p)); };
  const auto add_segment = [&](const ExactPoint& p, const ExactPoint& q) {
    const Exact::Point_2 a = plane.project(p), b = plane.project(q);
    if (a == b)
      cdt.insert(a);
    else
      cdt.insert_constraint(a, b);
  };
  for (const Corners& other : others) {
    const auto common = CGAL::intersection(whole, exact(other));
    if (!common) continue;
    if (const auto* point = boost::get<ExactPoint>(&*common)) {
      add_point(*point);
    } else if (const auto* segment = boost::get<Exact::Segment_3>(&*common)) {
      add_segment(segment->source(), segment->target());
    } else if (const auto* triangle = boost::get<Exact::Triangle_3>(&*common)) {
      for (int i = 0; i < 3; ++i) add_segment(triangle->vertex(i), triangle->vertex(i + 1));
    } else if (const auto* polygon = boost::get<std::vector<ExactPoint>>(&*common)) {
      for (std::size_t i = 0; i < polygon->size(); ++i)
        add_segment((*polygon)[i], (*polygon)[(i + 1) % polygon->size()]);
    }
  }
  for (const auto vertex : cdt.finite_vertex_handles())
    vertex->info() = plane.lift(vertex->point());

  std::vector<Corners> pieces;
  const bool front = plane.seen_from_front();
  for (const auto face : cdt.finite_face_handles()) {
    Corners piece{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    if (!front) std::swap(piece[1], piece[2]);
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace citymesh
