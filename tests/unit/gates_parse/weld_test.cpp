#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/gates/gates.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

ParsedBody body_of(std::vector<Point3> points, bool float32 = false) {
  ParsedBody body;
  body.name = "b_1";
  body.points = std::move(points);
  body.triangles = {{0, 1, 2}};
  body.patches = {"WallSurface"};
  body.float32 = float32;
  return body;
}

TEST(Weld, MakesEqualCoordinatesOnePoint) {
  ParsedBody body = body_of({{0, 0, 0}, {1.5, 0, 0}, {0, 1, 0}, {1.5, 0, 0}, {0, 1, 0}, {2, 2, 0}});
  body.triangles.push_back({4, 3, 5});
  const auto welded = weld(body);
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->points.size(), 4u);
  EXPECT_EQ(welded->points[1], (GridPoint{15000, 0, 0}));
  EXPECT_EQ(welded->triangles[1], (Triangle{2, 1, 3}));
}

TEST(Weld, TakesNegativeZeroForZero) {
  const auto welded = weld(body_of({{-0.0, 0, 0}, {0.0, 0, 0}, {1, 0, -0.0001}}));
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->points.size(), 2u);
  EXPECT_EQ(welded->points[1].z, -1);
}

TEST(Weld, RefusesWhatIsNotOnTheGrid) {
  const auto off = weld(body_of({{0, 0, 0}, {1.00005, 0, 0}, {0, 1, 0}}));
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(off.error().message, HasSubstr("b_1"));
  EXPECT_THAT(off.error().message, HasSubstr("1.00005"));
}

TEST(Weld, RefusesWhatIsNotFiniteOrOutOfRange) {
  const double kBad[] = {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -3e5};
  for (const double bad : kBad)
    EXPECT_FALSE(weld(body_of({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}}))) << bad;
}

TEST(Weld, RefusesCornersThatAreNotThere) {
  ParsedBody body = body_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  body.triangles[0][2] = 3;
  EXPECT_FALSE(weld(body));
}

TEST(Weld, FindsTheGridPointThatAFloat32WasRoundedFrom) {
  for (std::int64_t k = 10'230'000; k <= 10'240'000; k += 7) {
    const auto v = static_cast<double>(static_cast<float>(static_cast<double>(k) / 10000.0));
    const auto welded = weld(body_of({{v, 0, 0}, {-v, 0, 0}, {0, 1, 0}}, true));
    ASSERT_TRUE(welded) << k;
    EXPECT_EQ(welded->points[0].x, k);
    EXPECT_EQ(welded->points[1].x, -k);
  }
}

TEST(Weld, RefusesAFloat32BetweenGridPointsOrBeyondItsRange) {
  EXPECT_FALSE(weld(body_of({{0.50005, 0, 0}, {1, 0, 0}, {0, 1, 0}}, true)));
  EXPECT_FALSE(weld(body_of({{1024.5, 0, 0}, {1, 0, 0}, {0, 1, 0}}, true)));
}

}  // namespace
}  // namespace citymesh
