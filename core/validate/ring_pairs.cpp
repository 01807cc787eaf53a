#include "core/validate/ring_pairs.h"

#include <algorithm>
#include <map>

#include "core/base/union_find.h"
#include "core/geometry/locate.h"
#include "core/validate/rings.h"

namespace citymesh {
namespace {

/// How one simple ring lies to another.
struct Relation {
  bool crosses = false;                  ///< or they run along each other
  bool inside = false, outside = false;  ///< parts of the ring in or out of the other
  GridPoint2 place{};
  std::vector<GridPoint2> touches{};
};

bool on_edge(const GridPoint2& a, const GridPoint2& b, const GridPoint2& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y) && orient2d(a, b, p) == 0;
}

bool cross_properly(const GridPoint2& a, const GridPoint2& b, const GridPoint2& c,
                    const GridPoint2& d) {
  return orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0;
}

GridBox box_of(const FlatRing& ring) {
  GridBox box = GridBox::of({ring[0].x, ring[0].y, 0});
  for (const GridPoint2& p : ring) box.add(GridPoint{p.x, p.y, 0});
  return box;
}

/// A ring with what speeds up questions to it.
class Indexed {
 public:
  explicit Indexed(const FlatRing& ring) : ring_(ring), box_(box_of(ring)), tree_(edges(ring)) {}

  const FlatRing& ring() const { return ring_; }
  const GridBox& box() const { return box_; }

  Relation relation_to(const Indexed& other) const {
    Relation relation;
    std::vector<std::vector<GridPoint2>> stops(ring_.size());  // on each edge, besides its ends
    bool touched = false;
    for (std::size_t i = 0; i < ring_.size() && !relation.crosses; ++i) {
      const GridPoint2 &a = ring_[i], &b = ring_[(i + 1) % ring_.size()];
      const GridBox box = citymesh::box_of(a, b);
      if (!box.meets(other.box_)) continue;
      other.tree_.for_each_meeting(box, [&](std::uint32_t j) {
        const GridPoint2 &c = other.ring_[j], &d = other.ring_[(j + 1) % other.ring_.size()];
        if (cross_properly(a, b, c, d)) {
          relation.crosses = true;
          relation.place = a;
        }
        if (on_edge(a, b, c)) stops[i].push_back(c);
        if (on_edge(c, d, a)) relation.touches.push_back(a);
        touched = touched || on_edge(c, d, b);
      });
      relation.touches.insert(relation.touches.end(), stops[i].begin(), stops[i].end());
    }
    if (relation.crosses) return relation;
    if (!touched && relation.touches.empty()) {
      (locate(other.ring_, ring_[0]) == Side::Inside ? relation.inside : relation.outside) = true;
      relation.place = ring_[0];
      return relation;
    }
    std::sort(relation.touches.begin(), relation.touches.end());
    relation.touches.erase(std::unique(relation.touches.begin(), relation.touches.end()),
                           relation.touches.end());
    // Between two touches the ring stays on one side of the other: the middles tell which.
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const GridPoint2 &a = ring_[i], &b = ring_[(i + 1) % ring_.size()];
      std::vector<GridPoint2>& on = stops[i];
      on.push_back(a);
      on.push_back(b);
      std::sort(on.begin(), on.end());
      for (std::size_t k = 1; k < on.size(); ++k) {
        if (on[k] == on[k - 1]) continue;
        const GridPoint2 middle2{on[k - 1].x + on[k].x, on[k - 1].y + on[k].y};
        const Side side = locate(other.ring_, middle2, 2);
        if (side == Side::Inside) relation.inside = true;
        if (side == Side::Outside) relation.outside = true;
        if (side == Side::On || (relation.inside && relation.outside)) {
          relation.crosses = true;
          relation.place = on[k - 1];
          return relation;
        }
      }
    }
    relation.place = relation.touches.empty() ? ring_[0] : relation.touches[0];
    return relation;
  }

 private:
  static std::vector<GridBox> edges(const FlatRing& ring) {
    std::vector<GridBox> boxes;
    for (std::size_t i = 0; i < ring.size(); ++i)
      boxes.push_back(citymesh::box_of(ring[i], ring[(i + 1) % ring.size()]));
    return boxes;
  }

  const FlatRing& ring_;
  GridBox box_;
  BoxTree tree_;
};

bool same_corners(FlatRing a, FlatRing b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

/// Rings and the points where they touch, as a graph: a cycle in it encloses a piece of the
/// interior.
class TouchGraph {
 public:
  explicit TouchGraph(std::size_t rings) : rings_(rings) {}

  void add(std::size_t ring, std::size_t other, const std::vector<GridPoint2>& touches) {
    for (const GridPoint2& p : touches) {
      rings_at_[p].push_back(ring);
      rings_at_[p].push_back(other);
    }
  }

  std::optional<RingPair> cycle() {
    UnionFind nodes(rings_ + rings_at_.size());
    auto node = static_cast<std::uint32_t>(rings_);
    for (auto& [place, rings] : rings_at_) {
      std::sort(rings.begin(), rings.end());
      rings.erase(std::unique(rings.begin(), rings.end()), rings.end());
      for (const std::size_t ring : rings)
        if (!nodes.join(static_cast<std::uint32_t>(ring), node))
          return RingPair{RingDefect::Disconnected, ring, rings[0], place};
      ++node;
    }
    return {};
  }

 private:
  std::size_t rings_;
  std::map<GridPoint2, std::vector<std::size_t>> rings_at_;
};

}  // namespace

std::optional<RingPair> find_ring_defect(std::span<const FlatRing> rings) {
  if (rings.size() < 2) return {};
  std::vector<Indexed> indexed;
  std::vector<GridBox> boxes;
  indexed.reserve(rings.size());
  for (const FlatRing& ring : rings) {
    indexed.emplace_back(ring);
    boxes.push_back(indexed.back().box());
  }
  const auto defect_of = [&](std::size_t ring, std::size_t other, const Relation& relation) {
    const bool same = same_corners(rings[ring], rings[other]);
    return RingPair{same ? RingDefect::Same : RingDefect::Intersect, ring, other, relation.place};
  };

  TouchGraph contacts(rings.size());
  std::optional<RingPair> outside, nested;
  for (std::size_t r = 1; r < rings.size(); ++r) {
    const Relation relation = indexed[r].relation_to(indexed[0]);
    if (relation.crosses) return defect_of(r, 0, relation);
    if (relation.outside && !outside) outside = {RingDefect::Outside, r, 0, relation.place};
    contacts.add(r, 0, relation.touches);
  }
  const std::span<const GridBox> holes = std::span<const GridBox>(boxes).subspan(1);
  const BoxTree tree(holes);
  for (std::size_t r = 1; r < rings.size(); ++r) {
    std::vector<std::size_t> near;
    tree.for_each_meeting(boxes[r], [&](std::uint32_t i) {
      if (i + 1 > r) near.push_back(i + 1);
    });
    std::sort(near.begin(), near.end());
    for (const std::size_t other : near) {
      const Relation there = indexed[r].relation_to(indexed[other]);
      if (there.crosses) return defect_of(r, other, there);
      const Relation back = indexed[other].relation_to(indexed[r]);
      if (back.crosses) return defect_of(r, other, back);
      if ((there.inside || back.inside) && !nested)
        nested = {RingDefect::Nested, there.inside ? r : other, there.inside ? other : r,
                  there.place};
      contacts.add(r, other, there.touches);
    }
  }
  if (outside) return outside;
  if (nested) return nested;
  return contacts.cycle();
}

}  // namespace citymesh
