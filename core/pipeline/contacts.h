#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/geometry/box_tree.h"

namespace citymesh {

/// Counts the pairs of bodies that touch or overlap, exactly. Keeps the triangles of all bodies;
/// beyond `kMaxTriangles` it gives up and lets them go, so that memory stays bounded.
class Contacts {
 public:
  static constexpr std::uint64_t kMaxTriangles = 2'000'000;

  void add(const TriangleMesh& mesh);

  /// None: too many triangles to keep.
  std::optional<std::uint64_t> count() const;

 private:
  struct Kept {
    std::vector<std::array<std::int32_t, 3>> points{};
    std::vector<Triangle> triangles{};
    GridBox box{};
  };
  static bool meet(const Kept& a, const Kept& b);

  std::vector<Kept> bodies_;
  std::uint64_t triangles_ = 0;
};

}  // namespace citymesh
