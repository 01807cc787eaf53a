#include "core/heal/steps.h"

#include <gtest/gtest.h>
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

Shell shell_of(std::vector<GridPoint> points, std::vector<std::vector<Ring>> faces) {
  Shell shell;
  shell.points = std::move(points);
  shell.surface_ids.emplace_back();
  for (auto& rings : faces) {
    shell.faces.push_back({});
    shell.faces.back().rings = std::move(rings);
  }
  return shell;
}

TEST(CleanRings, TakesOutRepeatedCornersAndSpikes) {
  auto shell = shell_of({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {20, 0, 0}},
                        {{{0, 0, 1, 4, 1, 2, 3, 3}}});
  StepContext context;
  clean_rings(shell, context);
  ASSERT_EQ(shell.faces.size(), 1u);
  EXPECT_EQ(shell.faces[0].rings[0], (Ring{0, 1, 2, 3}));
}

TEST(CleanRings, SplitsARingThatTouchesItselfInACorner) {
  // A figure of eight whose loops run the same way.
  auto shell =
      shell_of({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {18, 9, 0}, {18, 18, 0}, {0, 9, 0}, {9, 18, 0}},
               {{{0, 1, 2, 3, 4, 6, 2, 5}}});
  StepContext context;
  clean_rings(shell, context);
  ASSERT_EQ(shell.faces.size(), 2u);
}

TEST(CleanRings, ALoopThatRunsBackwardsIsAHole) {
  auto shell = shell_of({{0, 0, 0}, {90, 0, 0}, {90, 90, 0}, {0, 90, 0}, {30, 20, 0}, {20, 30, 0}},
                        {{{0, 5, 4, 0, 1, 2, 3}}});
  StepContext context;
  clean_rings(shell, context);
  ASSERT_EQ(shell.faces.size(), 1u);
  EXPECT_EQ(shell.faces[0].rings.size(), 2u);
}

TEST(CleanRings, DropsFacesWithoutAnExterior) {
  auto shell = shell_of({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}}, {{{0, 1}}, {{0, 1, 2}}, {{}}});
  StepContext context;
  clean_rings(shell, context);
  EXPECT_EQ(shell.faces.size(), 1u);
}

TEST(SnapPoints, TheResultDoesNotDependOnTheOrderOfFaces) {
  const std::vector<GridPoint> points{{0, 0, 0}, {5, 0, 0}, {9000, 0, 0}, {9000, 9000, 0}};
  auto a = shell_of(points, {{{0, 2, 3}}, {{1, 2, 3}}});
  auto b = shell_of({points[1], points[0], points[2], points[3]}, {{{0, 2, 3}}, {{1, 2, 3}}});
  StepContext context;
  snap_points(a, context);
  snap_points(b, context);
  EXPECT_EQ(a.points[a.faces[0].rings[0][0]], b.points[b.faces[0].rings[0][0]]);
  EXPECT_EQ(a.points[a.faces[0].rings[0][0]], (GridPoint{0, 0, 0}));
  EXPECT_EQ(a.faces[0].rings[0][0], a.faces[1].rings[0][0]);
}

TEST(InsertJunctions, OrdersSeveralVerticesAlongAnEdge) {
  auto shell = shell_of(
      {{0, 0, 0}, {9000, 0, 0}, {0, 9000, 0}, {6000, 5, 0}, {3000, 0, 0}, {4000, -9000, 0}},
      {{{0, 1, 2}}, {{4, 3, 5}}});
  StepContext context;
  insert_junctions(shell, context);
  EXPECT_EQ(shell.faces[0].rings[0], (Ring{0, 4, 3, 1, 2}));
  EXPECT_EQ(context.repairs.size(), 2u);
  EXPECT_NEAR(context.max_displacement_m, 0.0005, 1e-9);
}

TEST(Blocks, ThePercentileIsOfRoofArea) {
  // 60 % of the roof at 3 m, 40 % at 9 m: the 70th percentile lies on the upper one.
  auto shell = shell_of({{0, 0, 0},
                         {100000, 0, 0},
                         {100000, 100000, 0},
                         {0, 100000, 0},
                         {0, 0, 30000},
                         {60000, 0, 30000},
                         {60000, 100000, 30000},
                         {0, 100000, 30000},
                         {60000, 0, 90000},
                         {100000, 0, 90000},
                         {100000, 100000, 90000},
                         {60000, 100000, 90000}},
                        {{{3, 2, 1, 0}}, {{4, 5, 6, 7}}, {{8, 9, 10, 11}}});
  shell.faces[0].type = SurfaceType::GroundSurface;
  shell.faces[1].type = shell.faces[2].type = SurfaceType::RoofSurface;
  Shell block;
  EXPECT_EQ(lod1_block(shell, false, {}, [&](Shell& offered) { return block = offered, true; }),
            "");
  ASSERT_FALSE(block.points.empty());
  EXPECT_EQ(block.points.back().z, 90000);
}

TEST(DropInnerSheets, AWallThroughABoxGoesWhetherItSharesCornersOrNot) {
  // A box without its lid is open, but no sheet: it stays.
  const std::vector<GridPoint> points{{0, 0, 0},
                                      {90000, 0, 0},
                                      {90000, 90000, 0},
                                      {0, 90000, 0},
                                      {0, 0, 90000},
                                      {90000, 0, 90000},
                                      {90000, 90000, 90000},
                                      {0, 90000, 90000},
                                      {10000, 10000, 10000},
                                      {10000, 80000, 10000},
                                      {10000, 80000, 80000},
                                      {10000, 10000, 80000}};
  auto shell = shell_of(points, {{{3, 2, 1, 0}},
                                 {{0, 1, 5, 4}},
                                 {{1, 2, 6, 5}},
                                 {{2, 3, 7, 6}},
                                 {{3, 0, 4, 7}},
                                 {{8, 9, 10, 11}},  // hangs free
                                 {{0, 2, 6, 4}}});  // ends in edges of three
  StepContext context;
  drop_inner_sheets(shell, context);
  EXPECT_EQ(shell.faces.size(), 5u);
  EXPECT_EQ(context.repairs.size(), 2u);
}

TEST(GroupSolids, AHollowThatLooksInwardsBecomesACavityOfItsHost) {
  Shell shell;
  shell.surface_ids = {""};
  const auto add = [&](const testing::Triangles& triangles) {
    const auto first = static_cast<std::uint32_t>(shell.points.size());
    shell.points.insert(shell.points.end(), triangles.points.begin(), triangles.points.end());
    for (const Triangle& t : triangles.triangles) {
      Face& face = shell.faces.emplace_back();
      face.rings = {{t[0] + first, t[1] + first, t[2] + first}};
    }
  };
  add(testing::box({20'000, 20'000, 20'000}, {30'000, 30'000, 30'000}).turn());  // the hollow
  add(testing::box({0, 0, 0}, {100'000, 100'000, 100'000}));
  add(testing::box({200'000, 0, 0}, {300'000, 100'000, 100'000}));
  group_solids(shell);
  ASSERT_EQ(shell.faces.size(), 36u);
  for (std::size_t f = 0; f < 36; ++f) {
    EXPECT_EQ(shell.faces[f].cavity, f >= 12 && f < 24) << f;
    EXPECT_EQ(shell.faces[f].rings[0][0] < 8u, f >= 12 && f < 24) << f;
  }
}

}  // namespace
}  // namespace citymesh
