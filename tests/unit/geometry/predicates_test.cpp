#include "core/geometry/predicates.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

using Corners = std::array<GridPoint, 3>;
const Corners kFlat{{{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}}};

TEST(Predicates, OrientationIsExactAtTheLimitOfTheGrid) {
  constexpr std::int64_t m = kGridLimit;
  const GridPoint a{-m, -m, -m}, b{m, -m, -m}, c{-m, m, -m};
  EXPECT_EQ(orient3d(a, b, c, {m, m, -m}), 0);
  EXPECT_EQ(orient3d(a, b, c, {m, m, -m + 1}), 1);
  EXPECT_EQ(orient3d(a, b, c, {m, m, -m - 1}), -1);
  EXPECT_EQ(orient2d({-m, -m}, {m, m}, {m, m - 1}), -1);
  EXPECT_EQ(orient2d({-m, -m}, {m, m}, {0, 0}), 0);
}

TEST(Predicates, SegmentsMeetWhenTheyCrossTouchOrOverlap) {
  EXPECT_TRUE(segments_meet({0, 0}, {10, 10}, {0, 10}, {10, 0}));
  EXPECT_TRUE(segments_meet({0, 0}, {10, 0}, {5, 0}, {5, 9}));
  EXPECT_TRUE(segments_meet({0, 0}, {10, 0}, {5, 0}, {15, 0}));
  EXPECT_FALSE(segments_meet({0, 0}, {10, 0}, {11, 0}, {15, 0}));
  EXPECT_FALSE(segments_meet({0, 0}, {10, 0}, {5, 1}, {5, 9}));
}

TEST(Predicates, TrianglesWithoutCommonCornersClashWhenTheyTouch) {
  EXPECT_TRUE(triangles_clash(kFlat, {{{100, 100, -50}, {100, 100, 50}, {300, 300, 50}}}));
  EXPECT_TRUE(triangles_clash(kFlat, {{{100, 100, 0}, {100, 100, 50}, {300, 300, 50}}}));
  EXPECT_FALSE(triangles_clash(kFlat, {{{100, 100, 1}, {100, 100, 50}, {300, 300, 50}}}));
}

TEST(Predicates, ATriangleInsideAnotherInOnePlaneClashes) {
  EXPECT_TRUE(triangles_clash(kFlat, {{{100, 100, 0}, {200, 100, 0}, {100, 200, 0}}}));
}

TEST(Predicates, NeighboursAcrossAnEdgeDoNotClash) {
  EXPECT_FALSE(triangles_clash(kFlat, {{{1000, 0, 0}, {0, 0, 0}, {500, -1000, 0}}}));
  EXPECT_FALSE(triangles_clash(kFlat, {{{1000, 0, 0}, {0, 0, 0}, {500, 1000, 1}}}));
}

TEST(Predicates, NeighboursFoldedFlatOntoEachOtherClash) {
  EXPECT_TRUE(triangles_clash(kFlat, {{{1000, 0, 0}, {0, 0, 0}, {500, 10, 0}}}));
}

TEST(Predicates, TrianglesThatMeetInACornerOnlyDoNotClash) {
  EXPECT_FALSE(triangles_clash(kFlat, {{{0, 0, 0}, {-1000, 0, 0}, {0, -1000, 0}}}));
  EXPECT_FALSE(triangles_clash(kFlat, {{{0, 0, 0}, {100, 100, 500}, {200, 100, 500}}}));
}

TEST(Predicates, TrianglesThatMeetInACornerAndElsewhereClash) {
  // The edge opposite the common corner passes through the other triangle.
  EXPECT_TRUE(triangles_clash(kFlat, {{{0, 0, 0}, {300, 300, 100}, {300, 300, -100}}}));
  // Same plane, overlapping cones.
  EXPECT_TRUE(triangles_clash(kFlat, {{{0, 0, 0}, {2000, 100, 0}, {2000, 500, 0}}}));
  // The other's edge runs along ours.
  EXPECT_TRUE(triangles_clash(kFlat, {{{0, 0, 0}, {500, 0, 0}, {0, 0, 700}}}));
}

}  // namespace
}  // namespace citymesh
