#include "core/geometry/box_tree.h"

namespace citymesh {
namespace {
constexpr std::uint32_t kLeafSize = 4;

std::int64_t centre2(const GridBox& box, int axis) {
  switch (axis) {
    case 0:
      return box.min.x + box.max.x;
    case 1:
      return box.min.y + box.max.y;
    default:
      return box.min.z + box.max.z;
  }
}
}  // namespace

BoxTree::BoxTree(std::span<const GridBox> boxes)
    : boxes_(boxes.begin(), boxes.end()), order_(boxes.size()) {
  if (boxes_.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(boxes_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(boxes_.size()));
}

void BoxTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  GridBox box = boxes_[order_[first]];
  for (std::uint32_t i = first; i < first + count; ++i) box.add(boxes_[order_[i]]);
  nodes_[node].box = box;
  if (count <= kLeafSize) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  const std::int64_t extent[3] = {box.max.x - box.min.x, box.max.y - box.min.y,
                                  box.max.z - box.min.z};
  const int axis = static_cast<int>(std::max_element(extent, extent + 3) - extent);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const std::int64_t ca = centre2(boxes_[a], axis), cb = centre2(boxes_[b], axis);
    return ca != cb ? ca < cb : a < b;
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[node].first = child;
  nodes_[node].count = 0;
  split(child, first, half);
  split(child + 1, first + half, count - half);
}

}  // namespace citymesh
