#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mesh_checker {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// A named set of triangles as it stands in the file; corners with equal coordinates are one point.
struct Body {
  std::string name{};
  std::vector<Point> points{};
  std::vector<Triangle> triangles{};
  std::vector<std::string> findings{};  ///< what is wrong with the way it is written
};

/// The file cannot be understood: says where and why.
struct ReadError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Wavefront OBJ with triangles only. A body is an `o`; faces before the first one belong to a body
/// without name. Found fault with: a vertex used by two bodies, a name used twice, a group that
/// does not begin with its body's name.
std::vector<Body> read_obj(std::string_view text);

/// ASCII STL. A body is a run of solids whose names agree in the part before the last `__`; a solid
/// without facets is none, as an STL file must have a solid even when there is nothing to say.
std::vector<Body> read_stl(std::string_view text);

}  // namespace mesh_checker
