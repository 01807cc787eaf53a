#include "services/access/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "services/access/api_keys.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/access/token_issuer.h"

namespace citymesh {
namespace {

using testing::HasSubstr;
using testing::Not;

class AccessTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::unique_ptr<Access> opened(AccessOptions options) {
    auto access = Access::open(std::move(options));
    EXPECT_TRUE(access) << access.error().message;
    return access ? *std::move(access) : nullptr;
  }

  TempFolder folder_;
};

TEST_F(AccessTest, WithoutFilesEverybodyMayDoEverything) {
  const auto access = opened({});
  EXPECT_FALSE(access->is_required());
  const auto local = access->identify({.address = "127.0.0.1"});
  ASSERT_TRUE(local);
  EXPECT_EQ(local->role, Role::Admin);
  EXPECT_EQ(local->name, "");
  EXPECT_EQ(access->identify({.address = "203.0.113.9"})->name, "address:203.0.113.9");
  // What is shown although nobody asked does not matter.
  EXPECT_TRUE(access->identify({.authorization = "Basic eDp5"}));
}

TEST_F(AccessTest, AnApiKeyIsTakenAsBearerOrInItsOwnHeader) {
  const auto key = *make_api_key("city", Role::Submit);
  const auto access = opened({.api_keys = file("keys", key.line)});
  EXPECT_TRUE(access->is_required());
  for (const auto& credentials :
       {Credentials{.authorization = "Bearer " + key.key},
        Credentials{.authorization = "bearer   " + key.key}, Credentials{.api_key = key.key},
        Credentials{.authorization = "Basic eDp5", .api_key = key.key}}) {
    const auto client = access->identify(credentials);
    ASSERT_TRUE(client) << client.error().message;
    EXPECT_EQ(client->name, "key:city");
  }
  for (const auto& credentials :
       {Credentials{.authorization = key.key}, Credentials{.authorization = "Basic " + key.key},
        Credentials{.authorization = "Bearer"}, Credentials{.authorization = "Bearer "},
        Credentials{.authorization = "Bearer " + key.key + "x"},
        Credentials{.authorization = "Bearer " + key.key, .api_key = "wrong"},
        Credentials{.authorization = "Bearer a.b.c"}}) {
    const auto client = access->identify(credentials);
    ASSERT_FALSE(client) << credentials.authorization;
    EXPECT_THAT(client.error().message, Not(HasSubstr(key.key)));
  }
}

TEST_F(AccessTest, WhoShowsNothingHasNoRole) {
  const auto access = opened({.api_keys = file("keys", "")});
  const auto client = access->identify({.address = "127.0.0.1"});
  ASSERT_TRUE(client);
  EXPECT_EQ(client->role, Role::None);
  EXPECT_EQ(client->name, "");
}

TEST_F(AccessTest, TokensAreTakenBesideKeys) {
  const TokenIssuer issuer(TokenIssuer::Kind::P256);
  const auto key = *make_api_key("alice", Role::ReadOwn);
  const auto access = opened({.api_keys = file("keys", key.line),
                              .oidc_jwks = {.source = file("jwks", issuer.jwks())},
                              .token_rules = {.issuer = "i", .audience = "a"}});
  const nlohmann::json claims = {{"iss", "i"},
                                 {"aud", "a"},
                                 {"sub", "alice"},
                                 {"exp", std::time(nullptr) + 100},
                                 {"roles", "citymesh:admin"}};
  const auto client = access->identify({.authorization = "Bearer " + issuer.token(claims.dump())});
  ASSERT_TRUE(client) << client.error().message;
  EXPECT_EQ(client->role, Role::Admin);
  // A key and a token of the same name are two clients.
  EXPECT_NE(client->name, access->identify({.api_key = key.key})->name);
  EXPECT_FALSE(access->identify({.api_key = issuer.token(claims.dump())}));
}

TEST_F(AccessTest, FilesThatCannotBeUsedAreNamed) {
  const auto missing = Access::open({.api_keys = folder_ / "none"});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("none"));
  const auto wrong = Access::open({.oidc_jwks = {.source = file("jwks.json", "{}")}});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("jwks.json"));
  EXPECT_FALSE(Access::open({.trusted_proxies = "proxy.local"}));
}

TEST_F(AccessTest, ChangedFilesCountFromTheNextReloadAndBrokenOnesNever) {
  const auto first = *make_api_key("city", Role::Submit);
  const auto second = *make_api_key("port", Role::Admin);
  const auto access = opened({.api_keys = file("keys", first.line)});
  EXPECT_FALSE(*access->reload());

  file("keys", first.line + "\n" + second.line);
  EXPECT_FALSE(access->identify({.api_key = second.key}));
  EXPECT_TRUE(*access->reload());
  EXPECT_TRUE(access->identify({.api_key = second.key}));
  EXPECT_FALSE(*access->reload());

  file("keys", "nonsense");
  EXPECT_FALSE(access->reload());
  EXPECT_TRUE(access->identify({.api_key = first.key}));
  file("keys", second.line);
  EXPECT_TRUE(*access->reload());
  EXPECT_FALSE(access->identify({.api_key = first.key}));
}

}  // namespace
}  // namespace citymesh
