#include "core/reconstruct/partition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kTolerance = 20;
constexpr std::size_t kMany = 10000;

void add_ring(std::vector<PartitionLine>& lines, const std::vector<GridPoint2>& ring,
              std::uint32_t area) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    lines.push_back({ring[i], ring[(i + 1) % ring.size()], area});
}

std::vector<GridPoint2> square(std::int64_t x, std::int64_t y, std::int64_t size) {
  return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
}

/// Area in square metres by the areas that cover it.
std::map<std::vector<std::uint32_t>, double> covered(const Partition& partition) {
  std::map<std::vector<std::uint32_t>, double> sum;
  for (std::size_t c = 1; c < partition.cells.size(); ++c)
    sum[partition.cells[c].areas] += partition.cells[c].area_m2;
  return sum;
}

TEST(Partition, KnowsWhatCoversEveryCell) {
  std::vector<PartitionLine> lines;
  add_ring(lines, square(0, 0, 100000), 0);
  add_ring(lines, square(50000, 50000, 100000), 1);
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  auto sum = covered(*partition);
  EXPECT_EQ(sum.size(), 3u);
  EXPECT_NEAR((sum[{0}]), 75, 1e-9);
  EXPECT_NEAR((sum[{1}]), 75, 1e-9);
  EXPECT_NEAR((sum[{0, 1}]), 25, 1e-9);
}

TEST(Partition, AHoleIsNotCovered) {
  std::vector<PartitionLine> lines;
  add_ring(lines, square(0, 0, 100000), 0);
  add_ring(lines, square(20000, 20000, 30000), 0);
  add_ring(lines, square(30000, 30000, 10000), 1);  // stands in the hole
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  auto sum = covered(*partition);
  EXPECT_NEAR((sum[{0}]), 91, 1e-9);
  EXPECT_NEAR((sum[{}]), 8, 1e-9);
  EXPECT_NEAR((sum[{1}]), 1, 1e-9);
}

TEST(Partition, ARingThatCrossesItselfIsTwoAreas) {
  std::vector<PartitionLine> lines;
  add_ring(lines, {{0, 0}, {100000, 100000}, {100000, 0}, {0, 100000}}, 7);
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  EXPECT_EQ(partition->cells.size(), 3u);
  EXPECT_NEAR((covered(*partition)[{7}]), 50, 1e-9);
}

TEST(Partition, NeighboursThatMissEachOtherByLessThanTheToleranceTouch) {
  std::vector<PartitionLine> lines;
  add_ring(lines, square(0, 0, 100000), 0);
  add_ring(lines, {{100007, 30000}, {200000, 30000}, {200000, 60000}, {99995, 60000}}, 1);
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  EXPECT_EQ(partition->cells.size(), 3u);
  for (const Partition::Cell& cell : partition->cells) EXPECT_LT(cell.areas.size(), 2u);
}

TEST(Partition, SlitsNarrowerThanTheToleranceVanish) {
  std::vector<PartitionLine> lines;
  add_ring(lines,
           {{0, 0},
            {100000, 0},
            {100000, 100000},
            {50010, 100000},
            {50005, 20000},
            {50000, 100000},
            {0, 100000}},
           0);
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  EXPECT_EQ(partition->cells.size(), 2u);
}

TEST(Partition, LinesThatOnlyDivideChangeNoCover) {
  std::vector<PartitionLine> lines;
  add_ring(lines, square(0, 0, 100000), 3);
  lines.push_back({{-50000, 40000}, {150000, 45000}});
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  ASSERT_EQ(partition->cells.size(), 3u);
  EXPECT_THAT(partition->cells[0].areas, IsEmpty());
  EXPECT_THAT(partition->cells[1].areas, ElementsAre(3u));
  EXPECT_THAT(partition->cells[2].areas, ElementsAre(3u));
}

TEST(Partition, ThePlaceOfACellIsInside) {
  std::vector<PartitionLine> lines;
  add_ring(lines,
           {{0, 0}, {100000, 0}, {100000, 100000}, {90000, 100000}, {90000, 10000}, {0, 10000}}, 0);
  const auto partition = divide(lines, kTolerance, kMany);
  ASSERT_TRUE(partition);
  ASSERT_EQ(partition->cells.size(), 2u);
  const GridPoint2 p = partition->cells[1].inside;
  EXPECT_TRUE((p.x > 0 && p.y > 0 && p.x < 100000 && p.y < 100000) && (p.x > 90000 || p.y < 10000))
      << p.x << " " << p.y;
}

TEST(Partition, GivesUpBeyondItsLimit) {
  std::vector<PartitionLine> lines;
  for (std::int64_t i = 0; i < 60; ++i) {
    lines.push_back({{i * 1000, 0}, {i * 1000, 60000}});
    lines.push_back({{0, i * 1000}, {60000, i * 1000}});
  }
  EXPECT_TRUE(divide(lines, kTolerance, kMany));
  EXPECT_FALSE(divide(lines, kTolerance, 1000));
}

}  // namespace
}  // namespace citymesh
