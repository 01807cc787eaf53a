#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/point.h"
#include "core/write/painter.h"
#include "core/write/styles.h"

namespace citymesh {

/// A plane face as it is drawn, with its outline. Corners are grid points, which fit 32 bits.
struct DrawnFace {
  using Corner = std::array<std::int32_t, 3>;
  enum class Kind : std::uint8_t { Wall, Roof, Opening };

  std::vector<std::vector<Corner>> rings{};
  std::vector<std::array<Corner, 3>> triangles{};
  Point3 normal{};
  Kind kind = Kind::Wall;
  std::uint8_t style = 0;  ///< index of kStyles
  std::int32_t base = 0;   ///< z of the ground that its shadow falls on
};

/// Steeper faces look like walls.
inline constexpr double kRoofNormal_z = 0.3;

DrawnFace::Corner corner_of(const GridPoint& p);
Point3 metres(const DrawnFace::Corner& corner);
double dot(const Point3& a, const Point3& b);

/// Direction to the sun, unit, east-north-up.
inline constexpr Point3 kSun{0.663414, -0.383022, 0.642788};  // 120° azimuth, 40° high

/// From view space to the page: tenths of a pixel, y down.
struct Page {
  double scale = 1;  ///< pixels in a metre
  double left = 0, top = 0;

  std::array<std::int64_t, 2> tenths(const Point3& view) const;
};

using Outline = std::vector<std::array<std::int64_t, 2>>;

/// Page outline of a ring in view space without repeated points; empty when nothing is left to see.
Outline outline_of(const Page& page, std::span<const Point3> ring);

// SVG: a path of an outline, numbers with one decimal, colours.
void append_outline(std::string& svg, const Outline& outline);
void append_segment(std::string& svg, const std::array<std::int64_t, 2>& from,
                    const std::array<std::int64_t, 2>& to);
void append_tenths(std::string& svg, std::int64_t tenths);
void append_px(std::string& svg, double px);

using Colour = std::array<std::uint8_t, 3>;
void append_colour(std::string& svg, const Colour& colour);

/// `light` from 0 (in the shade) to 1 (full sun): shade turns bluish, sun turns white.
Colour shaded(const Colour& base, DrawnFace::Kind kind, double light);

/// Which looks (style, kind, light) the faces of a document have.
class Looks {
 public:
  void add(std::span<const DrawnFace> faces);

  /// Rules for paths below `selector`.
  std::string css(std::string_view selector, double stroke_px) const;

 private:
  std::vector<char> used_{};
};

/// The faces that the viewer sees, what is nearer after what is farther.
void append_faces(std::string& svg, const Page& page, std::span<const DrawnFace> faces);

}  // namespace citymesh
