#include "core/reconstruct/tidy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/geometry/measure.h"
#include "core/geometry/predicates.h"
#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

constexpr double kStraight_m = 0.00015;  ///< what rounding makes of a point on a line

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Whether all corners stand over one straight line.
bool is_one_plane(const Shell& shell, const Ring& ring) {
  GridPoint2 first = project(shell.points[ring[0]], Axis::Z), last = first;
  for (const std::uint32_t v : ring) {
    const GridPoint2 p = project(shell.points[v], Axis::Z);
    first = std::min(first, p);
    last = std::max(last, p);
  }
  return std::all_of(ring.begin(), ring.end(), [&](std::uint32_t v) {
    const GridPoint& p = shell.points[v];
    return distance_to_segment_m({p.x, p.y, 0}, {first.x, first.y, 0}, {last.x, last.y, 0}) <=
           kStraight_m;
  });
}

bool is_joinable(const Shell& shell, const Face& face) {
  return face.rings.size() == 1 && is_one_plane(shell, face.rings[0]);
}

/// The ring of `a` with the edge u→v replaced by the rest of `b`, which walks it v→u.
Ring joined(const Ring& a, const Ring& b, std::uint32_t u, std::uint32_t v) {
  Ring ring;
  const auto after = [](const Ring& r, std::uint32_t corner) {
    return static_cast<std::size_t>(std::find(r.begin(), r.end(), corner) - r.begin());
  };
  for (std::size_t i = 0, start = after(a, v); i < a.size(); ++i)
    ring.push_back(a[(start + i) % a.size()]);  // v … u
  for (std::size_t i = 1, start = after(b, u); i + 1 < b.size(); ++i)
    ring.push_back(b[(start + i) % b.size()]);  // after u … before v
  return ring;
}

void join_walls(Shell& shell) {
  std::map<DirectedEdge, std::uint32_t> face_of;
  std::vector<DirectedEdge> upright;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    if (!is_joinable(shell, shell.faces[f])) continue;
    const Ring& ring = shell.faces[f].rings[0];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const DirectedEdge edge{ring[i], ring[(i + 1) % ring.size()]};
      const auto [at, is_new] = face_of.emplace(edge, f);
      if (!is_new) at->second = ~0u;  // not manifold here
      const GridPoint &p = shell.points[edge.first], &q = shell.points[edge.second];
      if (p.x == q.x && p.y == q.y && p.z < q.z) upright.push_back(edge);
    }
  }
  for (const DirectedEdge& edge : upright) {
    const auto one = face_of.find(edge), two = face_of.find({edge.second, edge.first});
    if (one == face_of.end() || two == face_of.end()) continue;
    const std::uint32_t f = one->second, g = two->second;
    if (f == g || f == ~0u || g == ~0u) continue;
    Face &a = shell.faces[f], &b = shell.faces[g];
    if (std::tie(a.type, a.source, a.added) != std::tie(b.type, b.source, b.added)) continue;
    Ring ring = joined(a.rings[0], b.rings[0], edge.first, edge.second);
    if (!is_one_plane(shell, ring) ||
        std::set<std::uint32_t>(ring.begin(), ring.end()).size() != ring.size())
      continue;
    const Point3 n = ring_normal(shell.points, a.rings[0]),
                 m = ring_normal(shell.points, b.rings[0]);
    if (n.x * m.x + n.y * m.y <= 0) continue;
    a.rings[0] = std::move(ring);
    b.rings.clear();
    face_of.erase(one);
    face_of.erase(two);
    for (std::size_t i = 0; i < a.rings[0].size(); ++i)
      if (const auto at = face_of.find({a.rings[0][i], a.rings[0][(i + 1) % a.rings[0].size()]});
          at != face_of.end() && at->second == g)
        at->second = f;
  }
  std::erase_if(shell.faces, [](const Face& face) { return face.rings.empty(); });
}

void drop_straight_corners(Shell& shell) {
  struct Use {
    std::uint32_t before, after;
  };
  std::map<std::uint32_t, std::vector<Use>> uses;
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings)
      for (std::size_t i = 0; i < ring.size(); ++i)
        uses[ring[i]].push_back(
            {ring[(i + ring.size() - 1) % ring.size()], ring[(i + 1) % ring.size()]});
  std::set<std::uint32_t> dropped;
  for (const auto& [v, both] : uses) {
    if (both.size() != 2) continue;
    const auto [a, b] = std::pair(both[0].before, both[0].after);
    if (both[1].before != b || both[1].after != a || a == b) continue;
    // A neighbour that goes too would take the measure away.
    if (dropped.contains(a) || dropped.contains(b)) continue;
    if (distance_to_segment_m(shell.points[v], shell.points[a], shell.points[b]) > kStraight_m)
      continue;
    dropped.insert(v);
  }
  if (dropped.empty()) return;
  for (Face& face : shell.faces)
    for (const Ring& ring : face.rings)
      if (static_cast<std::size_t>(std::count_if(
              ring.begin(), ring.end(), [&](std::uint32_t v) { return !dropped.contains(v); })) < 3)
        for (const std::uint32_t v : ring) dropped.erase(v);
  for (Face& face : shell.faces)
    for (Ring& ring : face.rings)
      std::erase_if(ring, [&](std::uint32_t v) { return dropped.contains(v); });
}

}  // namespace

void tidy(Shell& shell) {
  join_walls(shell);
  drop_straight_corners(shell);
}

}  // namespace citymesh
