#include "core/geometry/triangulation.h"

#include <gtest/gtest.h>

#include "core/geometry/measure.h"

namespace citymesh {
namespace {

using Rings = std::vector<std::vector<std::uint32_t>>;

TEST(Triangulation, ASquareGivesTwoTrianglesWithItsOrientation) {
  const std::vector<GridPoint> points{{0, 0, 5}, {100, 0, 5}, {100, 100, 5}, {0, 100, 5}};
  const auto up = triangulate(points, Rings{{0, 1, 2, 3}});
  ASSERT_TRUE(up);
  ASSERT_EQ(up->size(), 2u);
  for (const Triangle& t : *up) EXPECT_GT(normal_of(points[t[0]], points[t[1]], points[t[2]]).z, 0);
  const auto down = triangulate(points, Rings{{3, 2, 1, 0}});
  ASSERT_TRUE(down);
  for (const Triangle& t : *down)
    EXPECT_LT(normal_of(points[t[0]], points[t[1]], points[t[2]]).z, 0);
}

TEST(Triangulation, AHoleStaysOpenHoweverItIsOriented) {
  const std::vector<GridPoint> points{{0, 0, 0},     {900, 0, 0},   {900, 900, 0}, {0, 900, 0},
                                      {300, 300, 0}, {600, 300, 0}, {600, 600, 0}, {300, 600, 0}};
  for (const Rings& rings :
       {Rings{{0, 1, 2, 3}, {4, 5, 6, 7}}, Rings{{0, 1, 2, 3}, {7, 6, 5, 4}}}) {
    const auto triangles = triangulate(points, rings);
    ASSERT_TRUE(triangles);
    EXPECT_EQ(triangles->size(), 8u);
    EXPECT_DOUBLE_EQ(area_m2(points, *triangles), (0.09 * 0.09) - (0.03 * 0.03));
  }
}

TEST(Triangulation, AVertexOnAnEdgeGetsNoFlatTriangle) {
  const std::vector<GridPoint> points{
      {0, 0, 0}, {50, 0, 0}, {100, 0, 0}, {100, 900, 0}, {0, 900, 0}};
  const auto triangles = triangulate(points, Rings{{0, 1, 2, 3, 4}});
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 3u);
  for (const Triangle& t : *triangles)
    EXPECT_NE(area2(project(points[t[0]], Axis::Z), project(points[t[1]], Axis::Z),
                    project(points[t[2]], Axis::Z)),
              Int128{0});
}

TEST(Triangulation, AlmostCollinearCornersOfAQuadrilateralAreCutApart) {
  // Corner 1 sticks out by 0.1 mm: the cut must go through it, though the other diagonal is
  // shorter.
  const std::vector<GridPoint> points{{0, 0, 0}, {5000, -1, 0}, {10000, 0, 0}, {5000, 90000, 0}};
  const auto triangles = triangulate(points, Rings{{0, 1, 2, 3}});
  ASSERT_TRUE(triangles);
  for (const Triangle& t : *triangles) EXPECT_GT(area_m2(points, std::span(&t, 1)), 1.0);
}

TEST(Triangulation, VerticalFacesAreSeenFromTheSide) {
  const std::vector<GridPoint> points{
      {0, 0, 0}, {0, 100, 0}, {0, 100, 100}, {0, 50, 150}, {0, 0, 100}};
  const auto triangles = triangulate(points, Rings{{0, 1, 2, 3, 4}});
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 3u);
  for (const Triangle& t : *triangles)
    EXPECT_GT(normal_of(points[t[0]], points[t[1]], points[t[2]]).x, 0);
}

TEST(Triangulation, ABowTieIsRefused) {
  const std::vector<GridPoint> points{{0, 0, 0}, {100, 100, 0}, {100, 0, 0}, {0, 90, 0}};
  EXPECT_FALSE(triangulate(points, Rings{{0, 1, 2, 3}}));
}

TEST(Triangulation, AHoleThatCrossesItsExteriorIsRefused) {
  const std::vector<GridPoint> points{{0, 0, 0},   {90, 0, 0},   {90, 90, 0}, {0, 90, 0},
                                      {30, 30, 0}, {120, 30, 0}, {60, 60, 0}};
  EXPECT_FALSE(triangulate(points, Rings{{0, 1, 2, 3}, {4, 5, 6}}));
}

TEST(Triangulation, AHoleJoinedByABridgeEdgeStaysOpen) {
  const std::vector<GridPoint> points{{0, 0, 0},     {900, 0, 0},   {900, 900, 0}, {0, 900, 0},
                                      {300, 300, 0}, {300, 600, 0}, {600, 600, 0}, {600, 300, 0}};
  const auto triangles = triangulate(points, Rings{{0, 1, 2, 3, 0, 4, 5, 6, 7, 4}});
  ASSERT_TRUE(triangles);
  EXPECT_DOUBLE_EQ(area_m2(points, *triangles), (0.09 * 0.09) - (0.03 * 0.03));
}

TEST(Triangulation, DegenerateRingsAreRefused) {
  const std::vector<GridPoint> points{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {10, 0, 0}};
  EXPECT_FALSE(triangulate(points, Rings{{0, 1}}));
  EXPECT_FALSE(triangulate(points, Rings{{0, 1, 2}}));
  EXPECT_FALSE(triangulate(points, Rings{}));
}

}  // namespace
}  // namespace citymesh
