#include "tests/support/defects/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace citymesh::testing {

namespace {
/// Heights are compared as whole micrometres.
std::int64_t micrometres(double metres) { return std::llround(metres * 1e6); }
}  // namespace

/// Turns a plan into faces. A height is in micrometres here.
class Raising {
 public:
  explicit Raising(const Plan& plan) : plan_(plan) {
    for (const Plan::Cell& cell : plan.cells_)
      for (std::size_t r = 0; r < cell.rings.size(); ++r)
        for (std::size_t i = 0; i < cell.rings[r].size(); ++i) {
          const std::size_t next = (i + 1) % cell.rings[r].size();
          const int a = cell.rings[r][i], b = cell.rings[r][next];
          edges_[{a, b}] = {micrometres(cell.tops_m[r][i]), micrometres(cell.tops_m[r][next]),
                            micrometres(cell.floor_m)};
          levels_[a].insert({micrometres(cell.tops_m[r][i]), micrometres(cell.floor_m)});
        }
  }

  House run() {
    add_roofs();
    add_inner_walls();
    for (const std::vector<int>& loop : outline()) add_outer_walls(loop);
    add_floors();
    return std::move(house_);
  }

 private:
  struct Edge {
    std::int64_t top_a, top_b, floor;
  };
  using Ring = std::vector<Point3>;

  Point3 point(int corner, std::int64_t level) const {
    const auto& [x, y] = plan_.places_[static_cast<std::size_t>(corner)];
    return {static_cast<double>(micrometres(x)) / 1e6, static_cast<double>(micrometres(y)) / 1e6,
            static_cast<double>(level) / 1e6};
  }

  /// Vertical line at a corner, without its ends, through every level that other faces have there.
  void climb(Ring& ring, int corner, std::int64_t from, std::int64_t to) const {
    std::vector<std::int64_t> between;
    for (const std::int64_t level : levels_.at(corner))
      if (level > std::min(from, to) && level < std::max(from, to)) between.push_back(level);
    if (from > to) std::reverse(between.begin(), between.end());
    for (const std::int64_t level : between) ring.push_back(point(corner, level));
  }

  /// Adds a wall, without corners that follow each other.
  void add(SurfaceType type, Ring ring) {
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() > 2) house_.faces.push_back({type, {std::move(ring)}});
  }

  void add_roofs() {
    for (const Plan::Cell& cell : plan_.cells_) {
      HouseFace roof{SurfaceType::RoofSurface, {}};
      for (std::size_t r = 0; r < cell.rings.size(); ++r) {
        Ring ring;
        for (std::size_t i = 0; i < cell.rings[r].size(); ++i)
          ring.push_back(point(cell.rings[r][i], micrometres(cell.tops_m[r][i])));
        roof.rings.push_back(std::move(ring));
      }
      house_.faces.push_back(std::move(roof));
    }
  }

  /// The strip of a wall over the edge ab, seen from the right of it.
  void add_strip(int a, int b, std::int64_t low_a, std::int64_t low_b, std::int64_t high_a,
                 std::int64_t high_b) {
    Ring ring{point(a, low_a), point(b, low_b)};
    climb(ring, b, low_b, high_b);
    ring.push_back(point(b, high_b));
    ring.push_back(point(a, high_a));
    climb(ring, a, high_a, low_a);
    add(SurfaceType::WallSurface, std::move(ring));
  }

  void add_inner_walls() {
    for (const auto& [key, edge] : edges_) {
      const auto [a, b] = key;
      const auto across = edges_.find({b, a});
      if (across == edges_.end()) continue;
      const Edge& other = across->second;
      if (edge.top_a > other.top_b || edge.top_b > other.top_a)
        add_strip(a, b, other.top_b, other.top_a, edge.top_a, edge.top_b);
      if (edge.floor < other.floor)
        add_strip(a, b, edge.floor, edge.floor, other.floor, other.floor);
    }
  }

  /// Loops of edges with a cell on their left only.
  std::vector<std::vector<int>> outline() const {
    std::map<int, int> next;
    for (const auto& [key, edge] : edges_)
      if (!edges_.contains({key.second, key.first})) next[key.first] = key.second;
    std::vector<std::vector<int>> loops;
    while (!next.empty()) {
      std::vector<int> loop;
      for (auto at = next.begin(); at != next.end();) {
        const auto [a, b] = *at;
        loop.push_back(a);
        next.erase(at);
        at = next.find(b);
      }
      loops.push_back(std::move(loop));
    }
    return loops;
  }

  bool is_straight(int a, int b, int c) const {
    const Point3 p = point(a, 0), q = point(b, 0), r = point(c, 0);
    const double turn = (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x);
    const double length = std::hypot(q.x - p.x, q.y - p.y) * std::hypot(r.x - q.x, r.y - q.y);
    return std::abs(turn) < 1e-5 * length;
  }

  /// Corners at which the loop turns.
  std::vector<std::size_t> turns(const std::vector<int>& loop) const {
    std::vector<std::size_t> result;
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i)
      if (!is_straight(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n])) result.push_back(i);
    return result;
  }

  void add_outer_walls(const std::vector<int>& loop) {
    const std::vector<std::size_t> ends = turns(loop);
    for (std::size_t s = 0; s < ends.size(); ++s) {
      std::vector<int> side;
      for (std::size_t i = ends[s];; i = (i + 1) % loop.size()) {
        side.push_back(loop[i]);
        if (i == ends[(s + 1) % ends.size()]) break;
      }
      std::vector<Edge> edges;
      for (std::size_t i = 0; i + 1 < side.size(); ++i)
        edges.push_back(edges_.at({side[i], side[i + 1]}));
      Ring ring{point(side.front(), edges.front().floor)};
      for (std::size_t i = 1; i < edges.size(); ++i) {
        if (edges[i - 1].floor == edges[i].floor) continue;
        ring.push_back(point(side[i], edges[i - 1].floor));
        climb(ring, side[i], edges[i - 1].floor, edges[i].floor);
        ring.push_back(point(side[i], edges[i].floor));
      }
      ring.push_back(point(side.back(), edges.back().floor));
      climb(ring, side.back(), edges.back().floor, edges.back().top_b);
      ring.push_back(point(side.back(), edges.back().top_b));
      for (std::size_t i = edges.size() - 1; i > 0; --i) {
        ring.push_back(point(side[i], edges[i].top_a));
        climb(ring, side[i], edges[i].top_a, edges[i - 1].top_b);
        ring.push_back(point(side[i], edges[i - 1].top_b));
      }
      ring.push_back(point(side.front(), edges.front().top_a));
      climb(ring, side.front(), edges.front().top_a, edges.front().floor);
      add(SurfaceType::WallSurface, std::move(ring));
    }
  }

  void add_floors() {
    const double first = plan_.cells_.front().floor_m;
    if (std::any_of(plan_.cells_.begin(), plan_.cells_.end(),
                    [&](const Plan::Cell& cell) { return cell.floor_m != first; })) {
      for (const Plan::Cell& cell : plan_.cells_) {
        Ring ring;
        for (const int corner : cell.rings[0])
          ring.push_back(point(corner, micrometres(cell.floor_m)));
        std::reverse(ring.begin(), ring.end());
        add(cell.floor_m == 0 ? SurfaceType::GroundSurface : SurfaceType::OuterCeilingSurface,
            std::move(ring));
      }
      return;
    }
    // One face under all cells: the loop with the largest extent is the exterior.
    HouseFace ground{SurfaceType::GroundSurface, {}};
    for (const std::vector<int>& loop : outline()) {
      Ring ring;
      for (const std::size_t i : turns(loop)) ring.push_back(point(loop[i], micrometres(first)));
      std::reverse(ring.begin(), ring.end());
      ground.rings.push_back(std::move(ring));
    }
    std::stable_sort(ground.rings.begin(), ground.rings.end(), [](const Ring& a, const Ring& b) {
      return area_vector({{}, {a}}).z < area_vector({{}, {b}}).z;
    });
    house_.faces.push_back(std::move(ground));
  }

  const Plan& plan_;
  std::map<std::pair<int, int>, Edge> edges_;
  std::map<int, std::set<std::int64_t>> levels_;
  House house_;
};

House Plan::raise() const { return Raising(*this).run(); }

}  // namespace citymesh::testing
