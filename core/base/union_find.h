#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace citymesh {

/// Disjoint sets of 0 … size-1; the root of a set is its lowest member.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::size_t size() const { return parent_.size(); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// false: they were in one set already.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a == b) return false;
    parent_[a > b ? a : b] = a < b ? a : b;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace citymesh
