#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/write/rung.h"

namespace citymesh {

/// A patch of triangles in one plane, with its outline. Corners are grid points, which fit 32 bits.
struct DrawnFace {
  using Corner = std::array<std::int32_t, 3>;
  enum class Kind : std::uint8_t { Wall, Roof, Opening };

  std::vector<std::vector<Corner>> rings{};
  std::vector<std::array<Corner, 3>> triangles{};
  Point3 normal{};
  Kind kind = Kind::Wall;
  std::uint8_t rung = 0;  ///< index of kRungStyles, or one past the last
  std::int32_t base = 0;  ///< z of the ground that its shadow falls on
};

/// A body of which only height and outline are drawn.
struct DrawnBlock {
  std::vector<std::array<std::int32_t, 2>> outline{};  ///< convex, counter-clockwise
  std::int32_t base = 0, top = 0;
  std::uint8_t rung = 0;
  double size = 0;          ///< volume of the block; the largest are kept
  std::uint64_t order = 0;  ///< of adding
};

/// What is seen of the bodies, bounded: beyond `kMaxTriangles` bodies become blocks, beyond
/// `kMaxBlockCorners` only the largest blocks are kept.
class Picture {
 public:
  static constexpr std::size_t kMaxTriangles = 60'000;
  static constexpr std::size_t kMaxBlockCorners = 60'000;

  void add(const BuildingBodies& building);

  /// A self-contained SVG document; the same bytes for the same scene.
  std::string svg(const RunReport& report) const;

 private:
  void add_faces(const Body& body, std::uint8_t rung, std::int32_t base);
  void add_block(const Body& body, std::uint8_t rung, std::int32_t base);

  std::vector<DrawnFace> faces_{};
  std::vector<DrawnBlock> blocks_{};  // a heap, the smallest first
  std::size_t triangles_ = 0;
  std::size_t block_corners_ = 0;
  std::uint64_t bodies_ = 0;
  bool as_blocks_ = false;
};

/// The patches of a mesh that the viewer or the sun sees.
std::vector<DrawnFace> drawn_faces(const TriangleMesh& mesh);

/// The same for a block.
std::vector<DrawnFace> drawn_faces(const DrawnBlock& block);

/// Direction to the sun, unit, east-north-up.
inline constexpr Point3 kSun{0.663414, -0.383022, 0.642788};  // 120° azimuth, 40° high

}  // namespace citymesh
