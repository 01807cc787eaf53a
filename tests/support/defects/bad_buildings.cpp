#include "tests/support/defects/bad_buildings.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/support/defects/random.h"

namespace citymesh::testing {
namespace {

using Corners = std::vector<Point3>;

class Pile {
 public:
  Pile() {
    building_.geometries.emplace_back();
    building_.geometries[0].lod = {2, -1};
    building_.surfaces.push_back({SurfaceType::WallSurface, {}});
  }
  void face(const Corners& corners) {
    Geometry& geometry = building_.geometries[0];
    Polygon polygon;
    polygon.surface = 0;
    polygon.rings.emplace_back();
    for (const Point3& p : corners) {
      polygon.rings[0].push_back(static_cast<std::uint32_t>(geometry.points.size()));
      geometry.points.push_back(p);
    }
    geometry.polygons.push_back(std::move(polygon));
  }
  /// An axis-parallel box; `inwards` for a cavity.
  void box(const Point3& low, const Point3& high, bool inwards = false) {
    const auto at = [&](int i) {
      return Point3{i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    };
    constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& side : kSides)
      if (inwards)
        face({at(side[3]), at(side[2]), at(side[1]), at(side[0])});
      else
        face({at(side[0]), at(side[1]), at(side[2]), at(side[3])});
  }
  Building& building() { return building_; }

 private:
  Building building_;
};

/// A bumpy ring of triangles, each turned by chance.
Building ring_of_triangles(std::size_t faces) {
  Pile pile;
  Random random(1);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(faces) / 2)));
  const auto at = [&](std::size_t i, std::size_t j) {
    const double turn = 2 * std::numbers::pi / static_cast<double>(side);
    const double u = turn * static_cast<double>(i % side), v = turn * static_cast<double>(j % side);
    const double r = 20 + 3 * std::sin(5 * u) + 2 * std::cos(7 * v);
    return Point3{(60 + r * std::cos(v)) * std::cos(u), (60 + r * std::cos(v)) * std::sin(u),
                  30 + r * std::sin(v)};
  };
  const auto triangle = [&](const Point3& a, Point3 b, Point3 c) {
    if (random.coin()) std::swap(b, c);
    pile.face({a, b, c});
  };
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return pile.building();
}

Building all_points_equal() {
  Pile pile;
  for (int i = 0; i < 6; ++i) pile.face(Corners(4, {5, 5, 5}));
  return pile.building();
}

Building coincident_faces(std::size_t faces) {
  Pile pile;
  for (std::size_t i = 0; i < faces; ++i) pile.face({{0, 0, 0}, {10, 0, 0}, {0, 10, 3}});
  return pile.building();
}

/// A box with a cavity, in it a box with a cavity.
Building nested_inner_shells() {
  Pile pile;
  for (int i = 0; i < 4; ++i) {
    const double in = 2.0 * i;
    pile.box({in, in, in}, {20 - in, 20 - in, 20 - in}, i % 2 == 1);
  }
  Geometry& geometry = pile.building().geometries[0];
  geometry.type = GeometryType::Solid;
  Solid solid;
  solid.interiors.resize(3);
  for (std::uint32_t i = 0; i < geometry.polygons.size(); ++i)
    (i < 6 ? solid.exterior : solid.interiors[i / 6 - 1]).push_back(i);
  geometry.solids.push_back(std::move(solid));
  return pile.building();
}

/// A strip with half a twist.
Building moebius_strip() {
  Pile pile;
  constexpr int kPieces = 40;
  const auto at = [](int i, double side) {
    const double u = 2 * std::numbers::pi * i / kPieces, r = 20 + side * std::cos(u / 2);
    return Point3{r * std::cos(u), r * std::sin(u), 10 + side * std::sin(u / 2)};
  };
  for (int i = 0; i < kPieces; ++i) {
    pile.face({at(i, -4), at(i + 1, -4), at(i + 1, 4)});
    pile.face({at(i, -4), at(i + 1, 4), at(i, 4)});
  }
  return pile.building();
}

Building single_triangle() {
  Pile pile;
  pile.face({{0, 0, 0}, {10, 0, 0}, {0, 10, 4}});
  return pile.building();
}

Building short_rings() {
  Pile pile;
  pile.face({{0, 0, 0}, {10, 0, 0}});
  pile.face({{0, 0, 0}});
  pile.face({});
  return pile.building();
}

Building zero_height() {
  Pile pile;
  pile.box({0, 0, 3}, {10, 10, 3});
  return pile.building();
}

Building far_away() {
  Pile pile;
  pile.box({1e7, 1e7, 0}, {1e7 + 10, 1e7 + 10, 10});
  return pile.building();
}

}  // namespace

std::vector<BadBuilding> bad_buildings(std::size_t size) {
  return {{"ring_of_triangles", ring_of_triangles(size)},
          {"all_points_equal", all_points_equal()},
          {"coincident_faces", coincident_faces(size / 10)},
          {"nested_inner_shells", nested_inner_shells()},
          {"moebius_strip", moebius_strip()},
          {"single_triangle", single_triangle()},
          {"short_rings", short_rings()},
          {"zero_height", zero_height()},
          {"far_away", far_away()}};
}

}  // namespace citymesh::testing
