#include "core/geometry/measure.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::box;

TEST(Measure, VolumeAndAreaOfABox) {
  const auto b = box({-10000, -10000, 0}, {10000, 20000, 30000});
  EXPECT_DOUBLE_EQ(volume_m3(b.points, b.triangles), 2.0 * 3.0 * 3.0);
  EXPECT_DOUBLE_EQ(area_m2(b.points, b.triangles), 2 * (6.0 + 6.0 + 9.0));
}

TEST(Measure, DistanceToATriangleIsToItsNearestPoint) {
  const GridPoint a{0, 0, 0}, b{10000, 0, 0}, c{0, 10000, 0};
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({2000, 2000, 5000}, a, b, c), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({-3000, -4000, 0}, a, b, c), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_triangle_m({2000, -1000, 0}, a, b, c), 0.1);
}

TEST(Measure, DeviationSeesBothDirections) {
  const auto small = box({0, 0, 0}, {10000, 10000, 10000});
  const auto tall = box({0, 0, 0}, {10000, 10000, 30000});
  const TriangleView of_small{small.points, small.triangles}, of_tall{tall.points, tall.triangles};
  const Deviation there = deviation_to(of_small, of_tall);
  const Deviation back = deviation_to(of_tall, of_small);
  EXPECT_NEAR(there.max_m, 0.5,
              1e-9);  // the middle of the lower roof lies between the taller walls
  EXPECT_NEAR(back.max_m, 2.0, 1e-9);
  EXPECT_NEAR(two_sided(there, back).max_m, 2.0, 1e-9);
  EXPECT_GT(two_sided(there, back).mean_m, 0.0);
  EXPECT_EQ(deviation_to(of_small, of_small).max_m, 0.0);
}

TEST(BoxTree, FindsWhatASearchOfAllBoxesFinds) {
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int64_t> place(-1000, 1000), size(0, 120);
  const auto random_box = [&] {
    const GridPoint p{place(random), place(random), place(random)};
    return GridBox{p, {p.x + size(random), p.y + size(random), p.z + size(random)}};
  };
  std::vector<GridBox> boxes(500);
  for (GridBox& b : boxes) b = random_box();
  const BoxTree tree(boxes);
  for (int i = 0; i < 200; ++i) {
    const GridBox query = random_box();
    std::vector<std::uint32_t> found, expected;
    tree.for_each_meeting(query, [&](std::uint32_t k) { found.push_back(k); });
    for (std::uint32_t k = 0; k < boxes.size(); ++k)
      if (boxes[k].meets(query)) expected.push_back(k);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace citymesh
