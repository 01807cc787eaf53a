#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/citymodel/building.h"
#include "tests/support/shapes.h"

/// The smallest buildings that have exactly one kind of defect, and their sound siblings.
namespace citymesh::testing {

/// The shell of a Draw as a stated solid.
inline Building solid(Draw draw) {
  Building building = draw.done();
  Geometry& geometry = building.geometries[0];
  geometry.type = GeometryType::Solid;
  geometry.assembled = false;
  Solid all;
  for (std::uint32_t p = 0; p < geometry.polygons.size(); ++p) all.exterior.push_back(p);
  geometry.solids = {all};
  return building;
}

inline Building of_type(Draw draw, GeometryType type) {
  Building building = draw.done();
  building.geometries[0].type = type;
  building.geometries[0].assembled = false;
  return building;
}

/// Copies the polygons of a building to the end of another's; their numbers.
inline std::vector<std::uint32_t> append(Building& building, const Building& other) {
  Geometry& to = building.geometries[0];
  const Geometry& from = other.geometries[0];
  const auto points = static_cast<std::uint32_t>(to.points.size());
  const auto surfaces = static_cast<std::int32_t>(building.surfaces.size());
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  building.surfaces.insert(building.surfaces.end(), other.surfaces.begin(), other.surfaces.end());
  std::vector<std::uint32_t> numbers;
  for (Polygon polygon : from.polygons) {
    polygon.surface += surfaces;
    for (Ring& ring : polygon.rings)
      for (std::uint32_t& corner : ring) corner += points;
    numbers.push_back(static_cast<std::uint32_t>(to.polygons.size()));
    to.polygons.push_back(std::move(polygon));
  }
  return numbers;
}

inline void reverse(Building& building, std::size_t polygon) {
  for (Ring& ring : building.geometries[0].polygons[polygon].rings)
    std::reverse(ring.begin(), ring.end());
}

/// Adds a body as a cavity: its faces look into the hollow.
inline Building with_cavity(Building building, const Draw& cavity) {
  Draw copy = cavity;
  const auto numbers = append(building, copy.done());
  for (const std::uint32_t polygon : numbers) reverse(building, polygon);
  building.geometries[0].solids[0].interiors.push_back(numbers);
  return building;
}

inline Building several(GeometryType type, const std::vector<Draw>& solids) {
  Building building = solid(solids[0]);
  for (std::size_t s = 1; s < solids.size(); ++s) {
    Draw copy = solids[s];
    Solid next;
    next.exterior = append(building, copy.done());
    building.geometries[0].solids.push_back(next);
  }
  building.geometries[0].type = type;
  return building;
}

inline Draw box(double x0, double y0, double z0, double x1, double y1, double z1) {
  Draw draw;
  const auto base = rectangle(x0, y0, x1, y1, z0);
  draw.ground(base).walls(base, z1).flat_roof(base, z1);
  return draw;
}

/// A block of 10 × 8 × 6 m with these rings as its roof.
inline Draw block_with_roof(std::vector<std::vector<Point3>> roof) {
  Draw draw = block(0, 0, 10, 8, 6);
  draw.geometry().polygons.pop_back();
  draw.face(SurfaceType::RoofSurface, std::move(roof));
  return draw;
}

/// The same with a pyramid for a roof, whose top may lie below the eaves.
inline Draw block_with_pyramid(double top) {
  Draw draw = block(0, 0, 10, 8, 6);
  draw.geometry().polygons.pop_back();
  const auto eaves = rectangle(0, 0, 10, 8, 6);
  for (std::size_t i = 0; i < 4; ++i)
    draw.face(SurfaceType::RoofSurface, {{eaves[i], eaves[(i + 1) % 4], {5, 4, top}}});
  return draw;
}

/// Two pyramids on a rectangle of the size of the block's plan, base to base at z = 3.
inline Draw double_pyramid() {
  Draw draw;
  const auto base = rectangle(0, 0, 10, 8, 3);
  for (std::size_t i = 0; i < 4; ++i) {
    const Point3 &a = base[i], &b = base[(i + 1) % 4];
    draw.face(SurfaceType::Unknown, {{a, b, {5, 4, 5}}});
    draw.face(SurfaceType::Unknown, {{b, a, {5, 4, 1}}});
  }
  return draw;
}

/// A case of a code: what has it, and what is like it but has not.
struct Case {
  int code = 0;
  std::string title{};
  Building defective{};
  Building sound{};
};

inline std::vector<Case> cases() {
  const auto roof = rectangle(0, 0, 10, 8, 6);
  const auto hole = [](double x0, double y0, double x1, double y1) {
    auto ring = rectangle(x0, y0, x1, y1, 6);
    std::reverse(ring.begin(), ring.end());
    return ring;
  };
  const auto roofed = [](std::vector<std::vector<Point3>> rings) {
    return of_type(block_with_roof(std::move(rings)), GeometryType::MultiSurface);
  };
  const Building sound = solid(block(0, 0, 10, 8, 6));
  std::vector<Case> all;

  {
    auto draw = block(0, 0, 10, 8, 6);
    draw.face(SurfaceType::WallSurface, {{{0, 0, 0}, {10, 0, 0}}});
    all.push_back({101, "a ring of two points", solid(draw), sound});
  }
  {
    Building twice = sound, near = sound, apart = sound;
    const auto repeat = [](Building& building, double by_m) {
      Geometry& geometry = building.geometries[0];
      Ring& ring = geometry.polygons[0].rings[0];
      Point3 p = geometry.points[ring[0]];
      p.x += by_m;
      p.y -= by_m / 2;
      geometry.points.push_back(p);
      ring.insert(ring.begin() + 1, static_cast<std::uint32_t>(geometry.points.size() - 1));
    };
    repeat(twice, 0);
    repeat(near, 0.0005);
    repeat(apart, 0.002);
    apart.geometries[0].type = GeometryType::MultiSurface;
    apart.geometries[0].solids.clear();
    all.push_back({102, "a point twice in a row", twice, sound});
    all.push_back({102, "points within the snap tolerance", near, apart});
  }
  {
    Building closed = sound;
    closed.geometries[0].closed_rings = true;
    for (Polygon& polygon : closed.geometries[0].polygons)
      polygon.rings[0].push_back(polygon.rings[0][0]);
    Building open = closed;
    open.geometries[0].polygons[2].rings[0].pop_back();
    all.push_back({103, "a ring that does not return", open, closed});
  }
  {
    Building bow_tie = sound;
    Ring& ring = bow_tie.geometries[0].polygons[0].rings[0];
    std::swap(ring[1], ring[2]);
    all.push_back({104, "a bow tie", bow_tie, sound});
    all.push_back({104, "a spike",
                   roofed({{{0, 0, 6}, {10, 0, 6}, {12, 0, 6}, {10, 0, 6}, {10, 8, 6}, {0, 8, 6}}}),
                   sound});
    all.push_back({104, "a ring that touches itself",
                   roofed({{{0, 0, 6}, {10, 0, 6}, {10, 8, 6}, {5, 0, 6}, {0, 8, 6}}}),
                   roofed({{{0, 0, 6}, {10, 0, 6}, {10, 8, 6}, {5, 0.01, 6}, {0, 8, 6}}})});
    all.push_back({104, "a triangle on a line", roofed({{{0, 0, 6}, {5, 0, 6}, {10, 0, 6}}}),
                   roofed({{{0, 0, 6}, {5, 0.01, 6}, {10, 0, 6}}})});
  }
  all.push_back({201, "a hole across the edge", roofed({roof, hole(8, 2, 12, 4)}),
                 roofed({roof, hole(8, 2, 9, 4)})});
  all.push_back({201, "holes that cross", roofed({roof, hole(1, 1, 4, 4), hole(3, 3, 6, 6)}),
                 roofed({roof, hole(1, 1, 4, 4), hole(4, 4, 6, 6)})});
  all.push_back({201, "a hole that runs along the edge", roofed({roof, hole(0, 2, 4, 4)}),
                 roofed({roof, {{0, 3, 6}, {2, 4, 6}, {2, 2, 6}}})});
  all.push_back({202, "a hole like its polygon", roofed({roof, hole(0, 0, 10, 8)}),
                 roofed({roof, hole(1, 1, 9, 7)})});
  all.push_back({202, "a hole twice", roofed({roof, hole(1, 1, 4, 4), hole(1, 1, 4, 4)}),
                 roofed({roof, hole(1, 1, 4, 4)})});
  all.push_back({203, "a corner 5 cm off",
                 roofed({{{0, 0, 6}, {10, 0, 6}, {10, 8, 6.05}, {0, 8, 6}}}),
                 roofed({{{0, 0, 6}, {10, 0, 6}, {10, 8, 6.02}, {0, 8, 6}}})});
  const auto folded = [&](double rise) {
    return roofed({{{0, 0, 6},
                    {5, 0, 6},
                    {5.005, 0, 6 + rise},
                    {10, 0, 6 + rise},
                    {10, 8, 6 + rise},
                    {5.005, 8, 6 + rise},
                    {5, 8, 6},
                    {0, 8, 6}}});
  };
  all.push_back({204, "a fold of 4 mm", folded(0.004), folded(0.001)});
  all.push_back({205, "a hole from wall to wall",
                 roofed({roof, {{0, 4, 6}, {5, 6, 6}, {10, 4, 6}, {5, 2, 6}}}),
                 roofed({roof, {{0, 4, 6}, {5, 6, 6}, {9, 4, 6}, {5, 2, 6}}})});
  all.push_back({206, "a hole outside", roofed({roof, hole(12, 2, 14, 4)}),
                 roofed({roof, hole(2, 2, 4, 4)})});
  all.push_back({207, "a hole in a hole", roofed({roof, hole(1, 1, 6, 6), hole(2, 2, 4, 4)}),
                 roofed({roof, hole(1, 1, 6, 6), hole(7, 2, 8, 4)})});
  all.push_back({208, "a hole that runs like its polygon", roofed({roof, rectangle(2, 2, 4, 4, 6)}),
                 roofed({roof, hole(2, 2, 4, 4)})});

  {
    const Point3 a{0, 0, 0}, b{10, 0, 0}, c{0, 8, 0}, d{0, 0, 6};
    Draw three, four;
    for (Draw* draw : {&three, &four})
      draw->face(SurfaceType::GroundSurface, {{a, c, b}})
          .face(SurfaceType::WallSurface, {{a, b, d}})
          .face(SurfaceType::WallSurface, {{a, d, c}});
    four.face(SurfaceType::RoofSurface, {{b, c, d}});
    all.push_back({301, "three faces", solid(three), solid(four)});
  }
  {
    auto open = block(0, 0, 10, 8, 6);
    open.geometry().polygons.pop_back();
    all.push_back({302, "no roof", solid(open), of_type(open, GeometryType::CompositeSurface)});
    all.push_back({302, "boundary surfaces without a roof", open.done(),
                   of_type(open, GeometryType::MultiSurface)});
  }
  {
    auto edge = block(0, 0, 10, 8, 6), apart = block(0, 0, 10, 8, 6);
    const auto east = rectangle(10, 8, 14, 12);
    edge.ground(east).walls(east, 6).flat_roof(east, 6);
    all.push_back({303, "two blocks on one edge", solid(edge), sound});
    Building corner = solid(block(0, 0, 10, 8, 6));
    for (const std::uint32_t p : append(corner, box(10, 8, 6, 12, 10, 9).done()))
      corner.geometries[0].solids[0].exterior.push_back(p);
    all.push_back({303, "two blocks on one corner", corner, sound});
    Draw butterfly;
    butterfly.face(SurfaceType::RoofSurface, {{{0, 0, 6}, {1, 0, 6}, {1, 1, 6}}})
        .face(SurfaceType::RoofSurface, {{{1, 1, 6}, {2, 1, 6}, {2, 2, 6}}});
    Draw strip;
    strip.face(SurfaceType::RoofSurface, {{{0, 0, 6}, {1, 0, 6}, {1, 1, 6}}})
        .face(SurfaceType::RoofSurface, {{{0, 0, 6}, {1, 1, 6}, {0, 1, 6}}});
    all.push_back({303, "surfaces on one corner",
                   of_type(butterfly, GeometryType::CompositeSurface),
                   of_type(strip, GeometryType::CompositeSurface)});
  }
  {
    Building two = sound;
    for (const std::uint32_t p : append(two, block(20, 0, 24, 4, 3).done()))
      two.geometries[0].solids[0].exterior.push_back(p);
    all.push_back(
        {305, "two blocks in one shell", two,
         several(GeometryType::MultiSolid, {block(0, 0, 10, 8, 6), block(20, 0, 24, 4, 3)})});
  }
  all.push_back({306, "a roof through the floor", solid(block_with_pyramid(-2)),
                 solid(block_with_pyramid(1))});
  {
    Building turned = sound;
    reverse(turned, 5);
    all.push_back({307, "a face that looks inward", turned, sound});
  }

  const auto hollow = [&](const Draw& cavity) { return with_cavity(sound, cavity); };
  const Building good = hollow(box(1, 1, 1, 4, 4, 4));
  all.push_back({401, "a cavity through the wall", hollow(box(8, 1, 1, 12, 4, 4)), good});
  all.push_back({401, "a cavity on the wall", hollow(box(0, 1, 1, 4, 4, 4)), good});
  all.push_back({401, "cavities that overlap", with_cavity(good, box(3, 3, 3, 6, 6, 5)),
                 with_cavity(good, box(5, 5, 1, 6, 6, 5))});
  all.push_back({402, "a cavity like its solid", hollow(block(0, 0, 10, 8, 6)), good});
  all.push_back({402, "a cavity twice", with_cavity(good, box(1, 1, 1, 4, 4, 4)), good});
  all.push_back({403, "a cavity outside", hollow(box(20, 1, 1, 24, 4, 4)), good});
  all.push_back({404, "a cavity from wall to wall", hollow(double_pyramid()), good});
  {
    Building inward = sound;
    for (std::size_t p = 0; p < 6; ++p) reverse(inward, p);
    all.push_back({405, "a solid inside out", inward, sound});
    Building outward = good;
    for (const std::uint32_t p : outward.geometries[0].solids[0].interiors[0]) reverse(outward, p);
    all.push_back({405, "a cavity inside out", outward, good});
  }

  const auto pair = [](const Draw& second) {
    return several(GeometryType::CompositeSolid, {block(0, 0, 10, 8, 6), second});
  };
  const Building joined = pair(box(10, 2, 0, 14, 6, 4));
  all.push_back({501, "solids that cross", pair(box(9, 2, 0, 14, 6, 4)), joined});
  all.push_back({501, "a solid in another", pair(box(2, 2, 1, 4, 4, 4)), joined});
  all.push_back({502, "a solid twice", pair(block(0, 0, 10, 8, 6)), joined});
  all.push_back({503, "solids apart", pair(box(11, 2, 0, 14, 6, 4)), joined});
  all.push_back({902, "no faces", Draw().done(), sound});
  {
    Building far = sound;
    far.geometries[0].points[0].x = 3e5;
    all.push_back({issue_code::kCoordinateOutOfRange, "a point 300 km away", far, sound});
  }
  {
    Draw down, up;
    down.ground(rectangle(0, 0, 10, 8));
    up.flat_roof(rectangle(0, 0, 10, 8), 0);
    Building turned = of_type(down, GeometryType::MultiSurface),
             right = of_type(up, GeometryType::MultiSurface);
    turned.geometries[0].footprint = right.geometries[0].footprint = true;
    all.push_back({issue_code::kFootprintTurned, "a footprint seen from below", turned, right});
  }
  return all;
}

}  // namespace citymesh::testing
