#include "services/access/issuer_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "services/access/access.h"
#include "tests/support/http_receiver.h"
#include "tests/unit/access/token_issuer.h"

namespace citymesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class FetchedKeys : public testing::Test {
 protected:
  IssuerKeyOptions options(std::chrono::milliseconds pause = std::chrono::hours(1)) {
    return {.source = provider_.url("/jwks"),
            .timeout_s = 20,
            .pause = pause,
            .longest_age = std::chrono::hours(1)};
  }
  void publish(const TokenIssuer& issuer) { provider_.answer("200 OK", issuer.jwks()); }
  std::unique_ptr<IssuerKeys> opened(IssuerKeyOptions options) {
    auto keys = IssuerKeys::open(std::move(options));
    EXPECT_TRUE(keys) << keys.error().message;
    return keys ? *std::move(keys) : nullptr;
  }
  std::string why_not() {
    const auto keys = IssuerKeys::open(options());
    EXPECT_FALSE(keys);
    return keys ? "" : keys.error().message;
  }
  int fetches() {
    int count = 0;
    while (!provider_.is_quiet()) count += provider_.next().has_value() ? 1 : 0;
    return count;
  }

  HttpReceiver provider_;
  const TokenIssuer first_{TokenIssuer::Kind::P256, "first"};
  const TokenIssuer second_{TokenIssuer::Kind::P256, "second"};
};

TEST_F(FetchedKeys, AreThereWhenTheServiceStarts) {
  publish(first_);
  const auto keys = opened(options());
  ASSERT_EQ(keys->current()->size(), 1u);
  EXPECT_EQ(keys->current()->at(0).id, "first");
  EXPECT_THAT(provider_.next().value_or(""), StartsWith("GET /jwks HTTP/1.1\r\n"));
}

TEST_F(FetchedKeys, ThatCannotBeHadEndTheStartWithTheReason) {
  provider_.answer("500 No");
  EXPECT_THAT(why_not(), AllOf(HasSubstr(provider_.url("/jwks")), HasSubstr("500")));
  provider_.answer("302 Found\r\nLocation: /elsewhere");
  EXPECT_THAT(why_not(), HasSubstr("302"));
  provider_.answer("200 OK", "{}");
  EXPECT_THAT(why_not(), HasSubstr("JSON Web Key Set"));
  provider_.answer("200 OK", std::string((1 << 20) + 1, ' '));
  EXPECT_THAT(why_not(), HasSubstr("longer than"));
  EXPECT_EQ(fetches(), 4);  // none of them of /elsewhere
}

TEST_F(FetchedKeys, ComeInPlainTextFromThisMachineOnly) {
  const auto keys = IssuerKeys::open({.source = "http://192.0.2.1/jwks", .timeout_s = 20});
  ASSERT_FALSE(keys);
  EXPECT_THAT(keys.error().message, HasSubstr("https://"));
}

TEST_F(FetchedKeys, AreFetchedAgainForAnUnknownOneButNotAtOnce) {
  publish(first_);
  const auto patient = opened(options());
  EXPECT_EQ(patient->look_again()->at(0).id, "first");
  EXPECT_EQ(fetches(), 1);

  publish(first_);
  const auto keys = opened(options(std::chrono::milliseconds(0)));
  publish(second_);
  EXPECT_EQ(keys->look_again()->at(0).id, "second");
  EXPECT_EQ(keys->current()->at(0).id, "second");
  EXPECT_EQ(fetches(), 2);
}

TEST_F(FetchedKeys, StayInForceWhenFetchingFails) {
  publish(first_);
  auto old = options(std::chrono::milliseconds(0));
  old.longest_age = std::chrono::milliseconds(0);
  const auto keys = opened(old);
  provider_.answer("503 No");
  EXPECT_EQ(keys->look_again()->at(0).id, "first");
  provider_.answer("200 OK", "nonsense");
  EXPECT_FALSE(keys->reload());
  EXPECT_EQ(keys->current()->at(0).id, "first");
  publish(second_);
  EXPECT_TRUE(*keys->reload());
  EXPECT_EQ(keys->current()->at(0).id, "second");
}

TEST_F(FetchedKeys, AreNotFetchedAgainBeforeTheyAreOld) {
  publish(first_);
  const auto keys = opened(options());
  EXPECT_FALSE(*keys->reload());
  EXPECT_EQ(fetches(), 1);
}

TEST_F(FetchedKeys, OfAProviderThatChangesItsKeysAreTakenWithTheFirstTokenOfTheNewOne) {
  publish(first_);
  const auto access = *Access::open({.oidc_jwks = options(std::chrono::milliseconds(0)),
                                     .token_rules = {.issuer = "i", .audience = "a"}});
  EXPECT_TRUE(access->is_required());
  const auto claims = nlohmann::json{
      {"iss", "i"},
      {"aud", "a"},
      {"sub", "alice"},
      {"exp", std::time(nullptr) + 100},
      {"roles",
       "citymesh:submit"}}.dump();
  EXPECT_TRUE(access->identify({.authorization = "Bearer " + first_.token(claims)}));
  EXPECT_EQ(fetches(), 1);
  publish(second_);
  EXPECT_TRUE(access->identify({.authorization = "Bearer " + second_.token(claims)}));
  EXPECT_EQ(fetches(), 1);
  publish(second_);
  EXPECT_FALSE(access->identify({.authorization = "Bearer " + first_.token(claims)}));
}

}  // namespace
}  // namespace citymesh
