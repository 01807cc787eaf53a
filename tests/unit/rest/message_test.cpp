#include "services/rest/message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace citymesh {
namespace {

using ::testing::ElementsAre;

TEST(Target, IsDecodedSegmentBySegmentSoThatAnEncodedSlashStaysInItsSegment) {
  const auto target = parse_target("/jobs/a%2Fb/results/?f=json&x=1%202+3");
  ASSERT_TRUE(target);
  EXPECT_THAT(target->segments, ElementsAre("jobs", "a/b", "results"));
  EXPECT_EQ(target->query.at("f"), "json");
  EXPECT_EQ(target->query.at("x"), "1 2 3");
}

TEST(Target, OfTheRootHasNoSegments) { EXPECT_TRUE(parse_target("/")->segments.empty()); }

TEST(Target, WithBadEncodingOrControlCharactersIsRefused) {
  for (const auto* text : {"", "jobs", "*", "http://host/jobs", "/%", "/%2", "/%zz", "/%00",
                           "/a%0ab", "/?x=%0d", "/?x=%f"})
    EXPECT_FALSE(parse_target(text)) << text;
}

TEST(Accept, TheMostSpecificRangeDecides) {
  const auto accept = "text/html;q=0.4, text/*;q=0.7, */*;q=0.1, application/json;q=0";
  EXPECT_DOUBLE_EQ(accept_quality(accept, "text/html"), 0.4);
  EXPECT_DOUBLE_EQ(accept_quality(accept, "text/plain"), 0.7);
  EXPECT_DOUBLE_EQ(accept_quality(accept, "model/obj"), 0.1);
  EXPECT_DOUBLE_EQ(accept_quality(accept, "application/json"), 0);
  EXPECT_DOUBLE_EQ(accept_quality("", "text/html"), 1);
}

TEST(Accept, NamesATypeOnlyWhenItIsWrittenOut) {
  EXPECT_TRUE(accept_names("text/html, Application/JSON;q=0.5", "application/json"));
  EXPECT_FALSE(accept_names("*/*", "application/json"));
  EXPECT_FALSE(accept_names("application/json;q=0", "application/json"));
}

TEST(Prefer, FindsAPreferenceAmongOthers) {
  EXPECT_TRUE(prefers("wait=10, Respond-Async", "respond-async"));
  EXPECT_FALSE(prefers("return=minimal", "respond-async"));
}

TEST(Prefer, GivesTheValueOfAPreference) {
  EXPECT_EQ(preference_value("respond-async, wait=10", "wait"), "10");
  EXPECT_EQ(preference_value("Wait = \"5\"; strict", "wait"), "5");
  EXPECT_EQ(preference_value("respond-async", "respond-async"), "");
  EXPECT_EQ(preference_value("wait=1, wait=2", "wait"), "1") << "the first one counts";
  EXPECT_EQ(preference_value("await=1", "wait"), std::nullopt);
}

TEST(Host, IsANameOrAddressWithAnOptionalPort) {
  for (const auto* host :
       {"localhost", "localhost:8080", "127.0.0.1:1", "[::1]:8080", "a-b.example"})
    EXPECT_TRUE(is_valid_host(host)) << host;
  for (const auto* host : {"", ":80", "a b", "a/b", "a\"b", "host:", "host:99999", "host:8x",
                           "[::1", "[::1]x", "a@b", "a,b", "<script>"})
    EXPECT_FALSE(is_valid_host(host)) << host;
}

TEST(Headers, CompareNamesWithoutCaseAndJoinRepeatedValues) {
  Headers headers;
  headers.add("Accept", "text/html");
  headers.add("ACCEPT", "*/*");
  EXPECT_EQ(headers.get("accept"), "text/html, */*");
  headers.set("accept", "text/plain");
  EXPECT_EQ(headers.get("Accept"), "text/plain");
}

TEST(Base64, MatchesTheExamplesOfRfc4648) {
  EXPECT_EQ(encode_base64(""), "");
  EXPECT_EQ(encode_base64("f"), "Zg==");
  EXPECT_EQ(encode_base64("fo"), "Zm8=");
  EXPECT_EQ(encode_base64("foo"), "Zm9v");
  EXPECT_EQ(encode_base64("foobar"), "Zm9vYmFy");
}

TEST(Body, OfAFileThatEndsEarlyIsAnError) {
  Response response;
  response.body.emplace_back(FilePiece{10, [](std::uint64_t offset, std::uint64_t) {
                                         return Result<std::string>(offset == 0 ? "abc" : "");
                                       }});
  const auto text = body_text(response);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::DataLoss);
}

}  // namespace
}  // namespace citymesh
