#include "services/callbacks/signature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

TEST(Signature, IsThatOfRfc4231) {
  EXPECT_EQ(hmac_sha256("Jefe", "what do ya want for nothing?"),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
  EXPECT_EQ(hmac_sha256(std::string(20, '\x0b'), "Hi There"),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
}

TEST(Signature, CoversTimeAndBody) {
  EXPECT_EQ(signature("secret", 1767225600, "{}"),
            "t=1767225600,v1=" + hmac_sha256("secret", "1767225600.{}"));
  EXPECT_NE(signature("secret", 1, "{}"), signature("other", 1, "{}"));
}

TEST(Secret, IsReadWithoutItsLineEndAndMustBeLongEnough) {
  const TempFolder folder;
  const auto file = (folder / "secret").string();
  EXPECT_FALSE(read_secret(file));
  std::ofstream(file) << "0123456789abcdef\r\n";
  EXPECT_EQ(*read_secret(file), "0123456789abcdef");
  std::ofstream(file) << "short\n";
  const auto refused = read_secret(file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("has 5 bytes, expected 16 to 4096"));
  EXPECT_FALSE(read_secret(folder.path().string()));
}

}  // namespace
}  // namespace citymesh
