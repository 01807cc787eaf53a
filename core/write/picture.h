#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/write/drawing.h"
#include "core/write/write.h"

namespace citymesh {

/// A body of which only height and outline are drawn.
struct DrawnBlock {
  std::vector<std::array<std::int32_t, 2>> outline{};  ///< convex, counter-clockwise
  std::int32_t base = 0, top = 0;
  std::uint8_t style = 0;
  double size = 0;          ///< volume of the block; the largest are kept
  std::uint64_t order = 0;  ///< of adding
};

/// What is seen of the bodies, bounded: beyond `kMaxTriangles` bodies become blocks, beyond
/// `kMaxBlockCorners` only the largest blocks are kept.
class Picture {
 public:
  static constexpr std::size_t kMaxTriangles = 60'000;
  static constexpr std::size_t kMaxBlockCorners = 60'000;
  static constexpr std::size_t kMaxMarks = 5'000;

  void add(const BuildingBodies& building);

  /// A building as its source has it: in the colour of its gravest issue, with a mark at the place
  /// of each.
  void add(const BuildingReport& report, std::span<const SourceBody> sources);

  /// A self-contained SVG document; the same bytes for the same scene.
  std::string svg(const RunReport& report) const;

 private:
  void add_faces(std::vector<DrawnFace> faces, std::int32_t base);
  void add_block(std::span<const GridPoint> points, std::span<const Triangle> triangles,
                 std::uint8_t style, std::int32_t base);

  std::vector<DrawnFace> faces_{};
  std::vector<DrawnBlock> blocks_{};  // a heap, the smallest first
  std::size_t triangles_ = 0;
  std::size_t block_corners_ = 0;
  std::vector<Point3> marks_{};
  std::array<std::uint64_t, kStyles.size()> sources_{};  // buildings by their gravest issue
  std::uint64_t bodies_ = 0;
  bool as_blocks_ = false;
};

/// The patches of a mesh that the viewer or the sun sees.
std::vector<DrawnFace> drawn_faces(const TriangleMesh& mesh);

/// The same for a block.
std::vector<DrawnFace> drawn_faces(const DrawnBlock& block);

}  // namespace citymesh
