#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
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
  bool meets(const GridBox& b) const {
    return min.x <= b.max.x && b.min.x <= max.x && min.y <= b.max.y && b.min.y <= max.y &&
           min.z <= b.max.z && b.min.z <= max.z;
  }
};

/// A static tree of boxes: build once in O(n log n), then ask which boxes meet a given one.
class BoxTree {
 public:
  explicit BoxTree(std::span<const GridBox> boxes);

  /// Calls visit(index of a box) for every box that meets `query`, in an order that depends only on
  /// the boxes.
  template <class Visit>
  void for_each_meeting(const GridBox& query, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!node.box.meets(query)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (boxes_[order_[i]].meets(query)) visit(order_[i]);
      } else {
        stack[depth++] = node.first;  // children lie next to each other
        stack[depth++] = node.first + 1;
      }
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
