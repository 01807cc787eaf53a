#include "core/pipeline/names.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

TEST(Names, AreSafeInFiles) {
  EXPECT_EQ(plain_name("DEBE_01-Ö/3"), "DEBE_01____3");
  EXPECT_EQ(plain_name("4018106"), "b_4018106");
  EXPECT_EQ(plain_name("_x"), "b__x");
  EXPECT_EQ(plain_name(""), "b_");
}

TEST(Names, ClashesAreNumberedInIdOrderHoweverTheyCome) {
  Names forward({"a-1", "a.1", "a_1"}), backward({"a_1", "a.1", "a-1"});
  EXPECT_EQ(forward.take("a_1"), "a_1_3");
  EXPECT_EQ(forward.take("a.1"), "a_1_2");
  EXPECT_EQ(forward.take("a-1"), "a_1");
  EXPECT_EQ(backward.take("a-1"), "a_1");
  EXPECT_EQ(backward.take("a.1"), "a_1_2");
  EXPECT_EQ(backward.take("a_1"), "a_1_3");
}

TEST(Names, ANumberedNameNeverTakesAnothersName) {
  Names names({"a-", "a_", "a__2"});
  std::unordered_set<std::string> all{names.take("a-"), names.take("a_"), names.take("a__2")};
  EXPECT_EQ(all.size(), 3u);
}

TEST(Names, ARepeatedIdGetsANameOfItsOwn) {
  Names names({"a"});
  EXPECT_EQ(names.take("a"), "a");
  EXPECT_EQ(names.take("a"), "a_2");
  EXPECT_EQ(names.take("a"), "a_3");
}

}  // namespace
}  // namespace citymesh
