#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/mesh/mesh.h"

namespace citymesh::test {

inline GridPoint grid(double x, double y, double z) {
  return {std::llround(x * kGridStepsPerMetre), std::llround(y * kGridStepsPerMetre),
          std::llround(z * kGridStepsPerMetre)};
}

/// A mesh built polygon by polygon.
class MeshBuilder {
 public:
  std::uint32_t point(double x, double y, double z) {
    shell_.points.push_back(grid(x, y, z));
    return static_cast<std::uint32_t>(shell_.points.size() - 1);
  }
  Face& face(SurfaceType type, const std::string& id, Ring corners) {
    Face& face = shell_.faces.emplace_back();
    face.rings = {std::move(corners)};
    face.type = type;
    face.source = static_cast<std::uint32_t>(shell_.surface_ids.size());
    shell_.surface_ids.push_back(id);
    return face;
  }
  TriangleMesh mesh() { return std::get<TriangleMesh>(citymesh::mesh(shell_)); }

 private:
  Shell shell_{.surface_ids = {""}};
};

/// Turns about (cx, cy) so that scenes are not all parallel to the axes.
struct Placement {
  double x = 0, y = 0, z = 0, turn_cos = 1, turn_sin = 0;
  std::array<double, 3> operator()(double px, double py, double pz) const {
    return {x + px * turn_cos - py * turn_sin, y + px * turn_sin + py * turn_cos, z + pz};
  }
};

/// A block of `outline` (counter-clockwise, convex) from 0 to `height`.
inline TriangleMesh block(const std::vector<std::array<double, 2>>& outline, double height,
                          const Placement& at = {}) {
  MeshBuilder builder;
  std::vector<std::uint32_t> low, high;
  for (const auto& [x, y] : outline) {
    const auto p = at(x, y, 0), q = at(x, y, height);
    low.push_back(builder.point(p[0], p[1], p[2]));
    high.push_back(builder.point(q[0], q[1], q[2]));
  }
  builder.face(SurfaceType::GroundSurface, "ground", {low.rbegin(), low.rend()});
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i)
    builder.face(SurfaceType::WallSurface, "wall_" + std::to_string(i),
                 {low[i], low[(i + 1) % n], high[(i + 1) % n], high[i]});
  builder.face(SurfaceType::RoofSurface, "roof", high);
  return builder.mesh();
}

inline TriangleMesh box(double width, double depth, double height, const Placement& at = {}) {
  return block({{0, 0}, {width, 0}, {width, depth}, {0, depth}}, height, at);
}

/// Gabled roof with the ridge along x.
inline TriangleMesh house(double width, double depth, double eaves, double ridge,
                          const Placement& at = {}) {
  MeshBuilder b;
  const auto point = [&](double x, double y, double z) {
    const auto p = at(x, y, z);
    return b.point(p[0], p[1], p[2]);
  };
  const auto a0 = point(0, 0, 0), a1 = point(width, 0, 0), a2 = point(width, depth, 0),
             a3 = point(0, depth, 0), e0 = point(0, 0, eaves), e1 = point(width, 0, eaves),
             e2 = point(width, depth, eaves), e3 = point(0, depth, eaves),
             r0 = point(0, depth / 2, ridge), r1 = point(width, depth / 2, ridge);
  b.face(SurfaceType::GroundSurface, "ground", {a0, a3, a2, a1});
  b.face(SurfaceType::WallSurface, "south", {a0, a1, e1, e0});
  b.face(SurfaceType::WallSurface, "east", {a1, a2, e2, r1, e1});
  b.face(SurfaceType::WallSurface, "north", {a2, a3, e3, e2});
  b.face(SurfaceType::WallSurface, "west", {a3, a0, e0, r0, e3});
  b.face(SurfaceType::RoofSurface, "roof_south", {e0, e1, r1, r0});
  b.face(SurfaceType::RoofSurface, "roof_north", {e2, e3, r0, r1});
  return b.mesh();
}

/// A flat building around a courtyard.
inline TriangleMesh courtyard(double width, double depth, double wing, double height,
                              const Placement& at = {}) {
  MeshBuilder b;
  const std::array<std::array<double, 2>, 4> outer{
      {{0, 0}, {width, 0}, {width, depth}, {0, depth}}};
  const std::array<std::array<double, 2>, 4> inner{
      {{wing, wing}, {width - wing, wing}, {width - wing, depth - wing}, {wing, depth - wing}}};
  std::array<std::array<std::uint32_t, 4>, 4> p{};  // outer low, outer high, inner low, inner high
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& flat = k < 2 ? outer[i] : inner[i];
      const auto q = at(flat[0], flat[1], k % 2 == 0 ? 0 : height);
      p[k][i] = b.point(q[0], q[1], q[2]);
    }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const auto add = [&](SurfaceType type, const char* id, std::vector<std::uint32_t> corners) {
      if (i == 0) {
        b.face(type, id, std::move(corners));
      } else {
        b.face(type, id + std::to_string(i), std::move(corners));
      }
    };
    add(SurfaceType::GroundSurface, "ground", {p[0][i], p[2][i], p[2][j], p[0][j]});
    add(SurfaceType::WallSurface, "wall", {p[0][i], p[0][j], p[1][j], p[1][i]});
    add(SurfaceType::WallSurface, "yard", {p[2][j], p[2][i], p[3][i], p[3][j]});
    add(SurfaceType::RoofSurface, "roof", {p[1][i], p[1][j], p[3][j], p[3][i]});
  }
  return b.mesh();
}

/// A block of 9 x 6 x 4 m with a shaft through it and two hollow spaces inside.
inline TriangleMesh with_shaft_and_cavity() {
  MeshBuilder b;
  const auto corners = [&](double x0, double y0, double z0, double x1, double y1, double z1) {
    return std::array{b.point(x0, y0, z0), b.point(x1, y0, z0), b.point(x1, y1, z0),
                      b.point(x0, y1, z0), b.point(x0, y0, z1), b.point(x1, y0, z1),
                      b.point(x1, y1, z1), b.point(x0, y1, z1)};
  };
  const auto o = corners(0, 0, 0, 9, 6, 4), s = corners(7, 2, 0, 8, 4, 4);
  b.face(SurfaceType::GroundSurface, "ground", {o[3], o[2], o[1], o[0]})
      .rings.push_back({s[0], s[1], s[2], s[3]});
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    b.face(SurfaceType::WallSurface, "wall", {o[i], o[j], o[j + 4], o[i + 4]});
    b.face(SurfaceType::WallSurface, "shaft", {s[j], s[i], s[i + 4], s[j + 4]});
  }
  b.face(SurfaceType::RoofSurface, "roof", {o[4], o[5], o[6], o[7]})
      .rings.push_back({s[7], s[6], s[5], s[4]});
  for (const double x : {1.0, 4.0}) {
    const auto c = corners(x, 1, 1, x + 2, 3, 3);
    const std::array<Ring, 6> inward{Ring{c[0], c[1], c[2], c[3]}, {c[7], c[6], c[5], c[4]},
                                     {c[0], c[4], c[5], c[1]},     {c[1], c[5], c[6], c[2]},
                                     {c[2], c[6], c[7], c[3]},     {c[3], c[7], c[4], c[0]}};
    for (const Ring& ring : inward)
      b.face(SurfaceType::InteriorWallSurface, "hollow", ring).cavity = true;
  }
  return b.mesh();
}

inline BuildingBodies building(const std::string& name, TriangleMesh mesh,
                               const std::string& rung = "as_is") {
  BuildingBodies bodies;
  bodies.gml_id = name;
  bodies.rung = rung;
  bodies.bodies.push_back({.name = name, .gml_id = name, .lod = "2", .mesh = std::move(mesh)});
  return bodies;
}

/// A house with a window in its south wall, at LoD3, all its members used.
inline BuildingBodies rich_building() {
  MeshBuilder b;
  const auto a0 = b.point(0, 0, 0), a1 = b.point(8, 0, 0), a2 = b.point(8, 6, 0),
             a3 = b.point(0, 6, 0), e0 = b.point(0, 0, 3), e1 = b.point(8, 0, 3),
             e2 = b.point(8, 6, 3), e3 = b.point(0, 6, 3), w0 = b.point(2, 0, 1),
             w1 = b.point(4, 0, 1), w2 = b.point(4, 0, 2), w3 = b.point(2, 0, 2);
  b.face(SurfaceType::GroundSurface, "GML_ground", {a0, a3, a2, a1});
  b.face(SurfaceType::WallSurface, "GML_south", {a0, a1, e1, e0}).rings.push_back({w0, w3, w2, w1});
  b.face(SurfaceType::Window, "GML_window", {w0, w1, w2, w3});
  b.face(SurfaceType::WallSurface, "GML_east", {a1, a2, e2, e1});
  b.face(SurfaceType::WallSurface, "", {a2, a3, e3, e2}).made_by = "healed";
  b.face(SurfaceType::WallSurface, "", {a3, a0, e0, e3});
  b.face(SurfaceType::RoofSurface, "{roof 1}", {e0, e1, e2, e3});

  BuildingBodies building = citymesh::test::building("b_1_house_one", b.mesh(), "healed");
  building.gml_id = "1 house:one";
  building.attributes = {{"owner", std::string("A & B <\"C\">")},
                         {"measuredHeight", 3.25},
                         {"storeysAboveGround", std::int64_t{1}},
                         {"storeysBelowGround", std::string("some")},
                         {"yearOfConstruction", std::int64_t{1987}},
                         {"roofType", std::string("1000")},
                         {"function", std::string("1010;1020")},
                         {"class", std::string("1000")},
                         {"usage", std::string("1010")},
                         {"creationDate", std::string("2020-02-03")},
                         {"dateOfConstruction", std::string("1987-05-06")},
                         {"name", std::string("Rathaus \xC3\xA4")},
                         {"listed", true},
                         {"rooms", std::int64_t{-5}},
                         {"rent", 12.5}};
  building.addresses = {{"Main Street", "12a", "PO 7", "12345", "Berlin", "BE", "Germany"},
                        {.street = "Side Street", .city = "Berlin"}};
  Body& house = building.bodies[0];
  house.gml_id = building.gml_id;
  house.lod = "3";
  house.attributes = building.attributes;
  house.addresses = building.addresses;

  Body part{.name = "part", .gml_id = "part", .kind = ObjectKind::BuildingPart, .lod = "2.2"};
  part.attributes = {{"roofType", std::string("flat roof")}};
  part.addresses = {{.city = "Potsdam"}};
  part.mesh = with_shaft_and_cavity();
  for (GridPoint& p : part.mesh.points) p.x += 20 * 10'000;
  building.bodies.push_back(std::move(part));

  Body low{.name = "low", .gml_id = "low", .kind = ObjectKind::BuildingPart, .lod = "1"};
  low.mesh = box(2, 2, 2, {40, 0, 0});
  building.bodies.push_back(std::move(low));

  Body balcony{.name = "balcony", .gml_id = "balcony", .kind = ObjectKind::BuildingInstallation};
  balcony.lod = "2";
  balcony.attributes = {{"function", std::string("1000")}, {"measuredHeight", 1.5}};
  balcony.mesh = box(2, 1, 1, {2, -5, 1});
  building.bodies.push_back(std::move(balcony));
  return building;
}

/// Streets of gabled and flat houses, perimeter blocks with something in the yard, a few towers.
inline std::vector<BuildingBodies> synthetic_city(int streets = 6, int blocks = 5) {
  std::vector<BuildingBodies> city;
  std::uint32_t state = 12345;  // a fixed sequence (Lehmer)
  const auto random = [&state](double low, double high) {
    state = static_cast<std::uint32_t>(static_cast<std::uint64_t>(state) * 48271 % 2147483647);
    return low + (high - low) * state / 2147483647.0;
  };
  const std::array<std::string, 5> rungs{"as_is", "healed", "rebuilt_2_5d", "wrapped",
                                         "lod1_block"};
  const auto rung = [&] {
    const double r = random(0, 1);
    return rungs[r < 0.62 ? 0 : r < 0.86 ? 1 : r < 0.93 ? 2 : r < 0.96 ? 3 : 4];
  };
  const double turn_cos = 0.970295726, turn_sin = 0.241921896;  // 14 degrees
  const auto add = [&](TriangleMesh mesh) {
    city.push_back(building("b_" + std::to_string(city.size() + 1), std::move(mesh), rung()));
  };
  for (int street = 0; street < streets; ++street)
    for (int column = 0; column < blocks; ++column) {
      const double left = column * 82.0, low = street * 62.0;
      const auto place = [&](double x, double y) {
        const double px = left + x, py = low + y;
        return Placement{px * turn_cos - py * turn_sin, px * turn_sin + py * turn_cos, 0.01 * px,
                         turn_cos, turn_sin};
      };
      switch ((street + 2 * column) % 4) {
        case 0:
          add(courtyard(66, 46, 11, random(13, 19), place(0, 0)));
          add(box(14, 10, random(4, 8), place(24, 17)));
          if (column % 2 == 0) add(box(7, 7, 34, place(44, 18)));
          break;
        case 1:
          for (int i = 0; i < 6; ++i) {
            add(house(10.5, 9, random(5, 7), random(9, 11), place(i * 11.2, 2)));
            add(house(10.5, 9, random(5, 7), random(9, 11), place(i * 11.2, 30)));
          }
          break;
        case 2:
          for (int i = 0; i < 4; ++i) {
            add(box(15.5, 13, random(9, 21), place(i * 16, 1)));
            add(box(15.5, 13, random(9, 21), place(i * 16, 31)));
          }
          break;
        default:
          add(block({{0, 0}, {40, 0}, {46, 9}, {46, 20}, {40, 29}, {0, 29}}, random(8, 14),
                    place(4, 6)));
          add(box(13, 13, random(38, 62), place(52, 10)));
          add(house(20, 8, 4, 7.5, place(8, 38)));
      }
    }
  return city;
}

}  // namespace citymesh::test
