#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/union_find.h"
#include "core/geometry/around_edge.h"
#include "core/geometry/predicates.h"
#include "core/reconstruct/boundary.h"

namespace citymesh {
namespace {

// Every triangle has three corners 3f + i. Corners at one vertex that are joined across edges are a
// fan; a manifold vertex has one.

std::uint32_t corner_at(const SolidBoundary& boundary, std::uint32_t f, std::uint32_t v) {
  const Triangle& t = boundary.triangles[f];
  return 3 * f + (t[0] == v ? 0u : t[1] == v ? 1u : 2u);
}

/// Triangles on both sides of one wedge of the solid.
struct Wedge {
  std::uint32_t first, second;
};

std::vector<Wedge> wedges_at(const SolidBoundary& boundary, std::uint32_t a, std::uint32_t b,
                             std::vector<EdgeFacet>& fan) {
  std::vector<Wedge> wedges;
  if (fan.size() == 2) return {{fan[0].facet, fan[1].facet}};
  sort_around(boundary.points, a, b, fan);
  for (std::size_t i = 0; i < fan.size(); ++i)
    if (!fan[i].forward) wedges.push_back({fan[i].facet, fan[(i + 1) % fan.size()].facet});
  return wedges;
}

/// Joins corners along all edges; edges whose wedges stay together at both ends are returned.
std::vector<std::pair<std::uint32_t, std::uint32_t>> join_fans(const SolidBoundary& boundary,
                                                               UnionFind& corners) {
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::vector<Wedge>>> shared;
  for (auto& [edge, fan] : edge_fans(boundary.triangles)) {
    std::vector<Wedge> wedges = wedges_at(boundary, edge.first, edge.second, fan);
    for (const Wedge& wedge : wedges)
      for (const std::uint32_t v : {edge.first, edge.second})
        corners.join(corner_at(boundary, wedge.first, v), corner_at(boundary, wedge.second, v));
    if (wedges.size() > 1) shared.emplace_back(edge, std::move(wedges));
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stuck;
  for (const auto& [edge, wedges] : shared) {
    bool apart = true;
    for (std::size_t i = 0; i < wedges.size(); ++i)
      for (std::size_t j = i + 1; j < wedges.size(); ++j) {
        const auto same_fan = [&](std::uint32_t v) {
          return corners.root(corner_at(boundary, wedges[i].first, v)) ==
                 corners.root(corner_at(boundary, wedges[j].first, v));
        };
        apart = apart && !(same_fan(edge.first) && same_fan(edge.second));
      }
    if (!apart) stuck.push_back(edge);
  }
  return stuck;
}

/// Puts a vertex in the middle of an edge.
void halve(SolidBoundary& boundary, std::uint32_t a, std::uint32_t b) {
  const GridPoint &p = boundary.points[a], &q = boundary.points[b];
  const auto middle = static_cast<std::uint32_t>(boundary.points.size());
  boundary.points.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
  const auto count = static_cast<std::uint32_t>(boundary.triangles.size());
  for (std::uint32_t f = 0; f < count; ++f) {
    Triangle& t = boundary.triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = t[i], v = t[(i + 1) % 3], w = t[(i + 2) % 3];
      if (!((u == a && v == b) || (u == b && v == a))) continue;
      t = {u, middle, w};
      boundary.triangles.push_back({middle, v, w});
      boundary.parents.push_back(boundary.parents[f]);
      if (!boundary.shared.empty()) boundary.shared.push_back(boundary.shared[f]);
      break;
    }
  }
}

/// Into the solid, from the normals of a fan weighted by their angles (Thürmer, Wüthrich 1998).
Point3 inwards(const SolidBoundary& boundary, const std::vector<std::uint32_t>& fan) {
  Point3 sum;
  for (const std::uint32_t corner : fan) {
    const Triangle& t = boundary.triangles[corner / 3];
    const std::size_t i = corner % 3;
    const GridPoint &p = boundary.points[t[i]], &q = boundary.points[t[(i + 1) % 3]],
                    &r = boundary.points[t[(i + 2) % 3]];
    const Point3 n = normal_of(p, q, r);
    const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    if (length == 0) continue;
    const auto dot =
        static_cast<double>(Int128{q.x - p.x} * (r.x - p.x) + Int128{q.y - p.y} * (r.y - p.y) +
                            Int128{q.z - p.z} * (r.z - p.z));
    const double angle = std::atan2(length, dot);
    sum = {sum.x - angle * n.x / length, sum.y - angle * n.y / length,
           sum.z - angle * n.z / length};
  }
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  if (length < 1e-9) return {};
  return {sum.x / length, sum.y / length, sum.z / length};
}

}  // namespace

void separate_contacts(SolidBoundary& boundary, double gap_m) {
  constexpr int kRounds = 3;  // halving an edge makes two that may be stuck in turn
  UnionFind corners(0);
  for (int round = 0; round < kRounds; ++round) {
    corners = UnionFind(boundary.triangles.size() * 3);
    const auto stuck = join_fans(boundary, corners);
    if (stuck.empty()) break;
    for (const auto& [a, b] : stuck) halve(boundary, a, b);
  }
  if (corners.size() != boundary.triangles.size() * 3) {
    corners = UnionFind(boundary.triangles.size() * 3);
    join_fans(boundary, corners);
  }

  std::map<std::uint32_t, std::map<std::uint32_t, std::vector<std::uint32_t>>> fans_of_vertex;
  for (std::uint32_t corner = 0; corner < corners.size(); ++corner)
    fans_of_vertex[boundary.triangles[corner / 3][corner % 3]][corners.root(corner)].push_back(
        corner);
  const double gap = gap_m * kGridStepsPerMetre;
  struct Move {
    std::vector<std::uint32_t> corners;
    GridPoint to;
  };
  std::vector<Move> moves;
  for (const auto& [vertex, fans] : fans_of_vertex) {
    if (fans.size() < 2) continue;
    for (const auto& [root, fan] : fans) {
      const Point3 in = inwards(boundary, fan);
      const GridPoint& p = boundary.points[vertex];
      moves.push_back({fan,
                       {p.x + std::llround(in.x * gap), p.y + std::llround(in.y * gap),
                        p.z + std::llround(in.z * gap)}});
    }
  }
  for (const Move& move : moves) {
    const auto copy = static_cast<std::uint32_t>(boundary.points.size());
    boundary.points.push_back(move.to);
    for (const std::uint32_t corner : move.corners)
      boundary.triangles[corner / 3][corner % 3] = copy;
  }
}

}  // namespace citymesh
