#include "core/heal/heal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/gates/gates.h"
#include "core/mesh/mesh.h"
#include "core/validate/validate.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::block;
using ::testing::Contains;
using testing::Draw;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using testing::rectangle;

const std::vector<Lod> kLod{{2, -1}, {3, -1}, {1, -1}, {0, -1}};

std::vector<Issue> delivery_gate(const Shell& shell) {
  const Meshed meshed = mesh(shell);
  if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
  const auto& triangles = std::get<TriangleMesh>(meshed);
  std::vector<Issue> issues;
  for (const GateFailure& f : check_shell(triangles.points, triangles.triangles, {}))
    issues.push_back({0, std::string(f.gate) + " " + f.where, 0});
  return issues;
}

Healed heal(const Building& building, const HealOptions& options = {}) {
  return heal(building, kLod, options, delivery_gate, RunContext{});
}

double volume_m3(const Healed& healed) {
  const auto triangles = std::get<TriangleMesh>(mesh(healed.shell));
  return volume_m3(triangles.points, triangles.triangles);
}

std::size_t count(const Healed& healed, SurfaceType type) {
  return static_cast<std::size_t>(std::count_if(healed.shell.faces.begin(),
                                                healed.shell.faces.end(),
                                                [&](const Face& f) { return f.type == type; }));
}

TEST(Heal, AValidBlockGoesOutAsItIs) {
  const auto healed = heal(block(0, 0, 10, 8, 6).done());
  EXPECT_EQ(healed.rung, "as_is");
  EXPECT_EQ(healed.lane, "2.5d");
  EXPECT_THAT(healed.issues, IsEmpty());
  EXPECT_THAT(healed.repairs, IsEmpty());
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
  ASSERT_TRUE(healed.volume_before_m3);
  EXPECT_DOUBLE_EQ(*healed.volume_before_m3, 480);
  EXPECT_EQ(healed.max_displacement_m, 0);
}

TEST(Heal, ClosesAMissingGround) {
  Draw draw;
  draw.walls(rectangle(0, 0, 10, 8), 6).flat_roof(rectangle(0, 0, 10, 8), 6);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_EQ(count(healed, SurfaceType::GroundSurface), 1u);
  EXPECT_THAT(healed.issues, Contains(Field(&Issue::code, 302)));
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "hole_closed")));
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
  EXPECT_FALSE(healed.volume_before_m3);
}

TEST(Heal, AMissingGroundAroundACourtyardIsOneFaceWithAHole) {
  Draw draw;
  auto court = rectangle(4, 4, 6, 6);
  std::reverse(court.begin(), court.end());
  draw.walls(rectangle(0, 0, 10, 10), 6).walls(court, 6);
  auto roof = rectangle(0, 0, 10, 10, 6), hole = rectangle(4, 4, 6, 6, 6);
  std::reverse(hole.begin(), hole.end());
  draw.face(SurfaceType::RoofSurface, {roof, hole});
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_DOUBLE_EQ(volume_m3(healed), (100 - 4) * 6);
  ASSERT_EQ(count(healed, SurfaceType::GroundSurface), 1u);
  EXPECT_EQ(healed.shell.faces.back().rings.size(), 2u);
}

TEST(Heal, ClosesTwoMissingPartyWallsThatMeetInACorner) {
  const auto base = rectangle(0, 0, 10, 8);
  Draw draw;
  draw.ground(base).flat_roof(base, 6).wall(base[0], base[1], 6).wall(base[1], base[2], 6);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_EQ(count(healed, SurfaceType::ClosureSurface), 2u);
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, TurnsFacesThatLookTheWrongWay) {
  auto building = block(0, 0, 10, 8, 6).done();
  for (const std::size_t i : {0u, 2u})
    std::reverse(building.geometries[0].polygons[i].rings[0].begin(),
                 building.geometries[0].polygons[i].rings[0].end());
  const auto healed = heal(building);
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.issues, Contains(Field(&Issue::code, 307)));
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "turned")));
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, TurnsAShellThatIsInsideOut) {
  auto building = block(0, 0, 10, 8, 6).done();
  for (Polygon& polygon : building.geometries[0].polygons)
    std::reverse(polygon.rings[0].begin(), polygon.rings[0].end());
  const auto healed = heal(building);
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, PutsAVertexIntoTheEdgeItLiesOn) {
  const auto base = rectangle(0, 0, 10, 8);
  Draw draw;
  draw.ground(base).flat_roof(base, 6);
  draw.wall(base[0], {5, 0, 0}, 6)
      .wall({5, 0, 0}, base[1], 6);  // ground and roof know no corner there
  draw.wall(base[1], base[2], 6).wall(base[2], base[3], 6).wall(base[3], base[0], 6);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "t_junction")));
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, SnapsPointsAndSaysHowFarTheyMoved) {
  auto building = block(0, 0, 10, 8, 6).done();
  building.geometries[0].points[0].x += 0.0007;
  const auto healed = heal(building);
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_GT(healed.max_displacement_m, 0.0006);
  EXPECT_LT(healed.max_displacement_m, 0.001);
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "snapped")));
}

TEST(Heal, KeepsWithinTheLimitOfDisplacement) {
  auto building = block(0, 0, 10, 8, 6).done();
  building.geometries[0].points[0].x += 0.03;
  for (const double limit_m : {0.1, 0.02, 0.002}) {
    HealOptions options;
    options.max_displacement_m = limit_m;
    const auto healed = heal(building, options);
    if (healed.rung == "healed") {
      EXPECT_LE(healed.max_displacement_m, limit_m);
    }
    EXPECT_NEAR(volume_m3(healed), 480, 1) << limit_m;
  }
}

TEST(Heal, DropsAFaceGivenTwice) {
  auto draw = block(0, 0, 10, 8, 6);
  draw.flat_roof(rectangle(0, 0, 10, 8), 6);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "duplicate_face_dropped")));
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, DropsTheInnerWallOfTwoBlocks) {
  const auto west = rectangle(0, 0, 5, 8), east = rectangle(5, 0, 10, 8);
  Draw draw;
  draw.ground(west).walls(west, 6).flat_roof(west, 6).ground(east).walls(east, 6).flat_roof(east,
                                                                                            6);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "inner_face_dropped")));
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, ATowerThatStandsInACornerOfItsPodiumBecomesOneVolume) {
  // Two closed boxes side by side whose touching walls differ in height: the common part is an
  // inner wall.
  const auto podium = rectangle(0, 0, 10, 8), tower = rectangle(10, 0, 14, 8);
  Draw draw;
  draw.ground(podium).walls(podium, 4).flat_roof(podium, 4);
  draw.ground(tower).walls(tower, 4).flat_roof(tower, 4);
  // The tower goes on above: its roof at 4 m and the ground above it cancel out.
  const auto above = rectangle(10, 0, 14, 8, 4);
  draw.ground(above).walls(above, 20).flat_roof(above, 20);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_DOUBLE_EQ(volume_m3(healed), 10 * 8 * 4 + 4 * 8 * 20);
}

TEST(Heal, AnOpeningInItsWallKeepsItsType) {
  const auto base = rectangle(0, 0, 10, 8);
  Draw draw;
  draw.ground(base).flat_roof(base, 6);
  for (std::size_t i = 1; i < 4; ++i) draw.wall(base[i], base[(i + 1) % 4], 6);
  const std::vector<Point3> frame{{0, 0, 0}, {10, 0, 0}, {10, 0, 6}, {0, 0, 6}};
  const std::vector<Point3> window{{2, 0, 1}, {2, 0, 3}, {4, 0, 3}, {4, 0, 1}};
  draw.face(SurfaceType::WallSurface, {frame, window});
  draw.face(SurfaceType::Window, {{window.rbegin(), window.rend()}});
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "as_is");
  EXPECT_EQ(count(healed, SurfaceType::Window), 1u);
}

TEST(Heal, AnOpeningBehindItsWallIsClosedInTheWall) {
  const auto base = rectangle(0, 0, 10, 8);
  Draw draw;
  draw.ground(base).flat_roof(base, 6);
  for (std::size_t i = 1; i < 4; ++i) draw.wall(base[i], base[(i + 1) % 4], 6);
  const std::vector<Point3> frame{{0, 0, 0}, {10, 0, 0}, {10, 0, 6}, {0, 0, 6}};
  const std::vector<Point3> hole{{2, 0, 1}, {2, 0, 3}, {4, 0, 3}, {4, 0, 1}};
  draw.face(SurfaceType::WallSurface, {frame, hole});
  draw.face(SurfaceType::Window, {{{2, 0.2, 1}, {4, 0.2, 1}, {4, 0.2, 3}, {2, 0.2, 3}}});
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.repairs, Contains(Field(&Repair::kind, "openings_closed")));
  EXPECT_EQ(count(healed, SurfaceType::Window), 1u);
  EXPECT_DOUBLE_EQ(volume_m3(healed), 480);
}

TEST(Heal, WhatCannotBeHealedBecomesABlock) {
  // Roof corners are missing altogether and a wall cuts through the room.
  Draw draw;
  draw.ground(rectangle(0, 0, 10, 8)).walls(rectangle(0, 0, 10, 8), 4);
  draw.wall({5, -3, 0}, {5, 12, 0}, 9);
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 4}, {10, 0, 4}, {10, 4, 7}, {0, 4, 7}}});
  // A judge that takes nothing with a pitch, so that no other rung gets through.
  const DeliveryGate blocks_only = [](const Shell& shell) {
    std::vector<Issue> issues = delivery_gate(shell);
    for (const Face& face : shell.faces)
      for (const Ring& ring : face.rings)
        for (const std::uint32_t corner : ring)
          if (shell.points[corner].z != shell.points[ring[0]].z &&
              face.type == SurfaceType::RoofSurface)
            issues.push_back({306, "", 0});
    return issues;
  };
  const auto healed = citymesh::heal(draw.done(), kLod, {}, blocks_only, RunContext{});
  EXPECT_EQ(healed.rung, "lod1_block");
  EXPECT_EQ(healed.lane, "2.5d");
  EXPECT_GT(healed.deviation.max_m, 0.5);
  // 70 % of the pitched roof lies below 4 m + 0.7 * 3 m.
  EXPECT_NEAR(volume_m3(healed), 80 * 6.1, 80 * 0.2);
  HealOptions options;
  options.block_on_failure = false;
  const auto dropped = citymesh::heal(draw.done(), kLod, options, blocks_only, RunContext{});
  EXPECT_EQ(dropped.rung, "");
  EXPECT_EQ(dropped.reason, "not_healed");
}

TEST(Heal, AFootprintNeedsAHeight) {
  Draw draw;
  draw.face(SurfaceType::Unknown, {rectangle(0, 0, 10, 8, 30)});
  draw.geometry().lod = {0, -1};
  draw.geometry().footprint = true;
  EXPECT_EQ(heal(draw.done()).reason, "no_height");
  draw.building().attributes.emplace_back("measuredHeight", 7.5);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "lod1_block");
  EXPECT_DOUBLE_EQ(volume_m3(healed), 600);
}

TEST(Heal, FootprintsThatTouchInACornerBecomeSeparateBlocks) {
  Draw draw;
  draw.face(SurfaceType::GroundSurface, {rectangle(0, 0, 5, 5)});
  draw.face(SurfaceType::GroundSurface, {rectangle(5, 5, 10, 10)});
  draw.geometry().lod = {0, -1};
  draw.geometry().footprint = true;
  draw.building().attributes.emplace_back("measuredHeight", 6.0);
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "lod1_block");
  EXPECT_NEAR(volume_m3(healed), 300, 1);
}

TEST(Heal, NoGeometryIsAReasonNotAnError) {
  Building building;
  building.gml_id = "empty";
  const auto healed = heal(building);
  EXPECT_EQ(healed.rung, "");
  EXPECT_EQ(healed.reason, "no_geometry");
}

TEST(Heal, GarbageNeverThrows) {
  Draw draw;
  draw.face(SurfaceType::WallSurface, {{{0, 0, 0}}});
  draw.face(SurfaceType::WallSurface, {{}});
  draw.face(SurfaceType::RoofSurface, {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}});
  draw.face(SurfaceType::RoofSurface, {{{1e300, 1, 1}, {2, 1, 1}, {1, 5, 1}}});
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "");
  EXPECT_FALSE(healed.reason.empty());
}

TEST(Heal, TakesTheFirstLevelOfTheList) {
  auto building = block(0, 0, 10, 8, 6).done();
  building.geometries.push_back(block(0, 0, 10, 8, 3).done().geometries[0]);
  building.geometries[1].lod = {1, -1};
  building.geometries[1].polygons = building.geometries[0].polygons;
  EXPECT_EQ(to_string(heal(building).lod), "2");
  const std::vector<Lod> one{{1, -1}};
  EXPECT_EQ(to_string(heal(building, one, {}, delivery_gate, RunContext{}).lod), "1");
}

TEST(Heal, HealingWhatWasHealedChangesNothing) {
  Draw draw;
  draw.walls(rectangle(0, 0, 10, 8), 6).flat_roof(rectangle(0, 0, 10, 8), 6);
  const auto healed = heal(draw.done());
  Draw again;
  for (const Face& face : healed.shell.faces) {
    std::vector<std::vector<Point3>> rings;
    for (const Ring& ring : face.rings) {
      rings.emplace_back();
      for (const std::uint32_t corner : ring)
        rings.back().push_back(to_metres(healed.shell.points[corner]));
    }
    again.face(face.type, rings);
  }
  const auto twice = heal(again.done());
  EXPECT_EQ(twice.rung, "as_is");
  EXPECT_DOUBLE_EQ(volume_m3(twice), volume_m3(healed));
}

TEST(Heal, APolygonThatIsNotPlaneGoesOutInPlanePieces) {
  // A roof with one corner 4 cm below the plane of the others: closed, but val3dity's 203.
  Draw draw;
  auto roof = rectangle(0, 0, 10, 8, 6);
  roof[2].z -= 0.04;
  auto ground = rectangle(0, 0, 10, 8);
  std::reverse(ground.begin(), ground.end());
  draw.face(SurfaceType::RoofSurface, {roof}).face(SurfaceType::GroundSurface, {ground});
  const auto base = rectangle(0, 0, 10, 8);
  for (std::size_t i = 0; i < 4; ++i)
    draw.face(SurfaceType::WallSurface, {{base[i], base[(i + 1) % 4], roof[(i + 1) % 4], roof[i]}});
  const auto healed = heal(draw.done());
  EXPECT_EQ(healed.rung, "healed");
  EXPECT_THAT(healed.issues, Contains(Field(&Issue::code, 203)));
  EXPECT_THAT(healed.repairs, ElementsAre(Field(&Repair::kind, "face_split")));
  EXPECT_EQ(count(healed, SurfaceType::RoofSurface), 2u);
  EXPECT_EQ(count(healed, SurfaceType::WallSurface), 4u);
  EXPECT_EQ(healed.deviation.max_m, 0);
  EXPECT_THAT(validate(healed.shell, ValidateOptions{}), IsEmpty());
}

TEST(Heal, SolidsThatDoNotTouchComeOneAfterTheOther) {
  const Building one = block(0, 0, 4, 4, 3).done(), other = block(10, 0, 14, 4, 3).done();
  Building both = one;
  Geometry& geometry = both.geometries[0];
  const Geometry& more = other.geometries[0];
  const auto first = static_cast<std::uint32_t>(geometry.points.size());
  geometry.points.insert(geometry.points.end(), more.points.begin(), more.points.end());
  const std::vector<Polygon> polygons = std::exchange(geometry.polygons, {});
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    geometry.polygons.push_back(polygons[i]);
    geometry.polygons.push_back(more.polygons[i]);
    for (Ring& ring : geometry.polygons.back().rings)
      for (std::uint32_t& corner : ring) corner += first;
  }
  for (Solid& solid : geometry.solids) {
    solid.exterior.resize(geometry.polygons.size());
    std::iota(solid.exterior.begin(), solid.exterior.end(), 0u);
  }
  const auto healed = heal(both);
  ASSERT_EQ(healed.shell.faces.size(), 12u);
  for (std::size_t f = 0; f < 12; ++f) {
    const bool east = to_metres(healed.shell.points[healed.shell.faces[f].rings[0][0]]).x > 5;
    EXPECT_EQ(east, f >= 6) << "face " << f;
  }
}

}  // namespace
}  // namespace citymesh
