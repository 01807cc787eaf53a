#include "core/geometry/arrangement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/measure.h"
#include "core/geometry/predicates.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::box;
using testing::Triangles;

Arrangement arranged(const Triangles& soup, double tolerance_m = 0.0015) {
  ArrangeOptions options;
  options.tolerance_m = tolerance_m;
  auto result = arrange(soup.points, soup.triangles, options);
  EXPECT_TRUE(result);
  return result ? *result : Arrangement{};
}

bool crosses_itself(const Arrangement& a) {
  const auto corners = [&](const Triangle& t) {
    return std::array<GridPoint, 3>{a.points[t[0]], a.points[t[1]], a.points[t[2]]};
  };
  for (std::size_t i = 0; i < a.facets.size(); ++i)
    for (std::size_t j = i + 1; j < a.facets.size(); ++j)
      if (triangles_clash(corners(a.facets[i]), corners(a.facets[j]))) return true;
  return false;
}

/// Volume of what has a winding number of at least one.
double solid_m3(const Triangles& soup) {
  const Arrangement a = arranged(soup);
  EXPECT_FALSE(crosses_itself(a));
  const std::vector<std::int8_t> weights(soup.triangles.size(), 1);
  const WindingNumbers winding = winding_numbers(a, weights);
  EXPECT_TRUE(winding.exact);
  std::vector<Triangle> boundary;
  for (std::size_t f = 0; f < a.facets.size(); ++f) {
    Triangle t = a.facets[f];
    if ((winding.front[f] >= 1) == (winding.back[f] >= 1)) continue;
    if (winding.front[f] >= 1) std::swap(t[1], t[2]);
    boundary.push_back(t);
  }
  return volume_m3(a.points, boundary);
}

constexpr std::int64_t m = 10000;

TEST(Arrangement, LeavesWhatDoesNotMeetAlone) {
  Triangles two = box({0, 0, 0}, {m, m, m});
  two.add(box({3 * m, 0, 0}, {4 * m, m, m}));
  const Arrangement a = arranged(two);
  EXPECT_EQ(a.facets.size(), 24u);
  EXPECT_EQ(a.points.size(), 16u);
  EXPECT_DOUBLE_EQ(solid_m3(two), 2);
}

TEST(Arrangement, CountsTheCommonPartOfCrossingBoxesOnce) {
  Triangles two = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  two.add(box({m, m, m}, {3 * m, 3 * m, 3 * m}));
  EXPECT_DOUBLE_EQ(solid_m3(two), 15);
}

TEST(Arrangement, TakesTouchingBoxesTogetherAndTheirPartyWallOut) {
  Triangles two = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  two.add(box({2 * m, m / 2, 0}, {4 * m, 3 * m, 3 * m}));
  EXPECT_DOUBLE_EQ(solid_m3(two), 8 + 2 * 2.5 * 3);
}

TEST(Arrangement, KnowsACavityByItsOrientation) {
  Triangles hollow = box({0, 0, 0}, {4 * m, 4 * m, 4 * m});
  hollow.add(box({m, m, m}, {3 * m, 3 * m, 3 * m}).turn());
  EXPECT_DOUBLE_EQ(solid_m3(hollow), 64 - 8);
}

TEST(Arrangement, RoundsCrossingsThatAreNotOnTheGridUntilNothingCrosses) {
  Triangles many;
  for (int i = 0; i < 6; ++i) {
    Triangles one = box({0, 0, 0}, {5 * m + i, 3 * m, 2 * m});
    const double c = std::cos(0.37 * i), s = std::sin(0.37 * i);
    for (GridPoint& p : one.points) {
      const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
      p = {std::llround(c * x - s * y), std::llround(s * x + c * y), p.z + 137 * i};
    }
    many.add(one);
  }
  const double volume = solid_m3(many);
  EXPECT_GT(volume, 60);
  EXPECT_LT(volume, 180);
}

TEST(Arrangement, BringsVerticesWithinTheToleranceOntoEdgesAndFaces) {
  Triangles two = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  two.add(box({2 * m + 7, m / 2, 5}, {4 * m, m, m}));
  const Arrangement a = arranged(two);
  EXPECT_FALSE(crosses_itself(a));
  for (std::size_t i = 0; i < a.points.size(); ++i)
    for (std::size_t j = i + 1; j < a.points.size(); ++j)
      EXPECT_GT(distance_m(a.points[i], a.points[j]), 0.0015);
  EXPECT_NEAR(solid_m3(two), 8 + 2 * 0.5 * 1, 0.01);
}

TEST(Arrangement, MeasuresHowFarAnOpenBoundaryGoesRoundACell) {
  Triangles open = box({0, 0, 0}, {m, m, m});
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);  // no floor
  const Arrangement a = arranged(open);
  const std::vector<std::int8_t> weights(open.triangles.size(), 1);
  const WindingNumbers winding = winding_numbers(a, weights);
  EXPECT_FALSE(winding.exact);
}

TEST(Arrangement, StopsAtItsWorkLimit) {
  Triangles two = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  two.add(box({m, m, m}, {3 * m, 3 * m, 3 * m}));
  ArrangeOptions options;
  options.max_cuts = 3;
  EXPECT_FALSE(arrange(two.points, two.triangles, options));
}

}  // namespace
}  // namespace citymesh
