#include "services/stores/state_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

TEST(StateFolder, TheFirstHolderIsAloneAndLaterOnesAreNot) {
  const TempFolder folder;
  auto first = StateFolder::open(folder / "state");
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->alone());
  ASSERT_TRUE(first->share());
  const auto second = StateFolder::open(folder / "state");
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->alone());
}

TEST(StateFolder, IsFreeAgainWhenItsHolderGoes) {
  const TempFolder folder;
  { ASSERT_TRUE(StateFolder::open(folder / "state")); }
  const auto next = StateFolder::open(folder / "state");
  ASSERT_TRUE(next);
  EXPECT_TRUE(next->alone());
}

TEST(StateFolder, NamesAFolderThatCannotBeUsed) {
  const TempFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto opened = StateFolder::open(folder / "file");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("file"));
}

}  // namespace
}  // namespace citymesh
