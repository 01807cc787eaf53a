#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

/// Closed axis-parallel box on the grid.
struct GridBox {
  GridPoint min{}, max{};

  static GridBox of(const GridPoint& p) { return {p, p}; }
  void add(const GridPoint& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  void add(const GridBox& b) {
    add(b.min);
    add(b.max);
  }
  GridBox grown(std::int64_t by) const {
    return {{min.x - by, min.y - by, min.z - by}, {max.x + by, max.y + by, max.z + by}};
  }
  /// Of the nearest place of the box, in steps²; 0 inside.
  double squared_distance(const GridPoint& p) const {
    const auto off = [](std::int64_t low, std::int64_t at, std::int64_t high) {
      return static_cast<double>(std::max({low - at, at - high, std::int64_t{0}}));
    };
    const double x = off(min.x, p.x, max.x), y = off(min.y, p.y, max.y), z = off(min.z, p.z, max.z);
    return x * x + y * y + z * z;
  }
  bool meets(const GridBox& b) const {
    return min.x <= b.max.x && b.min.x <= max.x && min.y <= b.max.y && b.min.y <= max.y &&
           min.z <= b.max.z && b.min.z <= max.z;
  }
};

/// Places within `reach` of a segment, in steps; what it meets may be a little farther.
class GridTube {
 public:
  GridTube(const GridPoint& a, const GridPoint& b, std::int64_t reach)
      : start_{static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)},
        way_{static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y),
             static_cast<double>(b.z - a.z)},
        reach_(static_cast<double>(reach) + 1) {}

  bool meets(const GridBox& box) const {
    double first = 0, last = 1;
    const auto clip = [&](double start, double way, std::int64_t low, std::int64_t high) {
      const double from = static_cast<double>(low) - reach_ - start,
                   to = static_cast<double>(high) + reach_ - start;
      if (way == 0) return from <= 0 && to >= 0;
      first = std::max(first, std::min(from / way, to / way));
      last = std::min(last, std::max(from / way, to / way));
      return first <= last;
    };
    return clip(start_.x, way_.x, box.min.x, box.max.x) &&
           clip(start_.y, way_.y, box.min.y, box.max.y) &&
           clip(start_.z, way_.z, box.min.z, box.max.z);
  }

 private:
  Point3 start_, way_;
  double reach_;
};

/// A static tree of boxes: build once in O(n log n), then ask which boxes meet a given one.
class BoxTree {
 public:
  explicit BoxTree(std::span<const GridBox> boxes);

  /// Calls visit(index of a box) for every box that meets `query`, a box or a tube, in an order
  /// that depends only on the boxes.
  template <class Query, class Visit>
  void for_each_meeting(const Query& query, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!query.meets(node.box)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (query.meets(boxes_[order_[i]])) visit(order_[i]);
      } else {
        stack[depth++] = node.first;  // children lie next to each other
        stack[depth++] = node.first + 1;
      }
    }
  }

  /// Branch and bound: calls visit(index of a box), which returns the bound from then on, for boxes
  /// whose squared distance to `p` (in steps) is below the bound; near boxes first.
  template <class Visit>
  void for_each_nearer(const GridPoint& p, Visit&& visit) const {
    if (nodes_.empty()) return;
    double bound = std::numeric_limits<double>::infinity();
    struct Open {
      std::uint32_t node;
      double squared;
    };
    Open stack[64];
    int depth = 0;
    stack[depth++] = {0, nodes_[0].box.squared_distance(p)};
    while (depth > 0) {
      const Open open = stack[--depth];
      if (!(open.squared < bound)) continue;
      const Node& node = nodes_[open.node];
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (boxes_[order_[i]].squared_distance(p) < bound) bound = visit(order_[i]);
        continue;
      }
      Open near{node.first, nodes_[node.first].box.squared_distance(p)},
          far{node.first + 1, nodes_[node.first + 1].box.squared_distance(p)};
      if (far.squared < near.squared) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
    }
  }

 private:
  struct Node {
    GridBox box{};
    std::uint32_t first = 0;  ///< leaf: into order_; inner: index of the first child
    std::uint32_t count = 0;  ///< 0 for inner nodes
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<GridBox> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace citymesh
