#include "core/pipeline/signature.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace citymesh {
namespace {

std::uint64_t of(const testing::Triangles& t) { return signature(t.points, t.triangles); }

TEST(Signature, DoesNotDependOnOrderOrNumbering) {
  const auto box = testing::box({0, 0, 0}, {10, 20, 30});
  auto other = box;
  std::rotate(other.triangles.begin(), other.triangles.begin() + 3, other.triangles.end());
  for (Triangle& t : other.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
  std::reverse(other.points.begin(), other.points.end());
  for (Triangle& t : other.triangles)
    for (std::uint32_t& i : t) i = 7 - i;
  EXPECT_EQ(of(box), of(other));
}

TEST(Signature, SeesAMovedPointATurnedAndAMissingTriangle) {
  const auto box = testing::box({0, 0, 0}, {10, 20, 30});
  auto moved = box, turned = box, missing = box;
  moved.points[3].z += 1;
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  missing.triangles.pop_back();
  EXPECT_NE(of(box), of(moved));
  EXPECT_NE(of(box), of(turned));
  EXPECT_NE(of(box), of(missing));
}

TEST(Signature, AddsUp) {
  const auto a = testing::box({0, 0, 0}, {1, 1, 1}), b = testing::box({5, 5, 5}, {9, 9, 9});
  auto both = a;
  both.add(b);
  EXPECT_EQ(of(both), of(a) + of(b));
}

}  // namespace
}  // namespace citymesh
