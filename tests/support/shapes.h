#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/mesh.h"

namespace citymesh::testing {

/// A triangle soup as the gates take it.
struct Triangles {
  std::vector<GridPoint> points{};
  std::vector<Triangle> triangles{};

  Triangles& add(const Triangles& other) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), other.points.begin(), other.points.end());
    for (const Triangle& t : other.triangles)
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return *this;
  }
  Triangles& turn() {
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
    return *this;
  }
};

/// An axis-parallel box in steps, closed and outward.
inline Triangles box(const GridPoint& min, const GridPoint& max) {
  Triangles b;
  for (int i = 0; i < 8; ++i)
    b.points.push_back({i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z});
  b.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return b;
}

/// Builds a Building polygon by polygon, in metres.
class Draw {
 public:
  explicit Draw(std::string gml_id = "house") {
    building_.gml_id = std::move(gml_id);
    building_.geometries.push_back({});
    geometry().lod = {2, -1};
    geometry().assembled = true;
  }

  Draw& face(SurfaceType type, std::vector<std::vector<Point3>> rings) {
    Polygon polygon;
    polygon.surface = static_cast<std::int32_t>(building_.surfaces.size());
    building_.surfaces.push_back({type, "s" + std::to_string(building_.surfaces.size())});
    for (const auto& ring : rings) {
      Ring indices;
      for (const Point3& p : ring) {
        indices.push_back(static_cast<std::uint32_t>(geometry().points.size()));
        geometry().points.push_back(p);
      }
      polygon.rings.push_back(std::move(indices));
    }
    geometry().polygons.push_back(std::move(polygon));
    return *this;
  }

  /// Vertical walls under the corners of a ring that is counter-clockwise seen from above.
  Draw& walls(const std::vector<Point3>& base, double top) {
    for (std::size_t i = 0; i < base.size(); ++i) wall(base[i], base[(i + 1) % base.size()], top);
    return *this;
  }
  Draw& wall(const Point3& a, const Point3& b, double top) {
    return face(SurfaceType::WallSurface, {{a, b, {b.x, b.y, top}, {a.x, a.y, top}}});
  }
  Draw& ground(std::vector<Point3> base) {
    return face(SurfaceType::GroundSurface, {{base.rbegin(), base.rend()}});
  }
  Draw& flat_roof(std::vector<Point3> base, double top) {
    for (Point3& p : base) p.z = top;
    return face(SurfaceType::RoofSurface, {base});
  }

  Geometry& geometry() { return building_.geometries[0]; }
  Building done() { return building_; }
  Building& building() { return building_; }

 private:
  Building building_;
};

/// Corners of a rectangle at height z, counter-clockwise.
inline std::vector<Point3> rectangle(double x0, double y0, double x1, double y1, double z = 0) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

/// A closed block with flat roof.
inline Draw block(double x0, double y0, double x1, double y1, double height) {
  Draw draw;
  const auto base = rectangle(x0, y0, x1, y1);
  draw.ground(base).walls(base, height).flat_roof(base, height);
  return draw;
}

}  // namespace citymesh::testing
