#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/union_find.h"
#include "core/gates/gates.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/place.h"
#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

// Notation. v: vertex, e: edge, f: face (triangle). A half-edge is an edge as one face walks it.

struct HalfEdge {
  std::uint32_t low, high;  ///< vertices, low < high
  std::uint32_t face;
  bool forward;  ///< the face walks low → high
};

/// Intersecting pairs that are counted: in a tangle nearly all pairs are, and the verdict is clear.
constexpr std::uint64_t kMaxClashes = 10'000;

/// Work limit: pairs whose boxes meet. No building comes near; what does is refused.
constexpr std::uint64_t kMaxPairs = 1'000'000, kMaxPairsPerFace = 40;

/// Counts what violates a gate and keeps the first place.
class Finding {
 public:
  explicit Finding(std::string_view gate) : gate_(gate) {}
  template <class Where>
  void add(Where&& where) {
    if (count_++ == 0) where_ = where();
  }
  void append_to(std::vector<GateFailure>& failures) const {
    if (count_ > 0) failures.push_back({gate_, count_, where_});
  }
  bool any() const { return count_ > 0; }
  std::uint64_t count() const { return count_; }

 private:
  std::string_view gate_;
  std::uint64_t count_ = 0;
  std::string where_;
};

class ShellCheck {
 public:
  ShellCheck(std::span<const GridPoint> points, std::span<const Triangle> faces,
             const GateOptions& options)
      : points_(points), faces_(faces), options_(options), component_(faces.size()) {}

  std::vector<GateFailure> run() {
    std::vector<GateFailure> failures;
    if (faces_.empty()) {
      failures.push_back({"G1", 1, "no triangles"});
      return failures;
    }
    Finding range("G13");
    for (const GridPoint& p : points_)
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kGridLimit)
        range.add([&] { return place_text(p); });
    range.append_to(failures);
    if (range.any()) return failures;  // beyond it the predicates are not exact

    Finding degenerate("G5");
    for (const Triangle& f : faces_)
      if (is_degenerate(f)) degenerate.add([&] { return place_text(points_[f[0]]); });
    check_edges(failures);
    check_fans_and_euler(failures);
    degenerate.append_to(failures);
    check_orientation(failures);
    check_duplicates(failures);
    // Pairs of faces mean something only among faces that have a plane.
    if (!has_zero_area_) check_pairs(failures);
    return failures;
  }

 private:
  bool is_degenerate(const Triangle& f) {
    const GridPoint &a = points_[f[0]], &b = points_[f[1]], &c = points_[f[2]];
    const Point3 n = normal_of(a, b, c);
    const double twice_area_m2 =
        std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / (kGridStepsPerMetre * kGridStepsPerMetre);
    if (twice_area_m2 <= 0) has_zero_area_ = true;
    const double longest_m = std::max({distance_m(a, b), distance_m(b, c), distance_m(c, a)});
    return twice_area_m2 < 2 * options_.min_triangle_area_m2 || longest_m <= 0 ||
           twice_area_m2 / longest_m < options_.min_triangle_height_m;
  }

  void check_edges(std::vector<GateFailure>& failures) {
    half_edges_.reserve(faces_.size() * 3);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = faces_[f][i], b = faces_[f][(i + 1) % 3];
        half_edges_.push_back({std::min(a, b), std::max(a, b), f, a < b});
      }
    std::sort(half_edges_.begin(), half_edges_.end(), [](const HalfEdge& s, const HalfEdge& t) {
      return std::tie(s.low, s.high, s.face, s.forward) <
             std::tie(t.low, t.high, t.face, t.forward);
    });
    Finding open("G1"), many("G2"), clash("G7");
    UnionFind faces(faces_.size());
    for_each_edge([&](std::span<const HalfEdge> edge) {
      const auto where = [&] {
        return place_text(points_[edge[0].low]) + "–" + place_text(points_[edge[0].high]);
      };
      if (edge[0].low == edge[0].high) return;
      if (edge.size() == 1) open.add(where);
      if (edge.size() > 2) many.add(where);
      if (edge.size() == 2 && edge[0].forward == edge[1].forward) clash.add(where);
      for (std::size_t i = 1; i < edge.size(); ++i) faces.join(edge[0].face, edge[i].face);
    });
    for (std::uint32_t f = 0; f < faces_.size(); ++f) component_[f] = faces.root(f);
    closed_ = !open.any() && !many.any();
    open.append_to(failures);
    many.append_to(failures);
    clash.append_to(failures);
    oriented_ = !clash.any();
  }

  /// Corners of faces are joined across the edges at the vertex; more than one class left is more
  /// than one fan.
  void check_fans_and_euler(std::vector<GateFailure>& failures) {
    if (!closed_) return;  // fans and Euler's formula presuppose closed edges
    UnionFind corners(faces_.size() * 3);
    const auto corner = [&](std::uint32_t f, std::uint32_t v) {
      const Triangle& t = faces_[f];
      return f * 3 + (t[0] == v ? 0u : t[1] == v ? 1u : 2u);
    };
    for_each_edge([&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) return;
      corners.join(corner(edge[0].face, edge[0].low), corner(edge[1].face, edge[0].low));
      corners.join(corner(edge[0].face, edge[0].high), corner(edge[1].face, edge[0].high));
    });
    std::vector<std::uint32_t> fan(points_.size(), ~0u);
    std::map<std::uint32_t, std::int64_t> euler;  // by component: V - E + F
    Finding pinched("G2"), odd("G3");
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      ++euler[component_[f]];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t v = faces_[f][i], root = corners.root(f * 3 + i);
        if (fan[v] == ~0u) {
          fan[v] = root;
          ++euler[component_[f]];
        } else if (fan[v] != root) {
          pinched.add([&] { return "vertex " + place_text(points_[v]); });
        }
      }
    }
    for_each_edge([&](std::span<const HalfEdge> edge) { --euler[component_[edge[0].face]]; });
    for (const auto& [component, characteristic] : euler)
      if (characteristic > 2 || characteristic % 2 != 0)
        odd.add([&, component = component, characteristic = characteristic] {
          return fmt::format("V - E + F = {} at {}", characteristic,
                             place_text(points_[faces_[component][0]]));
        });
    pinched.append_to(failures);
    if (!pinched.any()) odd.append_to(failures);
  }

  /// Components are nested like the shells of a solid: outside faces outwards, a cavity inwards,
  /// and so on.
  void check_orientation(std::vector<GateFailure>& failures) {
    if (!closed_ || !oriented_) return;
    struct Component {
      std::vector<Triangle> faces{};
      GridBox box{};
    };
    std::map<std::uint32_t, Component> components;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      Component& component = components[component_[f]];
      const GridBox box = box_of(points_, faces_[f]);
      if (component.faces.empty()) component.box = box;
      component.box.add(box);
      component.faces.push_back(faces_[f]);
    }
    std::vector<const Component*> all;
    std::vector<GridBox> boxes;
    for (const auto& [id, component] : components) {
      all.push_back(&component);
      boxes.push_back(component.box);
    }
    const BoxTree tree(boxes);
    Finding inward("G7"), interior("G8");
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const GridPoint& corner = points_[all[i]->faces[0][0]];
      int depth = 0;
      tree.for_each_meeting(GridBox::of(corner), [&](std::uint32_t other) {
        if (other != i && encloses(all[other]->faces, corner)) ++depth;
      });
      const Int128 volume = volume6(points_, all[i]->faces);
      const auto where = [&] { return place_text(corner); };
      if (depth % 2 == 0 && volume <= 0) inward.add(where);
      if (depth % 2 == 1 && volume >= 0) interior.add(where);
    }
    inward.append_to(failures);
    interior.append_to(failures);
  }

  /// Parity of a ray in direction (1, ε, ε²): the perturbation is symbolic, so no case is special.
  bool encloses(const std::vector<Triangle>& shell, const GridPoint& p) const {
    bool inside = false;
    for (const Triangle& t : shell) {
      const GridPoint2 o = project(p, Axis::X);
      GridPoint2 c[3];
      for (std::size_t i = 0; i < 3; ++i) c[i] = project(points_[t[i]], Axis::X);
      bool hit = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const GridPoint2 &a = c[i], &b = c[(i + 1) % 3];
        if ((a.y > o.y) == (b.y > o.y)) continue;
        const int side = orient2d(a, b, o);
        if (side != 0 && (side > 0) == (b.y > a.y)) hit = !hit;
      }
      if (!hit) continue;
      const int facing = orient2d(c[0], c[1], c[2]);
      const int side = orient3d(points_[t[0]], points_[t[1]], points_[t[2]], p);
      // Seen along +x the plane is ahead when p lies behind a face that looks towards +x, or in
      // front of one towards -x.
      if (facing != 0 && side * facing < 0) inside = !inside;
    }
    return inside;
  }

  void check_duplicates(std::vector<GateFailure>& failures) {
    std::vector<std::pair<Triangle, std::uint32_t>> keys;
    keys.reserve(faces_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      Triangle key = faces_[f];
      std::sort(key.begin(), key.end());
      keys.emplace_back(key, f);
    }
    std::sort(keys.begin(), keys.end());
    Finding duplicate("G8");
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (i > 0 && keys[i].first == keys[i - 1].first)
        duplicate.add([&] { return place_text(points_[keys[i].first[0]]); });
      else
        distinct_.push_back(keys[i].second);
    std::sort(distinct_.begin(), distinct_.end());
    duplicate.append_to(failures);
  }

  void check_pairs(std::vector<GateFailure>& failures) {
    std::vector<GridBox> boxes;
    boxes.reserve(distinct_.size());
    for (const std::uint32_t f : distinct_) boxes.push_back(box_of(points_, faces_[f]));
    const BoxTree tree(boxes);

    Finding clash("G4");
    const std::uint64_t max_pairs = kMaxPairs + kMaxPairsPerFace * boxes.size();
    std::uint64_t pairs = 0;
    const auto corners = [&](std::uint32_t i) {
      const Triangle& f = faces_[distinct_[i]];
      return std::array<GridPoint, 3>{points_[f[0]], points_[f[1]], points_[f[2]]};
    };
    for (std::uint32_t i = 0; i < boxes.size() && clash.count() < kMaxClashes; ++i) {
      const auto own = corners(i);
      tree.for_each_meeting(boxes[i], [&](std::uint32_t other) {
        if (other <= i || ++pairs > max_pairs || !triangles_clash(own, corners(other))) return;
        clash.add([&] { return place_text(own[0]) + " and " + place_text(corners(other)[0]); });
      });
      if (pairs <= max_pairs) continue;
      clash.add([&] { return fmt::format("not known: over {} pairs are close", max_pairs); });
      break;
    }
    clash.append_to(failures);

    Finding junction("G6");
    const auto reach =
        static_cast<std::int64_t>(std::ceil(options_.t_junction_distance_m * kGridStepsPerMetre));
    std::vector<char> used(points_.size(), 0);
    for (const Triangle& f : faces_)
      for (const std::uint32_t v : f) used[v] = 1;
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
      if (!used[v]) continue;
      bool found = false;
      tree.for_each_meeting(GridBox::of(points_[v]).grown(reach), [&](std::uint32_t k) {
        const Triangle& f = faces_[distinct_[k]];
        for (std::size_t i = 0; i < 3 && !found; ++i) {
          const std::uint32_t a = f[i], b = f[(i + 1) % 3];
          if (a == v || b == v) continue;
          double position = 0;
          if (distance_to_segment_m(points_[v], points_[a], points_[b], &position) >=
              options_.t_junction_distance_m)
            continue;
          // Next to an end of the edge it is a short edge, which G5 and G9 judge.
          found = position > 0 && position < 1;
        }
      });
      if (found) junction.add([&] { return place_text(points_[v]); });
    }
    junction.append_to(failures);
  }

  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t first = 0; first < half_edges_.size();) {
      std::size_t last = first + 1;
      while (last < half_edges_.size() && half_edges_[last].low == half_edges_[first].low &&
             half_edges_[last].high == half_edges_[first].high)
        ++last;
      visit(std::span(half_edges_).subspan(first, last - first));
      first = last;
    }
  }

  std::span<const GridPoint> points_;
  std::span<const Triangle> faces_;
  const GateOptions& options_;
  std::vector<HalfEdge> half_edges_;
  std::vector<std::uint32_t>
      component_;  ///< by face: the lowest face of its edge-connected component
  std::vector<std::uint32_t> distinct_;  ///< of faces on the same corners the first
  bool closed_ = false;
  bool oriented_ = false;
  bool has_zero_area_ = false;
};

}  // namespace

std::vector<GateFailure> check_shell(std::span<const GridPoint> points,
                                     std::span<const Triangle> triangles,
                                     const GateOptions& options) {
  return ShellCheck(points, triangles, options).run();
}

}  // namespace citymesh
