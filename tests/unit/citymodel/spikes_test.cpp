#include "core/citymodel/spikes.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

Ring without(Ring ring) {
  drop_repeats_and_spikes(ring);
  return ring;
}

TEST(Spikes, RepeatedCornersGo) {
  EXPECT_EQ(without({1, 1, 2, 3, 3, 3, 4}), (Ring{1, 2, 3, 4}));
  EXPECT_EQ(without({1, 2, 3, 4, 1, 1}), (Ring{2, 3, 4, 1}));
}

TEST(Spikes, TheTipAndOneFootOfASpikeGo) {
  EXPECT_EQ(without({1, 2, 9, 2, 3, 4}), (Ring{1, 2, 3, 4}));
  EXPECT_EQ(without({1, 2, 8, 9, 8, 2, 3}), (Ring{1, 2, 3}));
}

TEST(Spikes, SpikesAroundTheStartGoToo) {
  EXPECT_EQ(without({9, 1, 2, 3, 1}), (Ring{2, 3, 1}));
  EXPECT_EQ(without({1, 2, 3, 4, 1, 9}), (Ring{2, 3, 4, 1}));
  EXPECT_EQ(without({8, 1, 2, 3, 1, 8, 9}), (Ring{2, 3, 1}));
}

TEST(Spikes, WhatIsNoAreaIsEmpty) {
  EXPECT_EQ(without({}), Ring{});
  EXPECT_EQ(without({1, 2}), Ring{});
  EXPECT_EQ(without({1, 2, 3, 2}), Ring{});
  EXPECT_EQ(without({1, 1, 1, 1}), Ring{});
}

TEST(Spikes, CleanRingsStayAsTheyAre) {
  Ring ring{4, 3, 2, 1};
  EXPECT_FALSE(drop_repeats_and_spikes(ring));
  EXPECT_EQ(ring, (Ring{4, 3, 2, 1}));
}

}  // namespace
}  // namespace citymesh
