#include "core/write/shell_faces.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

}  // namespace

std::vector<Triangle> pieces(std::span<const GridPoint> points, const Face& face) {
  if (auto triangles = triangulate(points, face.rings)) return std::move(*triangles);
  std::vector<Triangle> fan;
  if (face.rings.empty()) return fan;
  const Ring& ring = face.rings[0];
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) fan.push_back({ring[0], ring[i], ring[i + 1]});
  return fan;
}

std::vector<DrawnFace> drawn_faces(std::span<const GridPoint> points, std::span<const Face> faces,
                                   std::span<const std::uint8_t> styles, std::uint8_t back) {
  std::vector<DrawnFace> drawn;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Face& face = faces[f];
    if (face.rings.empty() || face.rings[0].size() < 3) continue;
    const Point3 normal = ring_normal(points, face.rings[0]);
    const double length = std::hypot(normal.x, normal.y, normal.z);
    if (!(length > 0)) continue;
    DrawnFace one;
    one.normal = {normal.x / length, normal.y / length, normal.z / length};
    one.style = styles[f];
    for (const Ring& ring : face.rings) {
      auto& corners = one.rings.emplace_back();
      for (const std::uint32_t corner : ring) corners.push_back(corner_of(points[corner]));
    }
    for (const Triangle& t : pieces(points, face))
      one.triangles.push_back(
          {corner_of(points[t[0]]), corner_of(points[t[1]]), corner_of(points[t[2]])});
    if (towards_viewer(to_view(one.normal)) < 0) {
      one.normal = {-one.normal.x, -one.normal.y, -one.normal.z};
      for (auto& ring : one.rings) std::reverse(ring.begin(), ring.end());
      for (auto& triangle : one.triangles) std::swap(triangle[1], triangle[2]);
      if (back != style::kOther && one.style == style::kSound) one.style = back;
    }
    one.kind = is_opening(face.type) && one.style <= style::kSound ? DrawnFace::Kind::Opening
               : one.normal.z > kRoofNormal_z                      ? DrawnFace::Kind::Roof
                                                                   : DrawnFace::Kind::Wall;
    drawn.push_back(std::move(one));
  }
  return drawn;
}

}  // namespace citymesh
