#include "core/reconstruct/partition.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/box_tree.h"

namespace citymesh {
namespace {

using Areas = std::vector<std::uint32_t>;  ///< ascending
using EdgeKey2 = std::pair<std::uint32_t, std::uint32_t>;

/// What an edge of the network separates: areas that change from one side to the other.
struct Piece {
  Areas areas{};
  bool divides = false;
};

/// Lines on top of each other: an area that both bound is the same on both sides.
void combine(Piece& piece, const Piece& other) {
  Areas odd;
  std::set_symmetric_difference(piece.areas.begin(), piece.areas.end(), other.areas.begin(),
                                other.areas.end(), std::back_inserter(odd));
  piece.areas = std::move(odd);
  piece.divides = piece.divides || other.divides;
}

double distance(const GridPoint2& a, const GridPoint2& b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
}

/// Parameter of the foot of p on the line ab, and the distance to it.
struct Foot {
  double position = 0, distance = 0;
};
Foot foot_of(const GridPoint2& p, const GridPoint2& a, const GridPoint2& b) {
  const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const auto px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double squared = dx * dx + dy * dy;
  return {(px * dx + py * dy) / squared, std::abs(px * dy - py * dx) / std::sqrt(squared)};
}

GridBox box_of(const GridPoint2& a, const GridPoint2& b) {
  GridBox box = GridBox::of({a.x, a.y, 0});
  box.add(GridPoint{b.x, b.y, 0});
  return box;
}

GridTube tube(const GridPoint2& a, const GridPoint2& b, std::int64_t reach) {
  return {{a.x, a.y, 0}, {b.x, b.y, 0}, reach};
}

/// Vertices and pieces between them while they are brought to rest.
class Network {
 public:
  Network(std::span<const PartitionLine> lines, std::int64_t tolerance, std::size_t max_edges)
      : tolerance_(tolerance), max_edges_(max_edges) {
    for (const PartitionLine& line : lines) {
      places_.push_back(line.a);
      places_.push_back(line.b);
    }
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    given_ = places_.size();
    for (const PartitionLine& line : lines) {
      Piece piece;
      if (line.area == PartitionLine::kNoArea)
        piece.divides = true;
      else
        piece.areas.push_back(line.area);
      add(index_of(line.a), index_of(line.b), piece);
    }
    moved_.resize(given_);
    std::iota(moved_.begin(), moved_.end(), 0u);
  }

  bool come_to_rest() {
    constexpr int kRounds = 40;
    for (int round = 0; round < kRounds; ++round) {
      cluster();
      if (pieces_.size() > max_edges_) return false;
      if (split([this](auto& cuts) { find_near(cuts); })) continue;
      if (!split([this](auto& cuts) { find_crossings(cuts); })) return true;
    }
    return false;
  }

  const std::vector<GridPoint2>& places() const { return places_; }
  const std::map<EdgeKey2, Piece>& pieces() const { return pieces_; }
  std::size_t given() const { return given_; }
  std::uint32_t moved(std::size_t given) const { return moved_[given]; }
  const std::vector<GridPoint2>& given_places() const { return given_places_; }

 private:
  using Cuts = std::map<EdgeKey2, std::vector<std::uint32_t>>;

  std::uint32_t index_of(const GridPoint2& p) const {
    return static_cast<std::uint32_t>(std::lower_bound(places_.begin(), places_.end(), p) -
                                      places_.begin());
  }

  void add(std::uint32_t a, std::uint32_t b, const Piece& piece) {
    if (a == b) return;
    const auto [at, is_new] = pieces_.emplace(std::minmax(a, b), piece);
    if (!is_new) combine(at->second, piece);
    if (at->second.areas.empty() && !at->second.divides) pieces_.erase(at);
  }

  /// Vertices closer than the tolerance become the first of them; those given come before those
  /// constructed.
  void cluster() {
    if (given_places_.empty()) given_places_ = places_;
    std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::uint32_t>> kept;
    std::vector<std::uint32_t> to(places_.size());
    bool changed = false;
    const auto bucket = [&](std::int64_t c) {
      return c >= 0 ? c / tolerance_ : (c - tolerance_ + 1) / tolerance_;
    };
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      const GridPoint2& p = places_[i];
      to[i] = i;
      double nearest = static_cast<double>(tolerance_);
      for (std::int64_t dx = -1; dx <= 1; ++dx)
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
          const auto found = kept.find({bucket(p.x) + dx, bucket(p.y) + dy});
          if (found == kept.end()) continue;
          for (const std::uint32_t j : found->second)
            if (const double d = distance(p, places_[j]); d < nearest) {
              nearest = d;
              to[i] = j;
            }
        }
      if (to[i] == i)
        kept[{bucket(p.x), bucket(p.y)}].push_back(i);
      else
        changed = true;
    }
    if (!changed) return;
    std::map<EdgeKey2, Piece> before;
    before.swap(pieces_);
    for (const auto& [edge, piece] : before) add(to[edge.first], to[edge.second], piece);
    for (std::uint32_t& at : moved_) at = to[at];
  }

  std::vector<EdgeKey2> edges() const {
    std::vector<EdgeKey2> all;
    all.reserve(pieces_.size());
    for (const auto& [edge, piece] : pieces_) all.push_back(edge);
    return all;
  }

  template <class Find>
  bool split(Find&& find) {
    Cuts cuts;
    find(cuts);
    for (auto& [edge, at] : cuts) {
      const auto found = pieces_.find(edge);
      if (found == pieces_.end()) continue;
      const Piece piece = std::move(found->second);
      pieces_.erase(found);
      const GridPoint2 a = places_[edge.first], b = places_[edge.second];
      std::sort(at.begin(), at.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::pair(foot_of(places_[i], a, b).position, i) <
               std::pair(foot_of(places_[j], a, b).position, j);
      });
      std::uint32_t last = edge.first;
      for (const std::uint32_t i : at) {
        add(last, i, piece);
        last = i;
      }
      add(last, edge.second, piece);
    }
    return !cuts.empty();
  }

  /// Vertices on or near the inside of an edge.
  void find_near(Cuts& cuts) const {
    std::vector<char> used(places_.size(), 0);
    for (const auto& [edge, piece] : pieces_) used[edge.first] = used[edge.second] = 1;
    std::vector<std::uint32_t> vertices;
    std::vector<GridBox> boxes;
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
      if (!used[i]) continue;
      vertices.push_back(i);
      boxes.push_back(box_of(places_[i], places_[i]));
    }
    const BoxTree tree(boxes);
    for (const auto& [edge, piece] : pieces_) {
      const GridPoint2 &a = places_[edge.first], &b = places_[edge.second];
      tree.for_each_meeting(tube(a, b, tolerance_), [&, edge = edge](std::uint32_t k) {
        const std::uint32_t i = vertices[k];
        if (i == edge.first || i == edge.second) return;
        const Foot foot = foot_of(places_[i], a, b);
        if (foot.position > 0 && foot.position < 1 &&
            foot.distance < static_cast<double>(tolerance_))
          cuts[edge].push_back(i);
      });
    }
  }

  void find_crossings(Cuts& cuts) {
    const std::vector<EdgeKey2> all = edges();
    std::vector<GridBox> boxes;
    boxes.reserve(all.size());
    for (const EdgeKey2& edge : all)
      boxes.push_back(box_of(places_[edge.first], places_[edge.second]));
    const BoxTree tree(boxes);
    std::map<GridPoint2, std::uint32_t> constructed;
    for (std::uint32_t s = 0; s < all.size() && places_.size() <= 4 * max_edges_; ++s) {
      const GridPoint2 a = places_[all[s].first], b = places_[all[s].second];
      tree.for_each_meeting(tube(a, b, 0), [&](std::uint32_t t) {
        if (t <= s) return;
        const GridPoint2 c = places_[all[t].first], d = places_[all[t].second];
        const Int128 abc = area2(a, b, c), abd = area2(a, b, d);
        if (sign(abc) * sign(abd) >= 0 || orient2d(c, d, a) * orient2d(c, d, b) >= 0) return;
        const double along = static_cast<double>(abc) / static_cast<double>(abc - abd);
        const GridPoint2 p{c.x + std::llround(along * static_cast<double>(d.x - c.x)),
                           c.y + std::llround(along * static_cast<double>(d.y - c.y))};
        const auto [at, is_new] =
            constructed.emplace(p, static_cast<std::uint32_t>(places_.size()));
        if (is_new) places_.push_back(p);
        cuts[all[s]].push_back(at->second);
        cuts[all[t]].push_back(at->second);
      });
    }
  }

  std::int64_t tolerance_;
  std::size_t max_edges_;
  std::size_t given_ = 0;
  std::vector<GridPoint2> places_, given_places_;
  std::vector<std::uint32_t> moved_;  ///< by given place: where it is now
  std::map<EdgeKey2, Piece> pieces_;
};

/// Finds the cells between the pieces of a network. Half-edge 2i walks edge i forwards, 2i + 1
/// backwards; the cell of a half-edge is on its left.
class Cells {
 public:
  explicit Cells(const Network& network) {
    std::vector<std::uint32_t> index(network.places().size(), kNone);
    const auto vertex = [&](std::uint32_t place) {
      if (index[place] == kNone) {
        index[place] = static_cast<std::uint32_t>(result_.vertices.size());
        result_.vertices.push_back(network.places()[place]);
      }
      return index[place];
    };
    for (const auto& [edge, piece] : network.pieces()) {
      const std::uint32_t from = vertex(edge.first), to = vertex(edge.second);
      result_.edges.push_back({from, to, 0, 0});
      areas_.push_back(piece.areas);
    }
    for (std::size_t i = 0; i < network.given(); ++i)
      if (index[network.moved(i)] != kNone)
        result_.vertex_of.emplace(network.given_places()[i], index[network.moved(i)]);
  }

  Partition find() {
    link();
    walk();
    nest();
    cover();
    measure();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  std::uint32_t origin(std::uint32_t half) const {
    const Partition::Edge& edge = result_.edges[half / 2];
    return half % 2 == 0 ? edge.from : edge.to;
  }
  const GridPoint2& place(std::uint32_t half) const { return result_.vertices[origin(half)]; }

  /// Counter-clockwise order of directions, from the positive x axis.
  bool before(std::uint32_t s, std::uint32_t t) const {
    const GridPoint2 &o = place(s), &a = place(s ^ 1u), &b = place(t ^ 1u);
    const auto lower = [&](const GridPoint2& p) { return p.y < o.y || (p.y == o.y && p.x < o.x); };
    if (lower(a) != lower(b)) return lower(b);
    return orient2d(o, a, b) > 0;
  }

  void link() {
    std::vector<std::vector<std::uint32_t>> leaving(result_.vertices.size());
    for (std::uint32_t half = 0; half < 2 * result_.edges.size(); ++half)
      leaving[origin(half)].push_back(half);
    next_.resize(2 * result_.edges.size());
    for (auto& around : leaving) {
      std::sort(around.begin(), around.end(),
                [this](std::uint32_t s, std::uint32_t t) { return before(s, t); });
      for (std::size_t i = 0; i < around.size(); ++i)
        next_[around[(i + 1) % around.size()] ^ 1u] = around[i];
    }
  }

  void walk() {
    cycle_of_.assign(next_.size(), kNone);
    for (std::uint32_t start = 0; start < next_.size(); ++start) {
      if (cycle_of_[start] != kNone) continue;
      Cycle cycle{start, 0, kNone};
      const GridPoint2& base = place(start);
      std::uint32_t half = start;
      do {
        cycle_of_[half] = static_cast<std::uint32_t>(cycles_.size());
        cycle.twice_area += area2(base, place(half), place(half ^ 1u));
        if (place(half) < place(cycle.first)) cycle.first = half;
        half = next_[half];
      } while (half != start);
      cycles_.push_back(cycle);
    }
  }

  /// A cycle that runs clockwise is the outline of what lies in the cell to its left (west).
  void nest() {
    result_.cells.emplace_back();
    for (Cycle& cycle : cycles_) {
      if (cycle.twice_area <= 0) continue;
      cycle.cell = static_cast<std::uint32_t>(result_.cells.size());
      result_.cells.emplace_back();
    }
    std::vector<std::uint32_t> outlines;
    for (std::uint32_t i = 0; i < cycles_.size(); ++i)
      if (cycles_[i].cell == kNone) outlines.push_back(i);
    std::sort(outlines.begin(), outlines.end(), [this](std::uint32_t s, std::uint32_t t) {
      return std::pair(place(cycles_[s].first), s) < std::pair(place(cycles_[t].first), t);
    });
    for (const std::uint32_t i : outlines) {
      const std::uint32_t half = west_of(place(cycles_[i].first));
      cycles_[i].cell = half == kNone ? Partition::kOutside : cycles_[cycle_of_[half]].cell;
    }
    for (std::uint32_t i = 0; i < result_.edges.size(); ++i) {
      result_.edges[i].left = cycles_[cycle_of_[2 * i]].cell;
      result_.edges[i].right = cycles_[cycle_of_[2 * i + 1]].cell;
    }
  }

  /// The half-edge met first from p towards west, walked so that p is on its left.
  std::uint32_t west_of(const GridPoint2& p) const {
    std::uint32_t found = kNone;
    long double found_x = 0, found_slope = 0;
    for (std::uint32_t i = 0; i < result_.edges.size(); ++i) {
      GridPoint2 low = result_.vertices[result_.edges[i].from],
                 high = result_.vertices[result_.edges[i].to];
      const bool upwards = low.y < high.y;
      if (!upwards) std::swap(low, high);
      if (!(low.y <= p.y && p.y < high.y)) continue;
      if (orient2d(low, high, p) >= 0) continue;  // not west of p
      const long double slope =
          static_cast<long double>(high.x - low.x) / static_cast<long double>(high.y - low.y);
      const long double x =
          static_cast<long double>(low.x - p.x) + slope * static_cast<long double>(p.y - low.y);
      if (found != kNone && std::pair(x, slope) <= std::pair(found_x, found_slope)) continue;
      found = 2 * i + (upwards ? 1u : 0u);
      found_x = x;
      found_slope = slope;
    }
    return found;
  }

  /// Areas change across the edges that bound them; from the outside in.
  void cover() {
    std::vector<std::vector<std::uint32_t>> borders(result_.cells.size());
    for (std::uint32_t i = 0; i < result_.edges.size(); ++i) {
      borders[result_.edges[i].left].push_back(i);
      borders[result_.edges[i].right].push_back(i);
    }
    std::vector<char> known(result_.cells.size(), 0);
    std::vector<std::uint32_t> stack{Partition::kOutside};
    known[Partition::kOutside] = 1;
    while (!stack.empty()) {
      const std::uint32_t cell = stack.back();
      stack.pop_back();
      for (const std::uint32_t i : borders[cell]) {
        const std::uint32_t other =
            result_.edges[i].left == cell ? result_.edges[i].right : result_.edges[i].left;
        if (known[other]) continue;
        known[other] = 1;
        std::set_symmetric_difference(
            result_.cells[cell].areas.begin(), result_.cells[cell].areas.end(), areas_[i].begin(),
            areas_[i].end(), std::back_inserter(result_.cells[other].areas));
        stack.push_back(other);
      }
    }
  }

  /// Areas of the cells, and a place inside: between the edges met by a horizontal line through
  /// the cell, where they are farthest apart.
  void measure() {
    std::vector<std::vector<std::uint32_t>> borders(result_.cells.size());
    for (std::uint32_t i = 0; i < result_.edges.size(); ++i) {
      const Partition::Edge& edge = result_.edges[i];
      if (edge.left == edge.right) continue;
      borders[edge.left].push_back(i);
      borders[edge.right].push_back(i);
    }
    for (const Cycle& cycle : cycles_)
      result_.cells[cycle.cell].area_m2 +=
          static_cast<double>(cycle.twice_area) / 2 / (kGridStepsPerMetre * kGridStepsPerMetre);
    for (std::uint32_t cell = 1; cell < result_.cells.size(); ++cell)
      result_.cells[cell].inside = inside_of(borders[cell]);
  }

  GridPoint2 inside_of(const std::vector<std::uint32_t>& border) const {
    std::vector<std::int64_t> levels;
    for (const std::uint32_t i : border) {
      levels.push_back(result_.vertices[result_.edges[i].from].y);
      levels.push_back(result_.vertices[result_.edges[i].to].y);
    }
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    // A few of the widest bands between vertex heights are enough.
    std::vector<std::pair<std::int64_t, std::int64_t>> bands;  // negative height, y
    for (std::size_t i = 0; i + 1 < levels.size(); ++i)
      bands.emplace_back(levels[i] - levels[i + 1], levels[i] + (levels[i + 1] - levels[i]) / 2);
    std::sort(bands.begin(), bands.end());
    if (bands.size() > 8) bands.resize(8);
    GridPoint2 best{};
    double best_width = -1;
    for (const auto& [negative_height, y] : bands) {
      std::vector<double> hits;
      for (const std::uint32_t i : border) {
        const GridPoint2 &a = result_.vertices[result_.edges[i].from],
                         &b = result_.vertices[result_.edges[i].to];
        if ((a.y <= y) == (b.y <= y)) continue;
        hits.push_back(static_cast<double>(a.x) + static_cast<double>(b.x - a.x) *
                                                      static_cast<double>(y - a.y) /
                                                      static_cast<double>(b.y - a.y));
      }
      std::sort(hits.begin(), hits.end());
      for (std::size_t k = 0; k + 1 < hits.size(); k += 2) {
        const double width = std::min(hits[k + 1] - hits[k], -static_cast<double>(negative_height));
        if (width <= best_width) continue;
        best_width = width;
        best = {std::llround((hits[k] + hits[k + 1]) / 2), y};
      }
    }
    return best;
  }

  struct Cycle {
    std::uint32_t first = 0;  ///< half-edge that leaves its first vertex in (x, y) order
    Int128 twice_area = 0;
    std::uint32_t cell = 0;
  };

  Partition result_;
  std::vector<Areas> areas_;  ///< by edge
  std::vector<std::uint32_t> next_, cycle_of_;
  std::vector<Cycle> cycles_;
};

}  // namespace

std::optional<Partition> divide(std::span<const PartitionLine> lines, std::int64_t tolerance_steps,
                                std::size_t max_edges) {
  if (lines.size() > max_edges) return {};
  Network network(lines, tolerance_steps, max_edges);
  if (!network.come_to_rest()) return {};
  return Cells(network).find();
}

}  // namespace citymesh
