#include "core/citymodel/issue.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

TEST(Issue, HasVal3dityNamesAndOwnOnes) {
  EXPECT_EQ(issue_name(203), "203 NON_PLANAR_POLYGON_DISTANCE_PLANE");
  EXPECT_EQ(issue_name(302), "302 SHELL_NOT_CLOSED");
  EXPECT_EQ(issue_name(issue_code::kDanglingXlink), "C101 DANGLING_XLINK");
  EXPECT_EQ(issue_name(999), "UNKNOWN_ISSUE");
}

TEST(Issue, CodeTextIsWhatTheNameStartsWith) {
  for (const int code : {101, 307, 906, issue_code::kDanglingXlink, issue_code::kUnknownCrs})
    EXPECT_EQ(issue_name(code).substr(0, issue_name(code).find(' ')), issue_code_text(code));
}

}  // namespace
}  // namespace citymesh
