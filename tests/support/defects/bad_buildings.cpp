#include "tests/support/defects/bad_buildings.h"

#include <array>
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

Building all_points_equal(std::size_t) {
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
Building nested_inner_shells(std::size_t) {
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
Building moebius_strip(std::size_t) {
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

Building single_triangle(std::size_t) {
  Pile pile;
  pile.face({{0, 0, 0}, {10, 0, 0}, {0, 10, 4}});
  return pile.building();
}

Building short_rings(std::size_t) {
  Pile pile;
  pile.face({{0, 0, 0}, {10, 0, 0}});
  pile.face({{0, 0, 0}});
  pile.face({});
  return pile.building();
}

Building zero_height(std::size_t) {
  Pile pile;
  pile.box({0, 0, 3}, {10, 10, 3});
  return pile.building();
}

Building far_away(std::size_t) {
  Pile pile;
  pile.box({1e7, 1e7, 0}, {1e7 + 10, 1e7 + 10, 10});
  return pile.building();
}

/// Corners of a star, on a plane that leans.
Corners star(std::size_t corners, double z) {
  Corners ring;
  for (std::size_t i = 0; i < corners; ++i) {
    const double u = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    const double r = i % 2 == 0 ? 30 : 20;
    ring.push_back({r * std::cos(u), r * std::sin(u), z + 0.1 * r * std::cos(u)});
  }
  return ring;
}

/// Where all corners stand on one ring.
Building one_ring(std::size_t corners) {
  Pile pile;
  pile.face(star(corners / 10, 20));
  return pile.building();
}

/// A ring that crosses itself wherever it can.
Building tangled_ring(std::size_t corners) {
  Pile pile;
  Random random(3);
  Corners ring;
  for (std::size_t i = 0; i < corners / 50; ++i) {
    const double x = random.between(0, 40), y = random.between(0, 40);
    ring.push_back({x, y, 5 + x / 4});
  }
  pile.face(ring);
  return pile.building();
}

/// Upright walls around a star; nothing above, and below it a ring that runs the wrong way.
Building open_star(std::size_t faces) {
  Pile pile;
  const Corners below = star(faces / 20, 5), above = star(faces / 20, 25);
  for (std::size_t i = 0, n = below.size(); i < n; ++i)
    pile.face({below[i], below[(i + 1) % n], above[(i + 1) % n], above[i]});
  pile.face(below);
  return pile.building();
}

Building random_triangles(std::size_t faces) {
  Pile pile;
  Random random(2);
  const auto corner = [&] {
    const double x = random.between(0, 50), y = random.between(0, 50);
    return Point3{x, y, random.between(0, 50)};
  };
  for (std::size_t i = 0; i < faces / 100; ++i) {
    const Point3 a = corner(), b = corner();
    pile.face({a, b, corner()});
  }
  return pile.building();
}

/// Triangles that nearly lie on each other: every pair overlaps.
Building stack_of_sheets(std::size_t faces) {
  Pile pile;
  for (std::size_t i = 0; i < faces / 100; ++i) {
    const double z = 0.01 * static_cast<double>(i);
    pile.face({{0, 0, z}, {10, 0, z}, {0, 10, z + 3}});
  }
  return pile.building();
}

/// Triangles from one corner to the next, each larger than the one before.
Building fan_of_slivers(std::size_t faces) {
  Pile pile;
  for (std::size_t i = 0; i < faces / 50; ++i) {
    const double y = 0.002 * static_cast<double>(i);
    pile.face({{0, 0, 0}, {100, y, 5}, {100, y + 0.002, 5}});
  }
  return pile.building();
}

/// Boxes that stand in each other, all around one place.
Building boxes_in_boxes(std::size_t faces) {
  Pile pile;
  const std::size_t count = faces / 600;
  for (std::size_t i = 0; i < count; ++i) {
    const double in = 0.02 * static_cast<double>(i), t = 0.1 * static_cast<double>(i % 7);
    pile.box({in, in + t, in}, {100 - in, 100 - in, 60 - in + t});
  }
  return pile.building();
}

}  // namespace

std::span<const BadBuilding> bad_buildings() {
  static constexpr std::array kAll{BadBuilding{"ring_of_triangles", ring_of_triangles},
                                   BadBuilding{"all_points_equal", all_points_equal},
                                   BadBuilding{"coincident_faces", coincident_faces},
                                   BadBuilding{"nested_inner_shells", nested_inner_shells},
                                   BadBuilding{"moebius_strip", moebius_strip},
                                   BadBuilding{"single_triangle", single_triangle},
                                   BadBuilding{"short_rings", short_rings},
                                   BadBuilding{"zero_height", zero_height},
                                   BadBuilding{"one_ring", one_ring},
                                   BadBuilding{"tangled_ring", tangled_ring},
                                   BadBuilding{"open_star", open_star},
                                   BadBuilding{"random_triangles", random_triangles},
                                   BadBuilding{"stack_of_sheets", stack_of_sheets},
                                   BadBuilding{"fan_of_slivers", fan_of_slivers},
                                   BadBuilding{"boxes_in_boxes", boxes_in_boxes},
                                   BadBuilding{"far_away", far_away}};
  return kAll;
}

}  // namespace citymesh::testing
