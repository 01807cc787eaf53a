#include "core/geometry/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "core/geometry/arrangement_cut.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

struct Facet {
  Triangle corners{};
  std::vector<Cover> covers{};
  bool fresh = true;  ///< not yet tested against the others
};

using Path = std::vector<std::uint32_t>;

struct GridPointHash {
  std::size_t operator()(const GridPoint& p) const {
    return static_cast<std::size_t>(p.x) * 73856093u ^ static_cast<std::size_t>(p.y) * 19349663u ^
           static_cast<std::size_t>(p.z) * 83492791u;
  }
};

bool is_flat(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z})
    if (orient2d(project(a, axis), project(b, axis), project(c, axis)) != 0) return false;
  return true;
}

class Refinement {
 public:
  Refinement(std::span<const GridPoint> points, std::span<const Triangle> triangles,
             const ArrangeOptions& options)
      : options_(options),
        near_m_(kNear * options.tolerance_m),
        reach_(static_cast<std::int64_t>(std::ceil(options.tolerance_m * kGridStepsPerMetre))) {
    std::vector<std::uint32_t> index(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) index[i] = add_point(points[i]);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      facets_.push_back(
          {{index[triangles[t][0]], index[triangles[t][1]], index[triangles[t][2]]}, {{t, true}}});
    join_equal_facets();
    max_facets_ = std::min<std::uint64_t>(options.max_facets, 2000 + kMaxGrowth * facets_.size());
  }

  bool run() {
    for (std::uint32_t round = 0; round < options_.max_rounds; ++round) {
      const bool near = round < kNearRounds;
      const bool merged = near && merge_near_points();
      const bool inserted = near && insert_near_vertices();
      if (facets_.size() > max_facets_) return false;
      bool cut = false;
      if (!cut_crossings(cut)) return false;
      if (!merged && !inserted && !cut) return true;
    }
    return false;
  }

  Arrangement result() && {
    Arrangement arrangement;
    std::vector<std::uint32_t> index(points_.size(), kNone);
    for (Facet& facet : facets_) {
      for (std::uint32_t& corner : facet.corners) {
        if (index[corner] == kNone) {
          index[corner] = static_cast<std::uint32_t>(arrangement.points.size());
          arrangement.points.push_back(points_[corner]);
        }
        corner = index[corner];
      }
      arrangement.facets.push_back(facet.corners);
      arrangement.covers.push_back(std::move(facet.covers));
    }
    return arrangement;
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  /// Vertices reach further for each other than for edges and facets, else an edge could take a
  /// vertex in that its ends are too far from to merge with, and give it back in the next round.
  static constexpr double kNear = 0.7;
  /// Later rounds leave alone what is near but does not cross: bringing it together bends facets,
  /// which may cross anew, and so on.
  static constexpr std::uint32_t kNearRounds = 2;
  static constexpr std::uint64_t kMaxGrowth = 8;  ///< beyond it the rounds do not converge

  std::uint32_t add_point(const GridPoint& p) {
    const auto [at, added] = index_of_.emplace(p, static_cast<std::uint32_t>(points_.size()));
    if (added) points_.push_back(p);
    return at->second;
  }

  std::vector<std::uint32_t> used_vertices() const {
    std::vector<char> used(points_.size(), 0);
    for (const Facet& facet : facets_)
      for (const std::uint32_t v : facet.corners) used[v] = 1;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < points_.size(); ++v)
      if (used[v]) vertices.push_back(v);
    return vertices;
  }

  BoxTree tree_of(const Path& vertices) const {
    std::vector<GridBox> boxes;
    boxes.reserve(vertices.size());
    for (const std::uint32_t v : vertices) boxes.push_back(GridBox::of(points_[v]));
    return BoxTree(boxes);
  }

  /// Facets over the same corners become one; flat ones vanish. Keeps the order sorted by corners.
  void join_equal_facets() {
    std::map<Triangle, Facet> joined;
    for (Facet& facet : facets_) {
      const auto& [a, b, c] = facet.corners;
      if (a == b || b == c || c == a || is_flat(points_[a], points_[b], points_[c])) continue;
      Triangle key = facet.corners;
      std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
      const bool along = key[1] < key[2];
      if (!along) std::swap(key[1], key[2]);
      Facet& target = joined[key];
      if (target.covers.empty()) {
        target.corners = key;
        target.fresh = facet.fresh;
      }
      target.fresh = target.fresh && facet.fresh;
      for (const Cover& cover : facet.covers)
        target.covers.push_back({cover.input, cover.along == along});
    }
    facets_.clear();
    for (auto& [key, facet] : joined) {
      std::sort(facet.covers.begin(), facet.covers.end(), [](const Cover& s, const Cover& t) {
        return std::tie(s.input, s.along) < std::tie(t.input, t.along);
      });
      facets_.push_back(std::move(facet));
    }
  }

  /// Points within the tolerance of an earlier one take its place: those of the input stay.
  bool merge_near_points() {
    const std::vector<std::uint32_t> vertices = used_vertices();
    const BoxTree tree = tree_of(vertices);
    std::vector<std::uint32_t> target(points_.size());
    for (std::uint32_t v = 0; v < target.size(); ++v) target[v] = v;
    bool changed = false;
    for (const std::uint32_t v : vertices) {  // ascending: earlier points decide first
      double nearest_m = options_.tolerance_m;
      tree.for_each_meeting(GridBox::of(points_[v]).grown(reach_), [&](std::uint32_t k) {
        const std::uint32_t other = vertices[k];
        if (other >= v || target[other] != other) return;
        const double d = distance_m(points_[v], points_[other]);
        if (d < nearest_m || (d == nearest_m && (target[v] == v || other < target[v]))) {
          nearest_m = d;
          target[v] = other;
        }
      });
      changed = changed || target[v] != v;
    }
    if (!changed) return false;
    for (Facet& facet : facets_)
      for (std::uint32_t& corner : facet.corners)
        if (target[corner] != corner) {
          corner = target[corner];
          facet.fresh = true;
        }
    join_equal_facets();
    return true;
  }

  /// Vertices that lie on an edge or a facet, within the tolerance, become its vertices too.
  bool insert_near_vertices() {
    const std::vector<std::uint32_t> vertices = used_vertices();
    const BoxTree tree = tree_of(vertices);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Path> on_edge;
    for (const Facet& facet : facets_)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = facet.corners[i], b = facet.corners[(i + 1) % 3];
        const auto [at, added] = on_edge.try_emplace({std::min(a, b), std::max(a, b)});
        if (added)
          at->second = vertices_near_edge(at->first.first, at->first.second, vertices, tree);
      }

    bool changed = false;
    std::vector<Facet> result;
    result.reserve(facets_.size());
    for (Facet& facet : facets_) {
      std::vector<Triangle> pieces{facet.corners};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = facet.corners[i], b = facet.corners[(i + 1) % 3];
        Path between = on_edge.at({std::min(a, b), std::max(a, b)});
        if (a > b) std::reverse(between.begin(), between.end());
        split_along_edge(pieces, a, between, b);
      }
      for (const std::uint32_t v : vertices_near_facet(facet.corners, vertices, tree))
        split_inside(pieces, v);
      if (pieces.size() == 1 && pieces[0] == facet.corners) {
        result.push_back(std::move(facet));  // near it, but beside it
        continue;
      }
      changed = true;
      for (const Triangle& piece : pieces) result.push_back({piece, facet.covers});
    }
    facets_ = std::move(result);
    if (changed) join_equal_facets();
    return changed;
  }

  Path vertices_near_edge(std::uint32_t a, std::uint32_t b, const Path& vertices,
                          const BoxTree& tree) const {
    GridBox box = GridBox::of(points_[a]);
    box.add(points_[b]);
    std::vector<std::pair<double, std::uint32_t>> found;
    tree.for_each_meeting(box.grown(reach_), [&](std::uint32_t k) {
      const std::uint32_t v = vertices[k];
      if (v == a || v == b) return;
      double position = 0;
      const double d = distance_to_segment_m(points_[v], points_[a], points_[b], &position);
      if (d <= near_m_ && position > 0 && position < 1) found.emplace_back(position, v);
    });
    std::sort(found.begin(), found.end());
    Path sorted;
    for (const auto& [position, v] : found) sorted.push_back(v);
    return sorted;
  }

  Path vertices_near_facet(const Triangle& facet, const Path& vertices, const BoxTree& tree) const {
    const GridPoint &a = points_[facet[0]], &b = points_[facet[1]], &c = points_[facet[2]];
    Path found;
    tree.for_each_meeting(box_of(points_, facet).grown(reach_), [&](std::uint32_t k) {
      const std::uint32_t v = vertices[k];
      if (distance_to_triangle_m(points_[v], a, b, c) <= near_m_) found.push_back(v);
    });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Puts vertices into the edge a→b of one of the pieces. Each piece is cut towards its apex, so
  /// the edge a→b is gone for good; a piece whose apex comes to lie on the edge vanishes.
  static void split_along_edge(std::vector<Triangle>& pieces, std::uint32_t a, const Path& between,
                               std::uint32_t b) {
    for (const std::uint32_t v : between) {
      for (Triangle& t : pieces) {
        const auto at = std::find(t.begin(), t.end(), a);
        if (at == t.end()) continue;
        const auto i = static_cast<std::size_t>(at - t.begin());
        const std::uint32_t apex = t[(i + 2) % 3];
        if (t[(i + 1) % 3] != b) continue;
        t = {a, v, apex};
        pieces.push_back({v, b, apex});
        break;
      }
      a = v;
    }
    std::erase_if(pieces,
                  [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  }

  /// Cuts the piece that a vertex lies in, seen along the piece's dominant axis, towards it.
  void split_inside(std::vector<Triangle>& pieces, std::uint32_t v) const {
    for (const Triangle& t : pieces)
      if (v == t[0] || v == t[1] || v == t[2]) return;
    std::vector<Triangle> result;
    for (const Triangle& t : pieces) {
      std::array<int, 3> side{};
      if (!is_over(t, v, side)) {
        result.push_back(t);
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i)
        if (side[i] != 0) result.push_back({t[i], t[(i + 1) % 3], v});
    }
    pieces = std::move(result);
  }

  /// Whether a vertex lies within the tolerance of a triangle and in its projection, corners apart;
  /// `side` tells on which edge (0).
  bool is_over(const Triangle& t, std::uint32_t v, std::array<int, 3>& side) const {
    const GridPoint &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    if (is_flat(a, b, c)) return false;
    if (distance_to_triangle_m(points_[v], a, b, c) > near_m_) return false;
    const Axis axis = dominant_axis(a, b, c);
    const std::array<GridPoint2, 3> q{project(a, axis), project(b, axis), project(c, axis)};
    const int turn = orient2d(q[0], q[1], q[2]);
    int zeros = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = orient2d(q[i], q[(i + 1) % 3], project(points_[v], axis)) * turn;
      if (side[i] < 0) return false;
      zeros += side[i] == 0 ? 1 : 0;
    }
    return zeros < 2;
  }

  Corners corners_of(const Facet& facet) const {
    return {points_[facet.corners[0]], points_[facet.corners[1]], points_[facet.corners[2]]};
  }

  bool cut_crossings(bool& cut) {
    std::vector<GridBox> boxes;
    boxes.reserve(facets_.size());
    for (const Facet& facet : facets_) boxes.push_back(box_of(points_, facet.corners));
    const BoxTree tree(boxes);
    std::vector<std::vector<std::uint32_t>> crossing(facets_.size());
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      if (!facets_[f].fresh) continue;
      tree.for_each_meeting(boxes[f], [&](std::uint32_t g) {
        if (g == f || (facets_[g].fresh && g < f) || cuts_ > options_.max_cuts) return;
        if (!triangles_clash(corners_of(facets_[f]), corners_of(facets_[g]))) return;
        ++cuts_;
        crossing[f].push_back(g);
        crossing[g].push_back(f);
      });
    }
    if (cuts_ > options_.max_cuts) return false;
    std::vector<Facet> result;
    result.reserve(facets_.size());
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      if (options_.stop.stop_requested()) return false;
      facets_[f].fresh = false;
      if (crossing[f].empty()) {
        result.push_back(facets_[f]);
        continue;
      }
      cut = true;
      std::sort(crossing[f].begin(), crossing[f].end());
      std::vector<Corners> others;
      for (const std::uint32_t g : crossing[f]) others.push_back(corners_of(facets_[g]));
      for (const Corners& piece : cut_triangle(corners_of(facets_[f]), others))
        result.push_back(
            {{add_point(piece[0]), add_point(piece[1]), add_point(piece[2])}, facets_[f].covers});
      if (result.size() > max_facets_) return false;
    }
    facets_ = std::move(result);
    if (cut) join_equal_facets();
    return true;
  }

  const ArrangeOptions& options_;
  std::uint64_t max_facets_ = 0;
  double near_m_;  ///< of vertices to edges and facets
  std::int64_t reach_;
  std::vector<GridPoint> points_;
  std::unordered_map<GridPoint, std::uint32_t, GridPointHash> index_of_;
  std::vector<Facet> facets_;
  std::uint64_t cuts_ = 0;
};

}  // namespace

std::optional<Arrangement> arrange(std::span<const GridPoint> points,
                                   std::span<const Triangle> triangles,
                                   const ArrangeOptions& options) {
  Refinement refinement(points, triangles, options);
  if (!refinement.run()) return {};
  return std::move(refinement).result();
}

}  // namespace citymesh
