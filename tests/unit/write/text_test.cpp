#include "core/write/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace citymesh {
namespace {

std::string grid_text(std::int64_t steps) {
  std::string text;
  append_grid(text, steps);
  return text;
}

std::string number_text(double value, int decimals = 6) {
  std::string text;
  append_number(text, value, decimals);
  return text;
}

TEST(GridText, HasExactlyFourDecimals) {
  EXPECT_EQ(grid_text(0), "0.0000");
  EXPECT_EQ(grid_text(1), "0.0001");
  EXPECT_EQ(grid_text(10000), "1.0000");
  EXPECT_EQ(grid_text(123456789), "12345.6789");
  EXPECT_EQ(grid_text(1020), "0.1020");
}

TEST(GridText, KeepsTheSignOfSmallNegativesAndHasNoNegativeZero) {
  EXPECT_EQ(grid_text(-1), "-0.0001");
  EXPECT_EQ(grid_text(-9999), "-0.9999");
  EXPECT_EQ(grid_text(-10000), "-1.0000");
  EXPECT_EQ(grid_text(-0), "0.0000");
}

TEST(GridText, HoldsTheWholeRangeOfIntegers) {
  EXPECT_EQ(grid_text(std::numeric_limits<std::int64_t>::max()), "922337203685477.5807");
  EXPECT_EQ(grid_text(std::numeric_limits<std::int64_t>::min()), "-922337203685477.5808");
}

TEST(NumberText, DropsTrailingZerosAndNegativeZero) {
  EXPECT_EQ(number_text(1.5), "1.5");
  EXPECT_EQ(number_text(391000), "391000");
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(-1e-9), "0");
  EXPECT_EQ(number_text(1e300).size(), 301u);
}

TEST(NumberText, IsNullForWhatIsNotFinite) {
  EXPECT_EQ(number_text(std::nan("")), "null");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "null");
}

TEST(JsonText, EscapesQuotesControlsAndBrokenUtf8) {
  std::string text;
  append_json_string(text, "a\"b\\c\n\x01 \xC3\xA4 \xFF\xC3");
  EXPECT_EQ(text, "\"a\\\"b\\\\c\\u000a\\u0001 \xC3\xA4 \xEF\xBF\xBD\xEF\xBF\xBD\"");
}

TEST(MarkupText, LeavesNoTagQuoteOrControlAlive) {
  std::string text;
  append_markup(text, "<script>'x' & \"y\"\x02\xE2\x82</script>");
  EXPECT_EQ(text,
            "&lt;script&gt;&#39;x&#39; &amp; &quot;y&quot;\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"
            "&lt;/script&gt;");
}

}  // namespace
}  // namespace citymesh
