#include "core/reconstruct/push_out.h"

#include <gtest/gtest.h>

#include "core/validate/body.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::box;
using testing::Triangles;

constexpr double kReach_m = 0.05;

TriangleView view(const Triangles& t) { return {t.points, t.triangles}; }

bool overlap(const Triangles& a, const Triangles& b) {
  const auto closed = [](const Triangles& t) {
    ClosedSurface surface{t.points, t.triangles, GridBox::of(t.points[0])};
    for (const GridPoint& p : t.points) surface.box.add(p);
    return surface;
  };
  return interiors_overlap(closed(a), closed(b)) != Answer::No;
}

Triangles house() { return box({0, 0, 0}, {100'000, 100'000, 60'000}); }

TEST(PushOut, AWallThatReachesIntoItsNeighbourByMillimetresIsMovedInFrontOfIt) {
  // Its wall starts 3 mm inside, and turns out of the house.
  Triangles annex = box({99'970, 20'000, 0}, {140'000, 60'000, 40'000});
  for (GridPoint& p : annex.points)
    if (p.x == 99'970 && p.y == 60'000) p.x = 100'005;
  ASSERT_TRUE(overlap(house(), annex));
  const auto pushed = push_out(view(annex), view(house()), kReach_m, 2);
  ASSERT_TRUE(pushed);
  EXPECT_NEAR(pushed->displacement_m, 0.0032, 1e-9);
  EXPECT_EQ(pushed->at.x, 99'970);
  annex.points = pushed->points;
  EXPECT_FALSE(overlap(house(), annex));
  for (const GridPoint& p : annex.points) EXPECT_LE(p.x == 100'005 ? 0 : 100'002, p.x);
}

TEST(PushOut, AnEdgeWhoseEndsAreOutsideMovesAsAWhole) {
  // Taller and deeper than the house: only the middle of its edges is inside.
  Triangles tower = box({99'980, 20'000, -10'000}, {140'000, 60'000, 200'000});
  ASSERT_TRUE(overlap(house(), tower));
  const auto pushed = push_out(view(tower), view(house()), kReach_m, 2);
  ASSERT_TRUE(pushed);
  tower.points = pushed->points;
  EXPECT_FALSE(overlap(house(), tower));
}

TEST(PushOut, LessThanAStepIsSeenToo) {
  // The wall runs half a step inside of the slanted one.
  Triangles slanted = house();
  slanted.points[7].x += 1;
  slanted.points[3].x += 1;
  Triangles annex = box({100'000, 40'000, 0}, {140'000, 60'000, 40'000});
  ASSERT_TRUE(overlap(slanted, annex));
  const auto pushed = push_out(view(annex), view(slanted), kReach_m, 2);
  ASSERT_TRUE(pushed);
  annex.points = pushed->points;
  EXPECT_FALSE(overlap(slanted, annex));
}

TEST(PushOut, WhatReachesDeeperIsNoSliver) {
  const Triangles annex = box({90'000, 20'000, 0}, {140'000, 60'000, 40'000});
  EXPECT_FALSE(push_out(view(annex), view(house()), kReach_m, 2));
}

TEST(PushOut, NothingMovesWhereNothingIsInside) {
  const Triangles beside = box({100'000, 0, 0}, {140'000, 60'000, 40'000});
  EXPECT_FALSE(push_out(view(beside), view(house()), kReach_m, 2));
  EXPECT_FALSE(push_out(view(house()), view(beside), kReach_m, 2));
}

}  // namespace
}  // namespace citymesh
