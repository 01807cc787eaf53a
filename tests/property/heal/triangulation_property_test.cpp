#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/geometry/overlay.h"
#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

/// A star-shaped ring: simple whatever the radii.
std::vector<GridPoint2> star(std::mt19937& random, std::int64_t x, std::int64_t y) {
  std::uniform_int_distribution<int> corners(3, 40);
  std::uniform_real_distribution<double> radius(20000, 100000);
  const int n = corners(random);
  std::vector<GridPoint2> ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * i / n, r = radius(random);
    ring.push_back({x + std::llround(r * std::cos(angle)), y + std::llround(r * std::sin(angle))});
  }
  return ring;
}

TEST(TriangulationProperty, TrianglesCoverExactlyThePolygon) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const auto ring = star(random, 0, 0);
    std::vector<GridPoint> points;
    std::vector<std::uint32_t> indices;
    for (const GridPoint2& p : ring) {
      indices.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back({p.x, p.y, 7});
    }
    const auto triangles = triangulate(points, std::vector<std::vector<std::uint32_t>>{indices});
    ASSERT_TRUE(triangles) << i;
    EXPECT_EQ(triangles->size(), ring.size() - 2) << i;
    Int128 covered = 0;
    for (const Triangle& t : *triangles) {
      const Int128 part = area2(project(points[t[0]], Axis::Z), project(points[t[1]], Axis::Z),
                                project(points[t[2]], Axis::Z));
      EXPECT_TRUE(part > 0) << i;
      covered += part;
    }
    EXPECT_TRUE(covered == area2(Area{ring, {}})) << i;
  }
}

TEST(OverlayProperty, AreasAddUp) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> shift(-80000, 80000);
  const auto total = [](const std::vector<Area>& areas) {
    double sum = 0;
    for (const Area& area : areas) sum += static_cast<double>(area2(area));
    return sum;
  };
  for (int i = 0; i < 100; ++i) {
    const std::vector<Area> a{{star(random, 0, 0), {}}};
    const std::vector<Area> b{{star(random, shift(random), shift(random)), {}}};
    const std::vector<Area> both{a[0], b[0]}, turned{b[0], a[0]};
    const auto united = unite(both), swapped = unite(turned), rest = subtract(a, b);
    ASSERT_TRUE(united && swapped && rest) << i;
    // Crossings are rounded by less than a step: the area changes by less than the outlines' length
    // in steps.
    EXPECT_NEAR(total(*united), total(*rest) + total(b), 2 * 1e7) << i;
    EXPECT_EQ(total(*united), total(*swapped)) << i;
  }
}

}  // namespace
}  // namespace citymesh
