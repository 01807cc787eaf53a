#include "services/rest/origin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace citymesh {
namespace {

using testing::HasSubstr;

using Fields = std::vector<std::pair<std::string, std::string>>;

Result<Origin> origin(const std::string& peer, const Fields& fields,
                      std::string_view public_url = {}, bool secure = false) {
  Request request;
  request.peer = peer;
  request.secure = secure;
  request.headers.set("Host", "10.0.0.5:8080");
  for (const auto& [name, value] : fields) request.headers.add(name, value);
  return origin_of(request, *Networks::parse("10.0.0.0/8"), public_url);
}

std::string base(const Fields& fields) {
  const auto found = origin("10.0.0.1", fields);
  EXPECT_TRUE(found) << found.error().message;
  return found ? found->base : "";
}

TEST(OriginTest, WithoutAProxyItIsTheConnection) {
  const auto plain = origin("203.0.113.9", {});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->base, "http://10.0.0.5:8080");
  EXPECT_EQ(plain->client, "203.0.113.9");
  EXPECT_EQ(origin("203.0.113.9", {}, {}, true)->base, "https://10.0.0.5:8080");
}

TEST(OriginTest, HeadersOfStrangersDoNotCount) {
  const auto found =
      origin("203.0.113.9", {{"Forwarded", "for=192.0.2.1;host=evil.test;proto=https"},
                             {"X-Forwarded-For", "192.0.2.1"},
                             {"X-Forwarded-Proto", "https"},
                             {"X-Forwarded-Host", "evil.test"},
                             {"X-Forwarded-Prefix", "/evil"}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->base, "http://10.0.0.5:8080");
  EXPECT_EQ(found->client, "203.0.113.9");
}

TEST(OriginTest, AProxySaysWhatItsClientSent) {
  const Fields customary{{"X-Forwarded-For", "203.0.113.9"},
                         {"X-Forwarded-Proto", "https"},
                         {"X-Forwarded-Host", "city.test"},
                         {"X-Forwarded-Prefix", "/mesh/"}};
  EXPECT_EQ(base(customary), "https://city.test/mesh");
  EXPECT_EQ(origin("10.0.0.1", customary)->client, "203.0.113.9");
  const Fields standard{
      {"Forwarded", R"(for="[2001:db8::9]:4711" ; Proto=https;host="city.test:8443")"}};
  EXPECT_EQ(base(standard), "https://city.test:8443");
  EXPECT_EQ(origin("10.0.0.1", standard)->client, "2001:db8::9");
}

TEST(OriginTest, TheStandardHeaderCountsBeforeTheCustomaryOnes) {
  EXPECT_EQ(base({{"Forwarded", "for=203.0.113.9;proto=https;host=a.test"},
                  {"X-Forwarded-Host", "b.test"}}),
            "https://a.test");
}

TEST(OriginTest, OfSeveralTrustedProxiesTheOutermostCounts) {
  EXPECT_EQ(base({{"X-Forwarded-For", "203.0.113.9, 10.0.0.2"},
                  {"X-Forwarded-Proto", "https, http"},
                  {"X-Forwarded-Host", "city.test, inner.test"}}),
            "https://city.test");
  // One header for both, as an inner proxy that leaves it alone passes it on.
  EXPECT_EQ(base({{"X-Forwarded-For", "203.0.113.9, 10.0.0.2"}, {"X-Forwarded-Proto", "https"}}),
            "https://10.0.0.5:8080");
}

TEST(OriginTest, WhatAClientWritesInFrontOfTheProxyDoesNotCount) {
  EXPECT_EQ(base({{"X-Forwarded-For", "10.0.0.9, 203.0.113.9"},
                  {"X-Forwarded-Proto", "http, https"},
                  {"X-Forwarded-Host", "evil.test, city.test"}}),
            "https://city.test");
  EXPECT_EQ(base({{"Forwarded", "for=10.0.0.9;host=evil.test, for=203.0.113.9;host=city.test"}}),
            "http://city.test");
}

TEST(OriginTest, WhatCannotStandInLinksIsRefusedByName) {
  for (const auto& [name, value] : Fields{{"X-Forwarded-Host", "a b"},
                                          {"X-Forwarded-Host", "evil.test/path"},
                                          {"X-Forwarded-Prefix", "no/slash"},
                                          {"X-Forwarded-Prefix", "//evil.test"},
                                          {"X-Forwarded-Prefix", "/a/../b"},
                                          {"X-Forwarded-Prefix", "/<script>"},
                                          {"X-Forwarded-Proto", "javascript"},
                                          {"Forwarded", "for=203.0.113.9;proto=ftp"}}) {
    const auto found = origin("10.0.0.1", {{name, value}});
    ASSERT_FALSE(found) << name << ": " << value;
    EXPECT_EQ(found.error().code, ErrorCode::InvalidArgument);
  }
}

TEST(OriginTest, BrokenHeadersSayNothing) {
  for (const auto* value : {"", ";", "=", ";;=,;", "for", "for=\"", "\"", ",,,"})
    EXPECT_EQ(base({{"Forwarded", value}}), "http://10.0.0.5:8080") << value;
}

TEST(OriginTest, APublicUrlIsTheBaseWhateverHeadersSay) {
  const auto found =
      origin("10.0.0.1", {{"X-Forwarded-For", "203.0.113.9"}, {"X-Forwarded-Host", "b.test"}},
             "https://city.test/x");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->base, "https://city.test/x");
  EXPECT_EQ(found->client, "203.0.113.9");
}

}  // namespace
}  // namespace citymesh
