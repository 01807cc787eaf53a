#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/write/sections.h"

namespace citymesh {

struct GlbMaterial {
  std::string_view name{};
  std::array<std::uint8_t, 3> colour{};  ///< sRGB
  bool double_sided = false;
};

/// A node with a mesh of its own.
struct GlbNode {
  std::string_view name{};
  std::string_view extras{};  ///< a JSON object
  std::span<const GridPoint> points{};
  std::span<const std::vector<Triangle>> triangles{};  ///< of each material
};

/// The parts of a file of glTF 2.0: a node per body, a primitive per material. There are no
/// normals: glTF then asks viewers for flat shading, which is what buildings need, and points stay
/// shared. All points stand in one buffer view, all corner numbers in another.
class GlbParts {
 public:
  static constexpr std::size_t kSections = 5;

  GlbParts(const Scene& scene, std::vector<GlbMaterial> materials)
      : scene_(scene), materials_(std::move(materials)) {}

  /// Errors: FailedPrecondition when float32 cannot tell the grid points of a node apart, or the
  /// file would be larger than GLB can be.
  Result<void> append(const GlbNode& node, std::array<std::string, kSections>& to);

  Result<void> join(const std::array<std::uint64_t, kSections>& sizes, SectionSink& sink) const;

  /// So far, about.
  std::uint64_t bytes() const { return json_bytes_ + position_bytes_ + index_bytes_; }

 private:
  struct LocalPoints;

  void append_node(std::string& json, const GlbNode& node, const LocalPoints& local) const;
  void append_accessor(std::string& json, int view, std::uint64_t offset, int component,
                       std::uint64_t count, std::string_view type);
  void append_positions(std::string& accessors, std::string& bytes, const LocalPoints& local);
  void append_mesh(std::string& meshes, std::string& accessors, std::string& bytes,
                   const GlbNode& node);
  std::string head() const;
  std::string json_tail(std::uint64_t position_bytes, std::uint64_t index_bytes) const;

  Scene scene_;
  std::vector<GlbMaterial> materials_;
  std::uint64_t nodes_ = 0, accessors_ = 0;
  std::uint64_t json_bytes_ = 0, position_bytes_ = 0, index_bytes_ = 0;
};

}  // namespace citymesh
