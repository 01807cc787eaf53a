#include "services/access/tokens.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/access/base64url.h"
#include "tests/unit/access/token_issuer.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::int64_t kNow = 1'800'000'000;

const TokenIssuer& rsa() {
  static const TokenIssuer issuer(TokenIssuer::Kind::Rsa, "rsa");
  return issuer;
}
const TokenIssuer& p256() {
  static const TokenIssuer issuer(TokenIssuer::Kind::P256, "ec");
  return issuer;
}

class TokensTest : public testing::Test {
 protected:
  TokensTest() {
    auto keys = parse_jwks(R"({"keys":[)" + rsa().jwk() + "," + p256().jwk() + "]}");
    EXPECT_TRUE(keys) << keys.error().message;
    if (keys) keys_ = *keys;
  }

  static json claims() {
    return {{"iss", "https://login.test"}, {"aud", "citymesh"}, {"sub", "alice"},
            {"exp", kNow + 300},           {"nbf", kNow - 10},  {"roles", {"citymesh:submit"}}};
  }
  static json with(const char* name, json value) {
    auto changed = claims();
    changed[name] = std::move(value);
    return changed;
  }
  static json without(const char* name) {
    auto changed = claims();
    changed.erase(name);
    return changed;
  }

  Result<Client> client(const std::string& token) const {
    return client_of_token(token, keys_, rules_, kNow);
  }
  Result<Client> client(const json& claims) const { return client(p256().token(claims.dump())); }
  std::string why(const json& claims) const {
    const auto refused = client(claims);
    EXPECT_FALSE(refused) << claims;
    return refused ? "" : refused.error().message;
  }
  Role role(const json& claims) const {
    const auto known = client(claims);
    EXPECT_TRUE(known) << known.error().message;
    return known ? known->role : Role::None;
  }

  std::vector<VerificationKey> keys_;
  TokenRules rules_{.issuer = "https://login.test", .audience = "citymesh"};
};

TEST_F(TokensTest, ASignedTokenNamesItsClientAndRole) {
  for (const auto* issuer : {&rsa(), &p256()}) {
    const auto known = client(issuer->token(claims().dump()));
    ASSERT_TRUE(known) << known.error().message;
    EXPECT_EQ(known->name, "oidc:alice");
    EXPECT_EQ(known->role, Role::Submit);
  }
}

TEST_F(TokensTest, TheAlgorithmIsThatOfTheKeyWhateverTheTokenSays) {
  const auto body = claims().dump();
  for (const auto* header :
       {R"({"alg":"none"})", R"({"alg":"None"})", R"({"alg":"HS256","kid":"rsa"})",
        R"({"alg":"HS256"})", R"({"alg":"RS512","kid":"rsa"})", R"({"alg":"PS256","kid":"rsa"})",
        R"({"kid":"rsa"})", R"({"alg":["RS256"],"kid":"rsa"})",
        // A key of one kind is not tried as one of another.
        R"({"alg":"ES256","kid":"rsa"})", R"({"alg":"RS256","kid":"ec"})"}) {
    EXPECT_FALSE(client(rsa().token(header, body))) << header;
    EXPECT_FALSE(client(token_of(header, body, ""))) << header;
  }
}

TEST_F(TokensTest, OnlyAKeyOfTheSetSigns) {
  const auto body = claims().dump();
  const TokenIssuer stranger(TokenIssuer::Kind::P256, "ec");
  EXPECT_FALSE(client(stranger.token(body)));
  EXPECT_FALSE(client(p256().token(R"({"alg":"ES256","kid":"other"})", body)));
  EXPECT_TRUE(client(p256().token(R"({"alg":"ES256"})", body)));  // any key of its kind
}

TEST_F(TokensTest, WhatWasAlteredAfterSigningIsRefused) {
  const auto token = rsa().token(claims().dump());
  const auto signature = token.substr(token.rfind('.') + 1);
  const auto header = token.substr(0, token.find('.'));
  auto raised = claims();
  raised["roles"] = {"citymesh:admin"};
  EXPECT_FALSE(client(header + "." + encode_base64url(raised.dump()) + "." + signature));
  auto bent = *decode_base64url(signature);
  bent[10] = static_cast<char>(bent[10] ^ 1);
  EXPECT_FALSE(client(token.substr(0, token.rfind('.') + 1) + encode_base64url(bent)));
}

TEST_F(TokensTest, WhatIsNoTokenIsRefused) {
  const auto token = p256().token(claims().dump());
  for (const auto& wrong :
       {std::string(), std::string("."), std::string(".."), std::string("a.b.c"), token + ".",
        token + "=", token.substr(0, token.rfind('.')), token.substr(0, token.size() - 1),
        "." + token, token_of("[]", "{}", "x"), token_of("{}", "null", "x"),
        token_of(std::string(5000, '['), "{}", "x"), std::string(100'000, 'A')})
    EXPECT_FALSE(client(wrong)) << wrong.substr(0, 80);
  EXPECT_FALSE(client(p256().token(R"({"alg":"ES256","kid":"ec"})", "\xff\xfe")));
}

TEST_F(TokensTest, ExtensionsThatMustBeUnderstoodAreNot) {
  const auto refused =
      client(p256().token(R"({"alg":"ES256","kid":"ec","crit":["exp"]})", claims().dump()));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("crit"));
}

TEST_F(TokensTest, IssuerAndAudienceAreThoseOfTheService) {
  EXPECT_THAT(why(with("iss", "https://login.test/")), HasSubstr("iss"));
  EXPECT_THAT(why(without("iss")), HasSubstr("iss"));
  EXPECT_THAT(why(with("aud", "another")), HasSubstr("aud"));
  EXPECT_THAT(why(with("aud", {"another", "citymesh-test"})), HasSubstr("aud"));
  EXPECT_THAT(why(without("aud")), HasSubstr("aud"));
  EXPECT_TRUE(client(with("aud", {"another", "citymesh"})));
}

TEST_F(TokensTest, TimeIsCheckedWithSomeLeeway) {
  EXPECT_THAT(why(without("exp")), HasSubstr("exp"));
  EXPECT_THAT(why(with("exp", "tomorrow")), HasSubstr("exp"));
  EXPECT_THAT(why(with("exp", kNow - kClockLeeway_s)), HasSubstr("expired"));
  EXPECT_TRUE(client(with("exp", kNow - kClockLeeway_s + 1)));
  EXPECT_TRUE(client(with("exp", 1e300)));
  EXPECT_THAT(why(with("nbf", kNow + kClockLeeway_s + 1)), HasSubstr("nbf"));
  EXPECT_THAT(why(with("nbf", "now")), HasSubstr("nbf"));
  EXPECT_TRUE(client(with("nbf", kNow + kClockLeeway_s)));
  EXPECT_TRUE(client(without("nbf")));
}

TEST_F(TokensTest, TheSubjectIsTheClient) {
  EXPECT_THAT(why(without("sub")), HasSubstr("sub"));
  EXPECT_THAT(why(with("sub", "")), HasSubstr("sub"));
  EXPECT_THAT(why(with("sub", 7)), HasSubstr("sub"));
  EXPECT_THAT(why(with("sub", std::string(256, 's'))), HasSubstr("sub"));
  EXPECT_THAT(why(with("sub", std::string("a\0b", 3))), HasSubstr("sub"));
}

TEST_F(TokensTest, TheHighestRoleOfTheClaimCounts) {
  EXPECT_EQ(role(with("roles", {"citymesh:read-own", "citymesh:admin", "citymesh:submit"})),
            Role::Admin);
  EXPECT_EQ(role(with("roles", "openid citymesh:read-own  profile")), Role::ReadOwn);
  // Those of other services do not.
  EXPECT_EQ(role(with("roles", {"admin", "xcitymesh:admin", "citymesh:", "citymesh:root", 7})),
            Role::None);
  EXPECT_EQ(role(without("roles")), Role::None);
  EXPECT_EQ(role(with("roles", {{"citymesh:admin", true}})), Role::None);
}

TEST_F(TokensTest, TheRoleClaimMayLieDeeperOrHaveDotsInItsName) {
  rules_.role_claim = "realm_access.roles";
  rules_.role_prefix = "";
  EXPECT_EQ(role(with("realm_access", {{"roles", {"submit"}}})), Role::Submit);
  EXPECT_EQ(role(with("realm_access", {"submit"})), Role::None);
  EXPECT_EQ(role(claims()), Role::None);
  rules_.role_claim = "https://city.test/roles";
  EXPECT_EQ(role(with("https://city.test/roles", "admin")), Role::Admin);
}

TEST(JwksTest, KeysOfOtherKindsAndPurposesArePassedOver) {
  const auto usable = TokenIssuer(TokenIssuer::Kind::P256, "ec").jwk();
  auto encrypts = json::parse(usable);
  encrypts["use"] = "enc";
  auto other = json::parse(usable);
  other["alg"] = "ES384";
  const auto keys = parse_jwks(fmt::format(
      R"({{"keys":[{{"kty":"oct","k":"c2VjcmV0"}},{},{},{{"kty":"EC","crv":"P-521"}},7,{}]}})",
      encrypts.dump(), other.dump(), usable));
  ASSERT_TRUE(keys) << keys.error().message;
  ASSERT_EQ(keys->size(), 1u);
  EXPECT_EQ(keys->front().id, "ec");
  EXPECT_EQ(keys->front().algorithm, "ES256");
}

TEST(JwksTest, WhatIsNoSetOfUsableKeysIsRefused) {
  auto off_the_curve = json::parse(TokenIssuer(TokenIssuer::Kind::P256).jwk());
  off_the_curve["y"] = off_the_curve["x"];
  auto short_point = off_the_curve;
  short_point["x"] = "AAAA";
  auto even = json::parse(rsa().jwk());
  even["e"] = "Ag";
  const auto set = [](const json& key) { return json{{"keys", {key}}}.dump(); };
  for (const auto& text :
       {std::string(), std::string("[]"), std::string("{}"), std::string(R"({"keys":{}})"),
        std::string(R"({"keys":[]})"), std::string(R"({"keys":[{"kty":"oct","k":"c2VjcmV0"}]})"),
        std::string(R"({"keys":[{"kty":"RSA"}]})"), set(off_the_curve), set(short_point), set(even),
        TokenIssuer(TokenIssuer::Kind::Rsa, "short", 1024).jwks()}) {
    const auto keys = parse_jwks(text);
    ASSERT_FALSE(keys) << text;
    EXPECT_EQ(keys.error().code, ErrorCode::InvalidArgument);
  }
}

}  // namespace
}  // namespace citymesh
