#include "core/geometry/overlay.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

Area square(std::int64_t x, std::int64_t y, std::int64_t size) {
  return {{{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}}, {}};
}

TEST(Overlay, UnionOfOverlappingSquaresCountsTheOverlapOnce) {
  const auto united = unite(std::vector{square(0, 0, 100), square(50, 50, 100)});
  ASSERT_TRUE(united);
  ASSERT_EQ(united->size(), 1u);
  EXPECT_EQ(area2((*united)[0]), Int128{2 * (10000 + 10000 - 2500)});
}

TEST(Overlay, SquaresThatShareAnEdgeBecomeOne) {
  const auto united = unite(std::vector{square(0, 0, 100), square(100, 0, 100)});
  ASSERT_TRUE(united);
  ASSERT_EQ(united->size(), 1u);
  EXPECT_EQ(area2((*united)[0]), Int128{2 * 20000});
}

TEST(Overlay, ACourtyardIsAHole) {
  const auto ring = subtract(std::vector{square(0, 0, 300)}, std::vector{square(100, 100, 100)});
  ASSERT_TRUE(ring);
  ASSERT_EQ(ring->size(), 1u);
  ASSERT_EQ((*ring)[0].holes.size(), 1u);
  EXPECT_EQ(area2((*ring)[0]), Int128{2 * (90000 - 10000)});
}

TEST(Overlay, CrossingsAreRoundedToTheGrid) {
  const Area a{{{0, 0}, {7, 3}, {0, 6}}, {}}, b{{{5, 0}, {5, 7}, {1, 7}}, {}};
  const auto united = unite(std::vector{a, b});
  ASSERT_TRUE(united);
  EXPECT_FALSE(united->empty());
}

TEST(Overlay, SimplificationDropsCornersBelowTheTolerance) {
  Area area = square(0, 0, 100000);
  area.exterior.insert(area.exterior.begin() + 1, GridPoint2{50000, 30});
  const auto simpler = simplify(std::vector{area}, 0.01);
  ASSERT_TRUE(simpler);
  ASSERT_EQ(simpler->size(), 1u);
  EXPECT_EQ((*simpler)[0].exterior.size(), 4u);
}

TEST(Overlay, SmoothingClosesGapsAndTakesOffSlivers) {
  const Area sliver{{{0, 0}, {90000, 0}, {90000, 50}, {0, 50}}, {}};
  const auto closed = smooth(std::vector{square(0, 0, 100000), square(100050, 0, 100000)}, 0.01);
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->size(), 1u);
  const auto gone = smooth(std::vector{sliver}, 0.01);
  ASSERT_TRUE(gone);
  EXPECT_TRUE(gone->empty());
}

TEST(Overlay, TheConvexHullHoldsAllPoints) {
  const Area hull = convex_hull({{0, 0}, {10, 0}, {5, 5}, {10, 10}, {0, 10}, {5, 0}, {10, 10}});
  EXPECT_EQ(hull.exterior.size(), 4u);
  EXPECT_EQ(area2(hull), Int128{200});
  EXPECT_TRUE(convex_hull({{0, 0}, {5, 5}, {10, 10}}).exterior.empty());
  EXPECT_TRUE(convex_hull({}).exterior.empty());
}

}  // namespace
}  // namespace citymesh
