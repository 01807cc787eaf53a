#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/write/write.h"

namespace citymesh {

// The writers behind the table of formats, one source file each.
using WriterResult = Result<std::unique_ptr<BodyWriter>>;
WriterResult open_obj(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene);
WriterResult open_stl(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene);
WriterResult open_stl_binary(const std::filesystem::path& folder, const Format& format,
                             const Scene& scene);
WriterResult open_ply(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene);
WriterResult open_vtu(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene);
WriterResult open_glb(const std::filesystem::path& folder, const Format& format,
                      const Scene& scene);
WriterResult open_cityjson(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene);
WriterResult open_cityjsonseq(const std::filesystem::path& folder, const Format& format,
                              const Scene& scene);
WriterResult open_citygml2(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene);
WriterResult open_citygml3(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene);

inline constexpr std::string_view kAxes = "x east, y north, z up, right-handed";

std::string generator();                      ///< "citymesh 0.1.0"
std::string crs_text(const Scene& scene);     ///< "EPSG:25833", "unknown" when none is stated
std::string origin_text(const Scene& scene);  ///< "391000 5820000 0"

/// "citymesh 0.1.0 export-for-simulation; crs EPSG:25833; unit metre; axes …; origin …": for
/// formats with room for one text.
std::string scene_text(const Scene& scene);

inline constexpr std::size_t kSurfaceTypeCount = 12;

/// Triangle numbers of a mesh grouped by surface type: types in enum order, mesh order within.
struct TrianglesByType {
  std::vector<std::uint32_t> order{};
  std::array<std::size_t, kSurfaceTypeCount + 1> begin{};  ///< of each type in `order`
};
TrianglesByType by_type(const TriangleMesh& mesh);

/// Unit normal of a triangle; zero when it is degenerate.
Point3 unit_normal(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// "<name>__<SurfaceType>"
std::string patch_name(const Body& body, SurfaceType type);

}  // namespace citymesh
