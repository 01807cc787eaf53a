#include "core/reconstruct/columns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/base/union_find.h"
#include "core/citymodel/edges.h"

namespace citymesh {
namespace {

/// Heights of levels over vertices.
class Heights {
 public:
  explicit Heights(std::int64_t tolerance) : tolerance_(tolerance) {}

  void set(std::uint32_t vertex, std::uint32_t level, std::int64_t z) {
    if (vertex >= at_.size()) at_.resize(vertex + 1);
    at_[vertex][level] = z;
  }
  std::int64_t get(std::uint32_t vertex, std::uint32_t level) const {
    return at_[vertex].at(level);
  }
  const std::map<std::uint32_t, std::int64_t>& over(std::uint32_t vertex) const {
    return at_[vertex];
  }

  /// From below, heights within the tolerance of the first of them take the one that most share.
  void cluster(std::uint32_t vertex) {
    if (vertex >= at_.size()) return;
    std::map<std::int64_t, int> count;
    for (const auto& [level, z] : at_[vertex]) ++count[z];
    std::map<std::int64_t, std::int64_t> to;
    for (auto first = count.begin(); first != count.end();) {
      auto last = first;
      std::int64_t best = first->first;
      for (; last != count.end() && last->first - first->first <= tolerance_; ++last)
        if (last->second > count[best]) best = last->first;
      for (; first != last; ++first) to[first->first] = best;
    }
    for (auto& [level, z] : at_[vertex]) z = to[z];
  }

  void merge(std::uint32_t vertex, std::int64_t a, std::int64_t b) {
    for (auto& [level, z] : at_[vertex])
      if (z == a) z = b;
  }

 private:
  std::int64_t tolerance_;
  std::vector<std::map<std::uint32_t, std::int64_t>> at_;
};

class Boundary {
 public:
  Boundary(Partition partition, const Columns& columns, std::span<const LevelFace> levels,
           std::int64_t tolerance)
      : partition_(std::move(partition)),
        columns_(columns),
        levels_(levels),
        tolerance_(tolerance),
        heights_(tolerance) {}

  Shell build(const std::function<std::int64_t(std::uint32_t, std::uint32_t)>& height) {
    const auto raise = [&](std::uint32_t vertex, std::uint32_t cell) {
      const auto& column = columns_[cell];
      if (!column) return;
      const std::int64_t bottom = height(column->bottom, vertex);
      heights_.set(vertex, column->bottom, bottom);
      heights_.set(vertex, column->top, std::max(bottom, height(column->top, vertex)));
    };
    for (const Partition::Edge& edge : partition_.edges)
      for (const std::uint32_t cell : {edge.left, edge.right}) {
        raise(edge.from, cell);
        raise(edge.to, cell);
      }
    for (std::uint32_t v = 0; v < partition_.vertices.size(); ++v) heights_.cluster(v);
    cut_crossings();
    shell_.surface_ids.emplace_back();
    add_level_faces();
    for (const Partition::Edge& edge : partition_.edges) {
      add_walls(edge.from, edge.to, columns_[edge.left], columns_[edge.right]);
      add_walls(edge.to, edge.from, columns_[edge.right], columns_[edge.left]);
    }
    return std::move(shell_);
  }

 private:
  /// Where two levels over an edge change their order, the edge gets a vertex.
  void cut_crossings() {
    for (std::size_t i = 0; i < partition_.edges.size(); ++i) {
      const Partition::Edge edge = partition_.edges[i];
      if (columns_[edge.left] == columns_[edge.right]) continue;
      std::vector<std::uint32_t> levels;
      for (const std::uint32_t cell : {edge.left, edge.right})
        if (columns_[cell])
          levels.insert(levels.end(), {columns_[cell]->bottom, columns_[cell]->top});
      const std::uint32_t u = edge.from, v = edge.to;
      const GridPoint2 a = partition_.vertices[u], b = partition_.vertices[v];
      const double length =
          std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
      double first = 2;
      std::int64_t cut_z = 0;
      for (std::size_t s = 0; s < levels.size(); ++s)
        for (std::size_t t = s + 1; t < levels.size(); ++t) {
          const std::int64_t su = heights_.get(u, levels[s]), sv = heights_.get(v, levels[s]);
          const std::int64_t at_u = su - heights_.get(u, levels[t]),
                             at_v = sv - heights_.get(v, levels[t]);
          if (at_u == 0 || at_v == 0 || (at_u > 0) == (at_v > 0)) continue;
          const double position =
              static_cast<double>(at_u) / (static_cast<double>(at_u) - static_cast<double>(at_v));
          // Next to an end they meet in the end.
          const double margin = static_cast<double>(tolerance_) / length;
          if (position < margin || position > 1 - margin) {
            const std::uint32_t end = position < 0.5 ? u : v;
            heights_.merge(end, heights_.get(end, levels[t]), heights_.get(end, levels[s]));
            continue;
          }
          if (position >= first) continue;
          first = position;
          cut_z = std::llround(static_cast<double>(su) +
                               position * (static_cast<double>(sv) - static_cast<double>(su)));
        }
      if (first > 1) continue;
      const auto w = static_cast<std::uint32_t>(partition_.vertices.size());
      partition_.vertices.push_back({a.x + std::llround(first * static_cast<double>(b.x - a.x)),
                                     a.y + std::llround(first * static_cast<double>(b.y - a.y))});
      for (const std::uint32_t level : levels) {
        const auto at_u = static_cast<double>(heights_.get(u, level)),
                   at_v = static_cast<double>(heights_.get(v, level));
        const std::int64_t z = std::llround(at_u + first * (at_v - at_u));
        heights_.set(w, level, std::abs(z - cut_z) <= tolerance_ ? cut_z : z);
      }
      partition_.edges[i].to = w;
      partition_.edges.push_back({w, v, edge.left, edge.right});
    }
  }

  std::uint32_t point(std::uint32_t vertex, std::int64_t z) {
    const GridPoint2& p = partition_.vertices[vertex];
    const auto [at, is_new] =
        index_of_.emplace(GridPoint{p.x, p.y, z}, static_cast<std::uint32_t>(shell_.points.size()));
    if (is_new) shell_.points.push_back(at->first);
    return at->second;
  }

  void add_level_faces() {
    const auto by_level = [&](bool top) {
      std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> sides;
      const auto level_of = [&](std::uint32_t cell) -> std::optional<std::uint32_t> {
        if (!columns_[cell]) return {};
        return top ? columns_[cell]->top : columns_[cell]->bottom;
      };
      for (const Partition::Edge& edge : partition_.edges) {
        const auto left = level_of(edge.left), right = level_of(edge.right);
        if (left == right) continue;
        if (left) sides[*left].emplace_back(edge.from, edge.to);
        if (right) sides[*right].emplace_back(edge.to, edge.from);
      }
      for (const auto& [level, walk] : sides) add_areas(level, walk, top);
    };
    by_level(true);
    by_level(false);
  }

  /// Directed edges with the area on their left become rings that touch themselves nowhere.
  void add_areas(std::uint32_t level,
                 const std::vector<std::pair<std::uint32_t, std::uint32_t>>& sides, bool top) {
    std::multimap<std::uint32_t, std::uint32_t> leaving(sides.begin(), sides.end());
    std::vector<std::vector<std::uint32_t>> exteriors, holes;
    while (!leaving.empty()) {
      std::vector<std::uint32_t> path{leaving.begin()->first};
      const auto close = [&](std::size_t from) {
        std::vector<std::uint32_t> ring(path.begin() + static_cast<std::ptrdiff_t>(from),
                                        path.end());
        path.resize(from + 1);
        (twice_area(ring) > 0 ? exteriors : holes).push_back(std::move(ring));
      };
      do {
        const auto [first, last] = leaving.equal_range(path.back());
        auto taken = first;
        // Turning left as sharply as possible keeps rings apart that touch in a vertex.
        if (path.size() > 1)
          for (auto other = first; other != last; ++other)
            if (other != taken &&
                sharper(path[path.size() - 2], path.back(), other->second, taken->second))
              taken = other;
        const std::uint32_t to = taken->second;
        leaving.erase(taken);
        const auto seen = std::find(path.begin(), path.end(), to);
        if (seen == path.end())
          path.push_back(to);
        else
          close(static_cast<std::size_t>(seen - path.begin()));
      } while (path.size() > 1 || leaving.contains(path.back()));
    }
    std::vector<std::vector<std::vector<std::uint32_t>>> areas;
    areas.reserve(exteriors.size());
    for (auto& exterior : exteriors) areas.push_back({std::move(exterior)});
    for (auto& hole : holes)
      for (auto& area : areas)
        if (encloses(area[0], hole)) {
          area.push_back(std::move(hole));
          break;
        }
    for (auto& area : areas) {
      Face face;
      face.type = levels_[level].type;
      face.source = levels_[level].source;
      face.added = levels_[level].added;
      for (auto& ring : area) {
        Ring corners;
        for (const std::uint32_t v : ring) corners.push_back(point(v, heights_.get(v, level)));
        if (!top) std::reverse(corners.begin(), corners.end());
        face.rings.push_back(std::move(corners));
      }
      shell_.faces.push_back(std::move(face));
    }
  }

  Int128 twice_area(const std::vector<std::uint32_t>& ring) const {
    Int128 sum = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      sum += area2(partition_.vertices[ring[0]], partition_.vertices[ring[i]],
                   partition_.vertices[ring[i + 1]]);
    return sum;
  }

  /// Whether the turn from→at→a is more to the left than from→at→b.
  bool sharper(std::uint32_t from, std::uint32_t at, std::uint32_t a, std::uint32_t b) const {
    const auto angle = [&](std::uint32_t to) {
      const GridPoint2 &p = partition_.vertices[from], &q = partition_.vertices[at],
                       &r = partition_.vertices[to];
      const auto ux = static_cast<double>(q.x - p.x), uy = static_cast<double>(q.y - p.y),
                 vx = static_cast<double>(r.x - q.x), vy = static_cast<double>(r.y - q.y);
      return std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
    };
    return angle(a) > angle(b);
  }

  /// Rings have no crossings: a hole belongs where a corner of it, or the middle of an edge when
  /// all corners are on the ring, is inside.
  bool encloses(const std::vector<std::uint32_t>& ring,
                const std::vector<std::uint32_t>& hole) const {
    const auto inside = [&](double x, double y) {
      bool odd = false;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const GridPoint2 &a = partition_.vertices[ring[i]],
                         &b = partition_.vertices[ring[(i + 1) % ring.size()]];
        const auto ay = static_cast<double>(a.y), by = static_cast<double>(b.y);
        if ((ay > y) == (by > y)) continue;
        if (x < static_cast<double>(a.x) + static_cast<double>(b.x - a.x) * (y - ay) / (by - ay))
          odd = !odd;
      }
      return odd;
    };
    const std::set<std::uint32_t> corners(ring.begin(), ring.end());
    for (const std::uint32_t v : hole)
      if (!corners.contains(v))
        return inside(static_cast<double>(partition_.vertices[v].x),
                      static_cast<double>(partition_.vertices[v].y));
    const GridPoint2 &a = partition_.vertices[hole[0]], &b = partition_.vertices[hole[1]];
    return inside(static_cast<double>(a.x + b.x) / 2, static_cast<double>(a.y + b.y) / 2);
  }

  /// Walls of the column on the left of u→v towards the one on the right: what is in the first and
  /// not in the second.
  void add_walls(std::uint32_t u, std::uint32_t v, const std::optional<Column>& own,
                 const std::optional<Column>& other) {
    if (!own || own == other) return;
    struct Span {
      std::int64_t low, high;
    };
    const auto spans = [&](std::uint32_t vertex) {
      const std::int64_t low = heights_.get(vertex, own->bottom),
                         high = heights_.get(vertex, own->top);
      if (!other) return std::pair(Span{low, high}, Span{high, high});
      const std::int64_t other_low = heights_.get(vertex, other->bottom),
                         other_high = heights_.get(vertex, other->top);
      return std::pair(Span{low, std::max(low, std::min(high, other_low))},
                       Span{std::min(high, std::max(low, other_high)), high});
    };
    const auto at_u = spans(u), at_v = spans(v);
    const auto add = [&](const Span& su, const Span& sv) {
      if (su.low == su.high && sv.low == sv.high) return;
      Face face;
      face.added = true;
      Ring ring{point(u, su.low)};
      std::set<std::int64_t> levels;
      for (const auto& [level, z] : heights_.over(v))
        if (z >= sv.low && z <= sv.high) levels.insert(z);
      for (const std::int64_t z : levels) ring.push_back(point(v, z));
      levels.clear();
      for (const auto& [level, z] : heights_.over(u))
        if (z > su.low && z <= su.high) levels.insert(z);
      for (auto z = levels.rbegin(); z != levels.rend(); ++z) ring.push_back(point(u, *z));
      face.rings.push_back(std::move(ring));
      shell_.faces.push_back(std::move(face));
    };
    // Where the other column ends nowhere in between, both spans are one.
    if (at_u.first.high == at_u.second.low && at_v.first.high == at_v.second.low)
      add({at_u.first.low, at_u.second.high}, {at_v.first.low, at_v.second.high});
    else {
      add(at_u.first, at_v.first);
      add(at_u.second, at_v.second);
    }
  }

  Partition partition_;
  const Columns& columns_;
  std::span<const LevelFace> levels_;
  std::int64_t tolerance_;
  Heights heights_;
  Shell shell_;
  std::map<GridPoint, std::uint32_t> index_of_;
};

}  // namespace

Shell boundary_of(Partition partition, const Columns& columns, std::span<const LevelFace> levels,
                  const std::function<std::int64_t(std::uint32_t, std::uint32_t)>& height,
                  std::int64_t tolerance_steps) {
  return Boundary(std::move(partition), columns, levels, tolerance_steps).build(height);
}

std::vector<GridPoint2> pinches(const Shell& shell) {
  std::set<GridPoint2> places;
  // Corners of faces are joined across the edges at their vertex.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> corner_of;  // face, vertex
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f)
    for (const Ring& ring : shell.faces[f].rings)
      for (const std::uint32_t v : ring)
        corner_of.emplace(std::pair(f, v), static_cast<std::uint32_t>(corner_of.size()));
  UnionFind fans(corner_of.size());
  for (const auto& [edge, uses] : EdgeUses(shell)) {
    if (uses.size() > 2)
      for (const std::uint32_t v : {edge.first, edge.second})
        places.insert(project(shell.points[v], Axis::Z));
    for (std::size_t i = 1; i < uses.size(); ++i)
      for (const std::uint32_t v : {edge.first, edge.second})
        fans.join(corner_of.at({uses[i].face, v}), corner_of.at({uses[0].face, v}));
  }
  std::map<std::uint32_t, std::uint32_t> fan;  // by vertex
  for (const auto& [corner, index] : corner_of) {
    const auto [at, is_new] = fan.emplace(corner.second, fans.root(index));
    if (!is_new && at->second != fans.root(index))
      places.insert(project(shell.points[corner.second], Axis::Z));
  }
  return {places.begin(), places.end()};
}

}  // namespace citymesh
