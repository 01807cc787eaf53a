#include "core/reconstruct/rebuild_2_5d.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/citymodel/grid.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/mesh/mesh.h"
#include "core/reconstruct/lane.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::Draw;
using ::testing::IsEmpty;
using testing::rectangle;

Shell shell_of(const Building& building) {
  return std::get<Gridded>(grid(building, building.geometries[0])).shell;
}

std::optional<Shell> rebuild(const Building& building, double tolerance_m = 0.001) {
  return rebuild_2_5d(shell_of(building), {tolerance_m}, RunContext{});
}

/// Volume of a shell that holds the delivery gates.
double gated_volume_m3(const Shell& shell) {
  const Meshed meshed = mesh(shell);
  if (const Issue* issue = std::get_if<Issue>(&meshed)) {
    ADD_FAILURE() << issue->code << " " << issue->where;
    return 0;
  }
  const auto& triangles = std::get<TriangleMesh>(meshed);
  for (const GateFailure& f : check_shell(triangles.points, triangles.triangles, {}))
    ADD_FAILURE() << f.gate << " " << f.where;
  return volume_m3(triangles.points, triangles.triangles);
}

std::size_t count(const Shell& shell, SurfaceType type, bool added) {
  return static_cast<std::size_t>(
      std::count_if(shell.faces.begin(), shell.faces.end(),
                    [&](const Face& f) { return f.type == type && f.added == added; }));
}

/// A gabled house of 10 m by 8 m, eaves 6 m, ridge 9 m along x; 600 m³. Its faces, one by one.
enum HousePart : unsigned { kGround, kSouth, kNorth, kWest, kEast, kRoofSouth, kRoofNorth, kAll };

Draw house(std::initializer_list<HousePart> without = {}) {
  const auto has = [&](HousePart part) {
    return std::find(without.begin(), without.end(), part) == without.end();
  };
  const Point3 a{0, 0, 0}, b{10, 0, 0}, c{10, 8, 0}, d{0, 8, 0};
  const Point3 A{0, 0, 6}, B{10, 0, 6}, C{10, 8, 6}, D{0, 8, 6}, w{0, 4, 9}, e{10, 4, 9};
  Draw draw;
  if (has(kGround)) draw.face(SurfaceType::GroundSurface, {{d, c, b, a}});
  if (has(kSouth)) draw.face(SurfaceType::WallSurface, {{a, b, B, A}});
  if (has(kNorth)) draw.face(SurfaceType::WallSurface, {{c, d, D, C}});
  if (has(kWest)) draw.face(SurfaceType::WallSurface, {{d, a, A, w, D}});
  if (has(kEast)) draw.face(SurfaceType::WallSurface, {{b, c, C, e, B}});
  if (has(kRoofSouth)) draw.face(SurfaceType::RoofSurface, {{A, B, e, w}});
  if (has(kRoofNorth)) draw.face(SurfaceType::RoofSurface, {{C, D, w, e}});
  return draw;
}
constexpr double kHouse_m3 = 600;

TEST(Rebuild25d, AHouseComesOutAsItIs) {
  const auto shell = rebuild(house().done());
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->faces.size(), 7u);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
  EXPECT_EQ(lane_of(*shell), "2.5d");
  for (const Face& face : shell->faces) {
    EXPECT_FALSE(face.added);
    EXPECT_NE(face.source, 0u);
    EXPECT_NE(face.type, SurfaceType::Unknown);
  }
}

TEST(Rebuild25d, AnyMissingFaceComesBack) {
  for (unsigned missing = 0; missing < kAll; ++missing) {
    SCOPED_TRACE(missing);
    const auto shell = rebuild(house({static_cast<HousePart>(missing)}).done());
    ASSERT_TRUE(shell);
    EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-3);
    EXPECT_EQ(shell->faces.size(), 7u);
    EXPECT_EQ(std::count_if(shell->faces.begin(), shell->faces.end(),
                            [](const Face& f) { return f.added; }),
              1);
  }
}

TEST(Rebuild25d, AnyTwoMissingFacesComeBackExceptBothRoofs) {
  for (unsigned first = 0; first < kAll; ++first)
    for (unsigned second = first + 1; second < kAll; ++second) {
      if (first == kRoofSouth) continue;
      SCOPED_TRACE(::testing::Message() << first << " and " << second);
      const auto shell =
          rebuild(house({static_cast<HousePart>(first), static_cast<HousePart>(second)}).done());
      // Half a house is told from a missing half by its ground.
      if (first == kGround && second >= kRoofSouth) continue;
      ASSERT_TRUE(shell);
      EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-3);
    }
}

TEST(Rebuild25d, WallsAloneAreNoBuilding) {
  Draw draw;
  draw.walls(rectangle(0, 0, 10, 8), 6);
  EXPECT_FALSE(rebuild(draw.done()));
}

TEST(Rebuild25d, AnInnerWallGoes) {
  Draw draw = house();
  draw.wall({5, 0, 0}, {5, 8, 0}, 6);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->faces.size(), 7u);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
}

TEST(Rebuild25d, FacesThatLookTheWrongWayDoNotMatter) {
  for (std::size_t turned = 0; turned < kAll; ++turned) {
    Building building = house().done();
    auto& ring = building.geometries[0].polygons[turned].rings[0];
    std::reverse(ring.begin(), ring.end());
    const auto shell = rebuild(building);
    ASSERT_TRUE(shell) << turned;
    EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
  }
}

TEST(Rebuild25d, UntypedFacesThatAllLookInwardsAreTold) {
  Building building = house().done();
  for (Polygon& polygon : building.geometries[0].polygons) {
    polygon.surface = -1;
    std::reverse(polygon.rings[0].begin(), polygon.rings[0].end());
  }
  const auto shell = rebuild(building);
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
}

TEST(Rebuild25d, RepeatedFacesBecomeOne) {
  Building building = house().done();
  auto& polygons = building.geometries[0].polygons;
  const auto copies = polygons;
  polygons.insert(polygons.end(), copies.begin(), copies.end());
  const auto shell = rebuild(building);
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->faces.size(), 7u);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
}

TEST(Rebuild25d, ABowTieRoofIsReplacedByItsNeighboursHeights) {
  Building building = house().done();
  auto& ring = building.geometries[0].polygons[kRoofSouth].rings[0];
  std::swap(ring[1], ring[2]);
  const auto shell = rebuild(building);
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 0.005 * kHouse_m3);
}

TEST(Rebuild25d, ABowTieWallDoesNotMatter) {
  Building building = house({kGround}).done();
  auto& ring = building.geometries[0].polygons[0].rings[0];
  std::swap(ring[1], ring[2]);
  const auto shell = rebuild(building);
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-3);
}

TEST(Rebuild25d, UnsnappedCornersMeet) {
  Building building = house().done();
  building.geometries[0].points[14].x += 0.0004;
  building.geometries[0].points[9].z -= 0.0006;
  const auto shell = rebuild(building);
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 0.01);
}

TEST(Rebuild25d, AStepBetweenFlatRoofsGetsItsWall) {
  Draw draw;
  draw.ground(rectangle(0, 0, 20, 8));
  draw.flat_roof(rectangle(0, 0, 10, 8), 6).flat_roof(rectangle(10, 2, 20, 8), 9);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  // The strip of ground without a roof is closed at the height of what is around it.
  EXPECT_GT(gated_volume_m3(*shell), 10 * 8 * 6 + 10 * 6 * 9 - 1e-6);
}

TEST(Rebuild25d, RoofsThatCrossOverTheSameEdgeGetTwoWalls) {
  // Two sheds side by side that rise in opposite directions.
  Draw draw;
  draw.ground(rectangle(0, 0, 20, 10));
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 4}, {10, 0, 4}, {10, 10, 8}, {0, 10, 8}}});
  draw.face(SurfaceType::RoofSurface, {{{10, 0, 8}, {20, 0, 8}, {20, 10, 4}, {10, 10, 4}}});
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 2 * 10 * 10 * 6, 1e-6);
  EXPECT_EQ(count(*shell, SurfaceType::WallSurface, true), 6u);
}

TEST(Rebuild25d, OfRoofsThroughEachOtherTheUpperRemains) {
  // A ridge dormer runs into the roof plane behind it.
  Draw draw = house();
  draw.face(SurfaceType::RoofSurface, {{{4, 1, 7.5}, {6, 1, 7.5}, {6, 4, 7.5}, {4, 4, 7.5}}});
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  // The roof reaches 7.5 m at y = 2: a wedge of 2 m by 1 m by 0.75 m stands out.
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3 + 2 * 1 * 0.75 / 2, 1e-3);
}

TEST(Rebuild25d, ABalconyWithoutGroundStaysInTheAir) {
  Draw draw;
  const auto base = rectangle(0, 0, 10, 8);
  draw.ground(base).flat_roof(base, 9).walls(base, 9);
  auto underside = rectangle(3, -2, 6, 0, 3);
  std::reverse(underside.begin(), underside.end());
  draw.face(SurfaceType::OuterCeilingSurface, {underside});
  draw.flat_roof(rectangle(3, -2, 6, 0), 4);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 720 + 6, 1e-6);
}

TEST(Rebuild25d, ATerracedGroundKeepsItsSteps) {
  Draw draw;
  draw.ground(rectangle(0, 0, 5, 8, 0)).ground(rectangle(5, 0, 10, 8, 2));
  draw.flat_roof(rectangle(0, 0, 10, 8), 6);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 5 * 8 * 6 + 5 * 8 * 4, 1e-6);
}

TEST(Rebuild25d, ColumnsThatMeetInALineAreCutApart) {
  Draw draw;
  draw.ground(rectangle(0, 0, 5, 5)).ground(rectangle(5, 5, 10, 10));
  draw.flat_roof(rectangle(0, 0, 5, 5), 6).flat_roof(rectangle(5, 5, 10, 10), 6);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 300, 0.01);
}

TEST(Rebuild25d, ATableIsNoRoofOnWalls) {
  // A passage through the house, with its own floor: air between faces above each other.
  Draw draw;
  draw.ground(rectangle(0, 0, 10, 8)).flat_roof(rectangle(0, 0, 10, 8), 9);
  auto ceiling = rectangle(3, 0, 6, 8, 4);
  std::reverse(ceiling.begin(), ceiling.end());
  draw.face(SurfaceType::OuterCeilingSurface, {ceiling});
  EXPECT_FALSE(rebuild(draw.done()));
}

TEST(Rebuild25d, WhatWouldBeLostIsRefused) {
  Draw draw = house();
  draw.walls(rectangle(12, 0, 15, 8), 6);  // encloses something, but has neither roof nor ground
  EXPECT_FALSE(rebuild(draw.done()));
}

TEST(Rebuild25d, AWallThatEnclosesNothingIsNoLoss) {
  Draw draw = house();
  draw.wall({12, 0, 0}, {12, 8, 0}, 6);
  const auto shell = rebuild(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), kHouse_m3, 1e-9);
}

TEST(Rebuild25d, MovingTheModelChangesNothing) {
  Building building = house({kGround, kWest}).done();
  const auto here = rebuild(building);
  for (Point3& p : building.geometries[0].points) p = {p.x + 9000, p.y - 7000, p.z + 400};
  const auto there = rebuild(building);
  ASSERT_TRUE(here && there);
  ASSERT_EQ(here->points.size(), there->points.size());
  for (std::size_t i = 0; i < here->points.size(); ++i) {
    EXPECT_EQ(there->points[i].x - here->points[i].x, 90000000);
    EXPECT_EQ(there->points[i].y - here->points[i].y, -70000000);
    EXPECT_EQ(there->points[i].z - here->points[i].z, 4000000);
  }
}

TEST(Rebuild25d, PointsAndLinesAreNoBuilding) {
  Draw draw;
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}});
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 0}}});
  EXPECT_FALSE(rebuild(draw.done()));
}

}  // namespace
}  // namespace citymesh
