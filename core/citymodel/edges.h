#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/citymodel/shell.h"

namespace citymesh {

/// How a face walks an edge.
struct EdgeUse {
  std::uint32_t face = 0;
  bool forward = true;  ///< from the lower to the higher vertex
};

using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;  ///< vertices, lower first

/// The edges of a shell, sorted by vertices, each with the faces that walk it in their order.
class EdgeUses {
 public:
  using Entry = std::pair<EdgeKey, std::span<const EdgeUse>>;

  explicit EdgeUses(const Shell& shell);
  EdgeUses(EdgeUses&&) = default;
  EdgeUses& operator=(EdgeUses&&) = default;
  EdgeUses(const EdgeUses&) = delete;  // entries look into uses_
  EdgeUses& operator=(const EdgeUses&) = delete;

  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  /// Of the edge between two vertices; empty where there is none.
  std::span<const EdgeUse> of(std::uint32_t a, std::uint32_t b) const;

 private:
  std::vector<EdgeUse> uses_;
  std::vector<Entry> entries_;
};

/// Every edge is walked once in each direction.
bool is_closed(const Shell& shell);

}  // namespace citymesh
