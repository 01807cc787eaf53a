#include "core/source/area.h"

#include <gtest/gtest.h>

namespace citymesh::source {
namespace {

const Area kArea({{0, 0}, {10, 0}, {10, 10}, {0, 10}});

bool touches(const std::vector<std::vector<Point2>>& rings) {
  std::vector<Point2> points;
  std::vector<Footprints::Ring> polygon;
  for (const auto& ring : rings) {
    polygon.push_back({static_cast<std::uint32_t>(points.size()),
                       static_cast<std::uint32_t>(ring.size()), polygon.empty()});
    points.insert(points.end(), ring.begin(), ring.end());
  }
  return kArea.touches(points, polygon);
}

TEST(Area, ContainsItsBoundary) {
  for (const Point2 p : {Point2{0, 0}, {5, 0}, {10, 10}, {5, 5}, {10, 3}})
    EXPECT_TRUE(kArea.contains(p)) << p.x << " " << p.y;
  for (const Point2 p : {Point2{-1, 0}, {11, 0}, {5, 10.0001}, {-0.0001, 5}})
    EXPECT_FALSE(kArea.contains(p)) << p.x << " " << p.y;
}

TEST(Area, TouchesWhatLiesInsideCrossesOrCoversIt) {
  EXPECT_TRUE(touches({{{2, 2}, {3, 2}, {3, 3}}}));
  EXPECT_TRUE(touches({{{5, 5}, {15, 5}, {15, 6}}}));
  EXPECT_TRUE(touches({{{-5, 4}, {15, 4}, {15, 6}, {-5, 6}}}));
  EXPECT_TRUE(touches({{{-5, -5}, {15, -5}, {15, 15}, {-5, 15}}}));
}

TEST(Area, TouchesAtACornerOrAlongAnEdge) {
  EXPECT_TRUE(touches({{{10, 10}, {12, 10}, {12, 12}}}));
  EXPECT_TRUE(touches({{{10, 2}, {12, 2}, {12, 8}, {10, 8}}}));
  EXPECT_TRUE(touches({{{2, 10}, {8, 10}}})) << "a wall seen from above";
}

TEST(Area, DoesNotTouchWhatIsApart) {
  EXPECT_FALSE(touches({{{11, 11}, {12, 11}, {12, 12}}}));
  EXPECT_FALSE(touches({{{8, 13}, {13, 8}, {13, 13}}})) << "the boxes overlap, the shapes do not";
  EXPECT_FALSE(touches({}));
}

TEST(Area, AHoleAroundItIsNoContact) {
  const std::vector<Point2> outer{{-20, -20}, {30, -20}, {30, 30}, {-20, 30}};
  EXPECT_FALSE(touches({outer, {{-5, -5}, {15, -5}, {15, 15}, {-5, 15}}}));
  EXPECT_TRUE(touches({outer, {{-5, -5}, {10, -5}, {10, 15}, {-5, 15}}})) << "the hole's edge";
}

}  // namespace
}  // namespace citymesh::source
