#include "core/reconstruct/wrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/citymodel/grid.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/geometry/triangulation.h"
#include "core/mesh/mesh.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::block;
using testing::Draw;
using testing::rectangle;

std::optional<Shell> wrapped(const Building& building) {
  return wrap(std::get<Gridded>(grid(building, building.geometries[0])).shell, {}, RunContext{});
}

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

/// Every face of the building drawn in by `gap_m`, so that no two meet.
Building loosened(Building building, double gap_m) {
  Geometry& geometry = building.geometries[0];
  for (const Polygon& polygon : geometry.polygons) {
    Point3 centre{};
    for (const std::uint32_t i : polygon.rings[0]) {
      const Point3& p = geometry.points[i];
      centre = {centre.x + p.x / 4, centre.y + p.y / 4, centre.z + p.z / 4};
    }
    for (const std::uint32_t i : polygon.rings[0]) {
      Point3& p = geometry.points[i];
      const auto inwards = [gap_m](double from, double to) {
        return std::abs(to - from) < 1e-9 ? from : from + (to > from ? gap_m : -gap_m);
      };
      p = {inwards(p.x, centre.x), inwards(p.y, centre.y), inwards(p.z, centre.z)};
    }
  }
  return building;
}

/// A block of 10 m by 8 m by 6 m.
Building loose_block(double gap_m, bool with_ground = true) {
  Building building = loosened(block(0, 0, 10, 8, 6).done(), gap_m);
  Geometry& geometry = building.geometries[0];
  if (!with_ground) geometry.polygons.erase(geometry.polygons.begin());
  return building;
}

TEST(Wrap, FacesThatMeetNowhereBecomeABody) {
  const auto shell = wrapped(loose_block(0.03));
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 480, 0.01 * 480);
}

TEST(Wrap, AMissingGroundDoesNotLetTheWrapIn) {
  const auto shell = wrapped(loose_block(0.03, false));
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 480, 0.01 * 480);
}

TEST(Wrap, CornersComeBackToThePlanesOfTheInput) {
  const auto shell = wrapped(loose_block(0.03));
  ASSERT_TRUE(shell);
  std::size_t on = 0;
  for (const GridPoint& g : shell->points) {
    const Point3 p = to_metres(g);
    const double off = std::min({std::abs(p.x), std::abs(p.x - 10), std::abs(p.y),
                                 std::abs(p.y - 8), std::abs(p.z), std::abs(p.z - 6)});
    on += off < 0.001;
  }
  EXPECT_GE(on * 10, shell->points.size() * 9);
}

TEST(Wrap, TrianglesKeepTypeAndSourceOfTheFaceTheyContinue) {
  const auto shell = wrapped(loose_block(0.03));
  ASSERT_TRUE(shell);
  for (const Face& face : shell->faces) {
    const double z =
        ring_normal(shell->points, face.rings[0]).z / (2 * kGridStepsPerMetre * kGridStepsPerMetre);
    if (z > 5) {
      EXPECT_EQ(face.type, SurfaceType::RoofSurface);
    }
    if (z < -5) {
      EXPECT_EQ(face.type, SurfaceType::GroundSurface);
    }
    if (!face.added) {
      EXPECT_NE(face.source, 0u);
    }
  }
}

TEST(Wrap, AnArchStaysOpen) {
  Draw draw;
  for (const double x : {0.0, 8.0}) {
    const auto pillar = rectangle(x, 0, x + 2, 4);
    draw.ground(pillar).walls(pillar, 5);
  }
  const auto deck = rectangle(0, 0, 10, 4, 5.02);  // lies 2 cm above its pillars
  auto underside = deck;
  std::reverse(underside.begin(), underside.end());
  draw.face(SurfaceType::OuterCeilingSurface, {underside}).walls(deck, 7).flat_roof(deck, 7);
  const auto shell = wrapped(draw.done());
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 2 * 2 * 4 * 5 + 10 * 4 * 2, 8);
}

TEST(Wrap, ASheetIsNoBody) {
  Draw flat;
  flat.face(SurfaceType::RoofSurface, {rectangle(0, 0, 10, 8, 5)});
  EXPECT_FALSE(wrapped(flat.done()));
  Draw upright;
  upright.wall({0, 0, 0}, {10, 0, 0}, 6);
  EXPECT_FALSE(wrapped(upright.done()));
}

TEST(Wrap, WhatIsBridgedIsWrappedMoreClosely) {
  Draw draw;
  for (const double x : {0.0, 1.35}) {
    const auto wing = rectangle(x, 0, x + 1, 10);
    draw.ground(wing).walls(wing, 6).flat_roof(wing, 6);
  }
  const auto shell = wrapped(loosened(draw.done(), 0.02));
  ASSERT_TRUE(shell);
  EXPECT_NEAR(gated_volume_m3(*shell), 2 * 60, 0.05 * 120);
}

TEST(Wrap, GivesTheSameEveryTime) {
  const auto one = wrapped(loose_block(0.03)), two = wrapped(loose_block(0.03));
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->points, two->points);
}

}  // namespace
}  // namespace citymesh
