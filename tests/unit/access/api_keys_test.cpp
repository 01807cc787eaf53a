#include "services/access/api_keys.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/access/base64url.h"

namespace citymesh {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ApiKeysTest, AMadeKeyIsKnownByTheLineThatWasMadeWithIt) {
  const auto city = make_api_key("city-hall", Role::Submit);
  const auto port = make_api_key("port", Role::Admin);
  ASSERT_TRUE(city && port);
  EXPECT_NE(city->key, port->key);
  EXPECT_TRUE(city->key.starts_with(kApiKeyPrefix));
  EXPECT_EQ(city->key.size(), kApiKeyPrefix.size() + 43);  // 256 bits in base64
  EXPECT_THAT(city->line, Not(HasSubstr(city->key)));

  const auto keys = ApiKeys::parse("# clients\n\n" + city->line + "  # the map\r\n" + port->line);
  ASSERT_TRUE(keys) << keys.error().message;
  EXPECT_EQ(keys->size(), 2u);
  const auto client = keys->find(city->key);
  ASSERT_TRUE(client);
  EXPECT_EQ(client->name, "key:city-hall");
  EXPECT_EQ(client->role, Role::Submit);
  EXPECT_EQ(keys->find(port->key)->role, Role::Admin);

  auto altered = city->key;
  altered.back() = altered.back() == 'A' ? 'B' : 'A';
  for (const auto& wrong : {altered, std::string(), city->key + " ", city->line})
    EXPECT_FALSE(keys->find(wrong)) << wrong;
}

TEST(ApiKeysTest, SeveralKeysMayStandForOneClient) {
  const auto old_key = make_api_key("city", Role::Submit);
  const auto new_key = make_api_key("city", Role::ReadOwn);
  const auto keys = ApiKeys::parse(old_key->line + "\n" + new_key->line + "\n");
  ASSERT_TRUE(keys);
  EXPECT_EQ(keys->find(old_key->key)->name, keys->find(new_key->key)->name);
  EXPECT_EQ(keys->find(new_key->key)->role, Role::ReadOwn);
}

TEST(ApiKeysTest, AFileThatIsWrongIsRefusedWithItsLineAndWithoutWhatStandsThere) {
  const auto key = make_api_key("city", Role::Submit);
  const auto hash = key->line.substr(key->line.rfind(' ') + 1);
  struct Case {
    std::string line, expected;
  };
  const Case cases[] = {
      {"city submit", "NAME ROLE sha256:HEX"},
      {"city submit " + hash + " more", "NAME ROLE sha256:HEX"},
      {"city owner " + hash, "read-own, submit, write-back or admin"},
      {"city none " + hash, "read-own, submit, write-back or admin"},
      {"ci/ty submit " + hash, "a name of"},
      {std::string(65, 'n') + " submit " + hash, "a name of"},
      {"city submit " + key->key, "is no hash"},
      {"city submit " + hash + "0", "is no hash"},
      {"city submit " + hash.substr(0, 70) + "g", "is no hash"},
      {key->line + "\n" + key->line, "already"},
  };
  for (const auto& [line, expected] : cases) {
    const auto keys = ApiKeys::parse("# first\n" + line + "\n");
    ASSERT_FALSE(keys) << line;
    EXPECT_EQ(keys.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(keys.error().message, HasSubstr(expected));
    EXPECT_THAT(keys.error().message, HasSubstr("line "));
    EXPECT_THAT(keys.error().message, Not(HasSubstr(key->key)));
  }
}

TEST(ApiKeysTest, AnEmptyFileKnowsNobody) {
  const auto keys = ApiKeys::parse("");
  ASSERT_TRUE(keys);
  EXPECT_FALSE(keys->find(""));
}

TEST(ApiKeysTest, AKeyHasAName) {
  for (const auto* name : {"", "two words", "a\nb", "Zürich"})
    EXPECT_FALSE(make_api_key(name, Role::Submit)) << name;
}

TEST(ClientTest, RolesAreLevels) {
  EXPECT_TRUE(require({"key:city", Role::Submit}, Role::Submit));
  EXPECT_TRUE(require({"key:city", Role::Admin}, Role::ReadOwn));
  EXPECT_TRUE(require({}, Role::None));
  EXPECT_FALSE(require({"key:city", Role::Submit}, Role::WriteBack));
  EXPECT_TRUE(require({"key:city", Role::WriteBack}, Role::Submit));
  EXPECT_EQ(role_from(to_string(Role::WriteBack)), Role::WriteBack);
  const auto refused = require({"key:city", Role::ReadOwn}, Role::Submit);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::PermissionDenied);
  EXPECT_THAT(refused.error().message, testing::AllOf(HasSubstr("read-own"), HasSubstr("submit")));
}

TEST(ClientTest, JobsAreSeenByTheirOwnerAndAdmins) {
  EXPECT_TRUE(may_see({"key:city", Role::ReadOwn}, "key:city"));
  EXPECT_FALSE(may_see({"key:city", Role::Submit}, "key:port"));
  EXPECT_FALSE(may_see({"key:city", Role::Submit}, ""));
  EXPECT_FALSE(may_see({"", Role::Submit}, ""));
  EXPECT_FALSE(may_see({"key:city", Role::None}, "key:city"));
  EXPECT_TRUE(may_see({"key:port", Role::Admin}, "key:city"));
  EXPECT_TRUE(may_see({"", Role::Admin}, "key:city"));
}

TEST(Base64UrlTest, DecodesWhatItEncodesAndNothingElse) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode_base64url(encode_base64url(bytes.substr(0, size))), bytes.substr(0, size));
  EXPECT_EQ(encode_base64url("\xfb\xff"), "-_8");
  for (const auto* wrong : {"A", "AAAAA", "AB==", "AB", "A+8", "A/8", " ", "QUJD\n"})
    EXPECT_FALSE(decode_base64url(wrong)) << wrong;
}

}  // namespace
}  // namespace citymesh
