#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh {

// The view of the picture: orthographic, from the south-west and above. View space: x to the right,
// y away from the viewer along the ground, z up, in metres.

inline constexpr double kSinAzimuth = 0.573576436351046;  ///< the viewer looks 35° east of north
inline constexpr double kCosAzimuth = 0.819152044288992;
inline constexpr double kSinElevation = 0.629320391049837;  ///< and 39° down
inline constexpr double kCosElevation = 0.777145961456971;

inline Point3 to_view(const Point3& p) {
  return {p.x * kCosAzimuth - p.y * kSinAzimuth, p.x * kSinAzimuth + p.y * kCosAzimuth, p.z};
}

/// On the screen: x right, y up.
inline double screen_y(const Point3& view) {
  return view.y * kSinElevation + view.z * kCosElevation;
}

inline double depth(const Point3& view) { return view.y * kCosElevation - view.z * kSinElevation; }

/// How much a face with this normal (in view space) is turned towards the viewer; above 0: visible.
inline double towards_viewer(const Point3& normal) {
  return normal.z * kSinElevation - normal.y * kCosElevation;
}

/// A plane face to be painted: outline with holes, and the triangles it may be split into.
struct PaintFace {
  std::vector<std::vector<Point3>> rings{};        ///< in view space
  std::vector<std::array<Point3, 3>> triangles{};  ///< in view space
  Point3 normal{};                                 ///< unit, in view space
  std::uint32_t paint = 0;                         ///< the caller's
};

/// A face, or a triangle of it where whole faces cannot be ordered.
struct PaintStep {
  std::uint32_t face = 0;
  std::int32_t triangle = -1;  ///< -1: the whole face
};

/// The order in which to paint so that what is nearer covers what is farther. Right for all faces
/// that do not cut each other; overlaps that are cyclic are split into triangles first. (Newell,
/// Newell, Sancha 1972: two faces are in order where one lies on one side of the other's plane.)
std::vector<PaintStep> painting_order(const std::vector<PaintFace>& faces);

}  // namespace citymesh
