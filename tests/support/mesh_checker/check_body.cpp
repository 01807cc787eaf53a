#include "tests/support/mesh_checker/check_body.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>

namespace mesh_checker {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace PMP = CGAL::Polygon_mesh_processing;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }

std::string place(const Point& point) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4f %.4f %.4f)", point[0], point[1], point[2]);
  return text;
}

/// "3 open edges, the first at (1 2 3)"
class Tally {
 public:
  explicit Tally(std::string what) : what_(std::move(what)) {}
  void count(const Point& where) {
    if (count_++ == 0) first_ = place(where);
  }
  void report(std::vector<std::string>& findings) const {
    if (count_ > 0)
      findings.push_back(std::to_string(count_) + " " + what_ + ", the first at " + first_);
  }

 private:
  std::string what_;
  std::size_t count_ = 0;
  std::string first_;
};

/// Disjoint sets of 0 … n-1.
class Sets {
 public:
  explicit Sets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parents_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parents_;
};

void check_triangles(const Body& body, const Limits& limits, std::vector<std::string>& findings) {
  Tally degenerate("degenerate triangles");
  for (const auto& [a, b, c] : body.triangles) {
    const Point &p = body.points[a], &q = body.points[b], &r = body.points[c];
    const double longest =
        std::max({length(minus(q, p)), length(minus(r, q)), length(minus(p, r))});
    const double doubled_area = length(cross(minus(q, p), minus(r, p)));
    if (doubled_area < 2 * limits.least_area_m2 ||
        doubled_area < longest * limits.least_height_m * (1 - 1e-6))
      degenerate.count(p);
  }
  degenerate.report(findings);
}

struct Edge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  bool upward;  // runs from low to high in its triangle
};

std::vector<Edge> sorted_edges(const Body& body) {
  std::vector<Edge> edges;
  edges.reserve(body.triangles.size() * 3);
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto from = body.triangles[t][i], to = body.triangles[t][(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

/// Edges: two triangles each, in opposite directions. Vertices: one fan of triangles each. Joins
/// the triangles that share an edge.
void check_manifold(const Body& body, Sets& components, std::vector<std::string>& findings) {
  Tally open("open edges"), crowded("edges with more than two triangles"),
      clashing("edges where neighbours are oriented against each other"),
      pinched("vertices with more than one fan of triangles");
  const auto edges = sorted_edges(body);
  Sets corners(body.triangles.size() * 3);  // fans: corners joined across edges
  const auto corner_of = [&](std::uint32_t triangle, std::uint32_t point) -> std::size_t {
    const auto& corner = body.triangles[triangle];
    const auto i =
        static_cast<std::size_t>(std::find(corner.begin(), corner.end(), point) - corner.begin());
    return triangle * std::size_t{3} + i;
  };
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low &&
           edges[end].high == edges[begin].high)
      ++end;
    const Point& where = body.points[edges[begin].low];
    if (end - begin == 1) open.count(where);
    if (end - begin > 2) crowded.count(where);
    if (end - begin == 2 && edges[begin].upward == edges[begin + 1].upward) clashing.count(where);
    for (std::size_t i = begin + 1; i < end; ++i) {
      components.join(edges[begin].triangle, edges[i].triangle);
      for (const auto point : {edges[i].low, edges[i].high})
        corners.join(corner_of(edges[begin].triangle, point), corner_of(edges[i].triangle, point));
    }
  }
  constexpr std::size_t kUnset = static_cast<std::size_t>(-1);
  std::vector<std::size_t> fan_of(body.points.size(), kUnset);
  std::vector<bool> blamed(body.points.size(), false);
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t)
    for (const auto point : body.triangles[t]) {
      const auto fan = corners.find(corner_of(t, point));
      if (fan_of[point] == kUnset) {
        fan_of[point] = fan;
      } else if (fan_of[point] != fan && !blamed[point]) {
        blamed[point] = true;
        pinched.count(body.points[point]);
      }
    }
  for (const auto* tally : {&open, &crowded, &clashing, &pinched}) tally->report(findings);
}

double signed_volume(const Body& body, const std::vector<Triangle>& triangles) {
  if (body.points.empty()) return 0;
  const Point& origin = body.points.front();  // near the body, so that little is lost
  double six_volumes = 0;
  for (const auto& [a, b, c] : triangles)
    six_volumes += dot(minus(body.points[a], origin),
                       cross(minus(body.points[b], origin), minus(body.points[c], origin)));
  return six_volumes / 6;
}

Surface surface_of(const Body& body, const std::vector<Triangle>& triangles) {
  std::map<std::uint32_t, Surface::Vertex_index> vertices;
  Surface surface;
  for (const auto& triangle : triangles) {
    std::array<Surface::Vertex_index, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [entry, is_new] = vertices.try_emplace(triangle[i]);
      if (is_new) {
        const Point& point = body.points[triangle[i]];
        entry->second = surface.add_vertex({point[0], point[1], point[2]});
      }
      corners[i] = entry->second;
    }
    surface.add_face(corners[0], corners[1], corners[2]);
  }
  return surface;
}

/// Outer surfaces enclose a positive volume, cavities a negative one. A component is a cavity when
/// it lies inside an odd number of others; the components are known not to intersect.
void check_orientation(const Body& body, Sets& components, std::vector<std::string>& findings) {
  std::map<std::size_t, std::vector<Triangle>> parts;
  for (std::size_t t = 0; t < body.triangles.size(); ++t)
    parts[components.find(t)].push_back(body.triangles[t]);

  struct Part {
    const std::vector<Triangle>* triangles;
    Surface surface;
    std::unique_ptr<CGAL::Side_of_triangle_mesh<Surface, Kernel>> side;
  };
  std::vector<std::unique_ptr<Part>> shells;
  for (const auto& [root, triangles] : parts) {
    auto part = std::make_unique<Part>();
    part->triangles = &triangles;
    if (parts.size() > 1) {
      part->surface = surface_of(body, triangles);
      part->side = std::make_unique<CGAL::Side_of_triangle_mesh<Surface, Kernel>>(part->surface);
    }
    shells.push_back(std::move(part));
  }
  for (const auto& shell : shells) {
    const Point& point = body.points[shell->triangles->front()[0]];
    std::size_t depth = 0;
    for (const auto& other : shells)
      if (other != shell &&
          (*other->side)(Kernel::Point_3(point[0], point[1], point[2])) == CGAL::ON_BOUNDED_SIDE)
        ++depth;
    const double volume = signed_volume(body, *shell->triangles);
    if (depth % 2 == 0 && volume <= 0)
      findings.push_back("the surface at " + place(point) + " is not oriented outward");
    if (depth % 2 == 1 && volume >= 0)
      findings.push_back("the cavity at " + place(point) + " is not oriented inward");
  }
}

}  // namespace

std::vector<std::string> check(const Body& body, const Limits& limits) {
  std::vector<std::string> findings = body.findings;
  const auto is_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (body.name.empty() || !std::all_of(body.name.begin(), body.name.end(), is_name) ||
      (body.name[0] >= '0' && body.name[0] <= '9') || body.name[0] == '_')
    findings.push_back("the name is not a letter followed by letters, digits and underscores");
  if (body.triangles.empty()) {
    findings.push_back("has no triangles");
    return findings;
  }
  check_triangles(body, limits, findings);
  // A triangle with a repeated corner has no edges to speak of.
  for (const auto& [a, b, c] : body.triangles)
    if (a == b || b == c || c == a) return findings;

  const std::size_t before = findings.size();
  Sets components(body.triangles.size());
  check_manifold(body, components, findings);
  if (findings.size() != before) return findings;

  const Surface surface = surface_of(body, body.triangles);
  if (surface.number_of_faces() != body.triangles.size()) {
    findings.push_back("its triangles do not form a surface");
    return findings;
  }
  if (PMP::does_self_intersect<CGAL::Sequential_tag>(surface)) {
    findings.push_back("intersects itself");
    return findings;
  }
  check_orientation(body, components, findings);
  return findings;
}

double signed_volume_m3(const Body& body) { return signed_volume(body, body.triangles); }

}  // namespace mesh_checker
