#include "core/source/area.h"

#include <gtest/gtest.h>

namespace citymesh::source {
namespace {

const Area kArea({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}});

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

TEST(Area, RingsWithinRingsAreOpenings) {
  const Area area({{{0, 0}, {10, 0}, {10, 10}, {0, 10}},
                   {{2, 2}, {8, 2}, {8, 8}, {2, 8}},
                   {{20, 0}, {30, 0}, {30, 10}}});
  EXPECT_TRUE(area.contains({1, 1}));
  EXPECT_FALSE(area.contains({5, 5}));
  EXPECT_TRUE(area.contains({8, 5})) << "the edge of the opening";
  EXPECT_TRUE(area.contains({29, 1})) << "another polygon";
  EXPECT_FALSE(area.contains({15, 1}));
  const std::vector<Footprints::Ring> one{{0, 3, true}};
  EXPECT_FALSE(area.touches(std::vector<Point2>{{4, 4}, {6, 4}, {5, 6}}, one));
  EXPECT_TRUE(area.touches(std::vector<Point2>{{4, 4}, {9, 4}, {5, 6}}, one));
  EXPECT_TRUE(area.touches(std::vector<Point2>{{-50, -50}, {90, -50}, {5, 90}}, one)) << "around";
}

TEST(Area, SidesAreWithinOnlyWhenNoPieceOfThemLeaves) {
  // The letter U.
  const Area area({{{0, 0}, {30, 0}, {30, 30}, {20, 30}, {20, 10}, {10, 10}, {10, 30}, {0, 30}}});
  const auto within = [&](const Ring2& ring) { return area.contains_sides(ring); };
  EXPECT_TRUE(within({{1, 1}, {29, 1}, {29, 9}, {1, 9}}));
  EXPECT_FALSE(within({{5, 20}, {25, 20}, {25, 5}, {5, 5}})) << "corners are, a side is not";
  EXPECT_FALSE(within({{5, 20}, {15, 20}, {5, 5}}));
  EXPECT_TRUE(within({{0, 10}, {30, 10}, {30, 0}, {0, 0}})) << "along the boundary";
  EXPECT_TRUE(within({{10, 10}, {10, 30}, {0, 30}})) << "through a corner, along two sides";
  EXPECT_FALSE(within({{10, 30}, {20, 30}, {15, 5}})) << "from corner to corner, outside";
}

TEST(Area, ASlantedSideOfTheAreaIsWithinIt) {
  const Point2 a{390012.137, 5819000.713}, b{390045.911, 5819013.329}, c{390020.5, 5819090.25};
  const Area area({{a, b, c}});
  const auto on = [](const Point2& p, const Point2& q, double t) {
    return Point2{p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t};
  };
  EXPECT_TRUE(area.contains_sides(Ring2{a, b, c}));
  EXPECT_TRUE(area.contains_sides(Ring2{on(a, b, 0.3), on(a, b, 0.9), on(b, c, 0.7)}));
  EXPECT_FALSE(area.contains_sides(Ring2{on(a, b, 0.3), on(a, b, 1.001), on(b, c, 0.7)}));
}

}  // namespace
}  // namespace citymesh::source
