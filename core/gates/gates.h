#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/point.h"

namespace citymesh {

/// A gate that does not hold. `gate` is the id of the acceptance gates (G1 …).
struct GateFailure {
  std::string_view gate;
  std::uint64_t count = 0;
  std::string where{};  ///< the first place, in metres from the origin
};

struct GateOptions {
  double min_triangle_height_m = 0.001;
  double min_triangle_area_m2 = 1e-6;
  double t_junction_distance_m = 0.001;
};

/// Judges one body with exact predicates: closed (G1), manifold (G2), Euler (G3), no intersections
/// (G4), no degenerate triangles (G5), no T-junctions (G6), outward (G7), no duplicate faces (G8),
/// in range (G13). Points must be distinct.
std::vector<GateFailure> check_shell(std::span<const GridPoint> points,
                                     std::span<const Triangle> triangles,
                                     const GateOptions& options);

/// A body as a reader of the file sees it, before any welding.
struct ParsedBody {
  std::string name{};            ///< as in the file: of CityJSON the object's id; "" when the file
                                 ///< is by surface type and has no bodies
  std::vector<Point3> points{};  ///< metres from the file's origin
  std::vector<Triangle> triangles{};
  std::vector<std::string> patches{};  ///< per triangle: the surface type in the file, "" for none
  bool float32 = false;                ///< the file holds coordinates as float32
  Point3 centre{};                     ///< what float32 coordinates are counted from in the file
};

using ParsedBodySink = std::function<Result<void>(ParsedBody&&)>;

/// Reads files that citymesh wrote, sharing no code with the writers, and strictly: what a writer
/// would not write is an error. `format` is a key of the format table. For binary STL the sidecar
/// stands beside the file, and behind the triangles in `text`. Polygons are cut into triangles as
/// meshing does. Files are read body by body, but for JSON, which is in memory as a whole. A solid
/// of `patches: by_type` comes as one body without a name. Errors: DataLoss naming what is wrong
/// and where (line or byte); NotFound or Unavailable for a file that cannot be read; those of the
/// sink.
Result<void> parse_text(std::string_view format, std::string_view text, const ParsedBodySink& sink);
Result<void> parse_file(std::string_view format, const std::filesystem::path& file,
                        const ParsedBodySink& sink);

/// G14 on what was read back: `named` bodies have a name that solvers can read,
/// [A-Za-z][A-Za-z0-9_]*, and every triangle says which patch it belongs to.
std::vector<GateFailure> check_labels(const ParsedBody& body, bool named);

/// Snaps a parsed body to the grid and welds equal coordinates. Errors: DataLoss for coordinates
/// that are not on the grid to within float32 rounding, or not finite.
struct WeldedBody {
  std::vector<GridPoint> points{};
  std::vector<Triangle> triangles{};
};
Result<WeldedBody> weld(const ParsedBody& body);

}  // namespace citymesh
