#include "core/geometry/locate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/plane.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::box;
using testing::Triangles;

Side side(const Triangles& body, const GridPoint& place, std::int64_t parts = 1) {
  return Locator(body.points, body.triangles).locate(place, parts);
}

TEST(Locator, TellsInsideOutsideAndBoundary) {
  const Triangles body = box({0, 0, 0}, {10, 10, 10});
  EXPECT_EQ(side(body, {5, 5, 5}), Side::Inside);
  EXPECT_EQ(side(body, {1, 1, 1}), Side::Inside);
  EXPECT_EQ(side(body, {11, 5, 5}), Side::Outside);
  EXPECT_EQ(side(body, {-1, 0, 0}), Side::Outside);
  EXPECT_EQ(side(body, {0, 5, 5}), Side::On);
  EXPECT_EQ(side(body, {10, 10, 10}), Side::On);
  EXPECT_EQ(side(body, {5, 0, 10}), Side::On);
}

TEST(Locator, NoCornerOrEdgeInTheRayMatters) {
  // Seen from the places along +x stand corners, edges and diagonals of the box.
  const Triangles body = box({10, 0, 0}, {20, 10, 10});
  for (const std::int64_t y : {0, 5, 10})
    for (const std::int64_t z : {0, 5, 10}) EXPECT_EQ(side(body, {0, y, z}), Side::Outside);
}

TEST(Locator, PartsOfAStepAreExact) {
  const Triangles body = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(side(body, {1, 1, 1}, 2), Side::Inside);
  EXPECT_EQ(side(body, {3, 1, 1}, 2), Side::Outside);
  EXPECT_EQ(side(body, {2, 1, 1}, 2), Side::On);
  EXPECT_EQ(side(body, {-1, 1, 1}, 3), Side::Outside);
  EXPECT_EQ(side(body, {2, 2, 2}, 3), Side::Inside);
}

TEST(Locator, ACavityIsOutside) {
  Triangles body = box({0, 0, 0}, {30, 30, 30});
  body.add(box({10, 10, 10}, {20, 20, 20}).turn());
  EXPECT_EQ(side(body, {15, 15, 15}), Side::Outside);
  EXPECT_EQ(side(body, {5, 15, 15}), Side::Inside);
}

TEST(Locate, KnowsARingWhicheverWayItRuns) {
  const std::vector<GridPoint2> angle{{0, 0}, {10, 0}, {10, 10}, {5, 5}, {0, 10}};
  const std::vector<GridPoint2> turned(angle.rbegin(), angle.rend());
  for (const auto& ring : {angle, turned}) {
    EXPECT_EQ(locate(ring, {2, 2}), Side::Inside);
    EXPECT_EQ(locate(ring, {5, 6}), Side::Outside);
    EXPECT_EQ(locate(ring, {5, 5}), Side::On);
    EXPECT_EQ(locate(ring, {0, 5}), Side::On);
    EXPECT_EQ(locate(ring, {-3, 5}), Side::Outside);
    EXPECT_EQ(locate(ring, {1, 1}, 2), Side::Inside);
  }
}

TEST(FitPlane, FindsThePlaneOfPointsOnIt) {
  const std::vector<Point3> points{{0, 0, 5}, {10, 0, 5}, {10, 8, 7}, {0, 8, 7}, {3, 4, 6}};
  const Plane plane = fit_plane(points);
  for (const Point3& p : points) EXPECT_NEAR(signed_distance(plane, p), 0, 1e-12);
  EXPECT_NEAR(std::abs(signed_distance(plane, {0, 0, 6})), 4 / std::sqrt(17.0), 1e-9);
}

TEST(FitPlane, SharesOutWhatOneCornerIsOff) {
  const std::vector<Point3> points{{0, 0, 0}, {10, 0, 0}, {10, 8, 0.04}, {0, 8, 0}};
  const Plane plane = fit_plane(points);
  for (const Point3& p : points) EXPECT_NEAR(std::abs(signed_distance(plane, p)), 0.01, 1e-4);
}

TEST(FitPlane, OfAVerticalWallIsVertical) {
  const std::vector<Point3> points{{0, 0, 0}, {4, 3, 0}, {4, 3, 9}, {0, 0, 9}};
  EXPECT_NEAR(fit_plane(points).normal.z, 0, 1e-12);
}

}  // namespace
}  // namespace citymesh
