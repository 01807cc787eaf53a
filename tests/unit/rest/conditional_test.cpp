#include "services/rest/conditional.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

const std::string kObj = "o b_1\nv 0 0 0\n";  // of JobService

class RestFile : public RestApi {
 protected:
  RestFile() : file_("/jobs/" + finished(kBox) + "/results/obj") {}
  std::string etag() { return get(file_).headers.get("ETag"); }

  const std::string file_;
};

TEST_F(RestFile, SaysThatItTakesRangesAndMayBeKept) {
  const auto response = get(file_);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.headers.get("Accept-Ranges"), "bytes");
  EXPECT_EQ(response.headers.get("Cache-Control"), "private, no-cache");
  EXPECT_THAT(response.headers.get("ETag"), ::testing::MatchesRegex("\"[0-9a-f-]+\""));
  EXPECT_EQ(etag(), etag());
}

TEST_F(RestFile, OfAnotherJobHasAnotherTag) {
  const auto other = get("/jobs/" + finished(kBox) + "/results/obj").headers.get("ETag");
  EXPECT_NE(other, etag());
}

TEST_F(RestFile, RangesAreServedAsAskedFor) {
  const struct {
    const char *range, *content_range, *bytes;
  } kCases[] = {
      {"bytes=0-4", "bytes 0-4/14", "o b_1"},
      {"bytes=6-", "bytes 6-13/14", "v 0 0 0\n"},
      {"bytes=-2", "bytes 12-13/14", "0\n"},
      {"bytes=0-0", "bytes 0-0/14", "o"},
      {"bytes=9-9999", "bytes 9-13/14", " 0 0\n"},
      {"BYTES=13-13", "bytes 13-13/14", "\n"},
      {"bytes=-9999", "bytes 0-13/14", "o b_1\nv 0 0 0\n"},
      {"bytes=10-99999999999999999999999", "bytes 10-13/14", "0 0\n"},
  };
  for (const auto& [range, content_range, bytes] : kCases) {
    const auto response = get(file_, {{"Range", range}});
    EXPECT_EQ(response.status, 206) << range;
    EXPECT_EQ(response.headers.get("Content-Range"), content_range) << range;
    EXPECT_EQ(response.headers.get("Content-Type"), "model/obj");
    EXPECT_EQ(response.headers.get("ETag"), etag());
    EXPECT_EQ(body_bytes(response), std::string_view(bytes).size()) << range;
    EXPECT_EQ(text(response), bytes) << range;
  }
}

TEST_F(RestFile, PiecesMakeUpTheWhole) {
  std::string whole;
  for (std::size_t at = 0; at < kObj.size(); at += 4)
    whole +=
        text(get(file_, {{"Range", "bytes=" + std::to_string(at) + "-" + std::to_string(at + 3)}}));
  EXPECT_EQ(whole, kObj);
}

TEST_F(RestFile, RangesOutsideOfItAreRefusedWithItsSize) {
  for (const auto* range :
       {"bytes=14-", "bytes=99-100", "bytes=-0", "bytes=99999999999999999999999-"}) {
    const auto response = get(file_, {{"Range", range}});
    EXPECT_EQ(response.headers.get("Content-Range"), "bytes */14") << range;
    EXPECT_THAT(detail(response, 416), HasSubstr("14 bytes")) << range;
  }
}

TEST_F(RestFile, WhatIsNoSingleRangeIsIgnored) {
  for (const auto* range :
       {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-1", "bytes=1-2,4-5", "lines=1-2",
        "bytes=1", "bytes=--1", "bytes=+1-2", "bytes=0x1-2", "bytes=1-2-3", "bytes = 0-1"}) {
    const auto response = get(file_, {{"Range", range}});
    EXPECT_EQ(response.status, 200) << range;
    EXPECT_EQ(text(response), kObj) << range;
  }
}

TEST_F(RestFile, RangeOfAnotherVersionIsAnsweredWithTheWhole) {
  const auto with = [&](std::string version) {
    return get(file_, {{"Range", "bytes=0-4"}, {"If-Range", std::move(version)}}).status;
  };
  EXPECT_EQ(with(etag()), 206);
  EXPECT_EQ(with("\"another\""), 200);
  EXPECT_EQ(with("W/" + etag()), 200) << "a weak tag promises no equal bytes";
  EXPECT_EQ(with("Sun, 06 Nov 1994 08:49:37 GMT"), 200);
}

TEST_F(RestFile, IsNotSentToAClientThatHasIt) {
  for (const auto& tags : {etag(), "W/" + etag(), "\"a,b\", " + etag(), std::string("*")}) {
    const auto response = get(file_, {{"If-None-Match", tags}});
    EXPECT_EQ(response.status, 304) << tags;
    EXPECT_TRUE(response.body.empty());
    EXPECT_EQ(response.headers.get("ETag"), etag());
    EXPECT_EQ(response.headers.get("Cache-Control"), "private, no-cache");
  }
  for (const auto* tags : {"\"another\"", "", "garbage", "\"a\",,\""})
    EXPECT_EQ(get(file_, {{"If-None-Match", tags}}).status, 200) << tags;
  EXPECT_EQ(get(file_, {{"If-None-Match", etag()}, {"Range", "bytes=99-"}}).status, 304);
}

TEST_F(RestFile, IsNotSentWhenTheClientExpectsAnotherOne) {
  EXPECT_EQ(get(file_, {{"If-Match", etag()}}).status, 200);
  EXPECT_EQ(get(file_, {{"If-Match", "*"}}).status, 200);
  EXPECT_THAT(detail(get(file_, {{"If-Match", "\"another\""}}), 412), HasSubstr("another"));
}

TEST_F(RestFile, HeadHasNoRanges) {
  const auto response = send("HEAD", file_, {}, {{"Range", "bytes=0-4"}});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body_bytes(response), kObj.size());
  EXPECT_EQ(send("HEAD", file_, {}, {{"If-None-Match", etag()}}).status, 304);
}

TEST_F(RestFile, RawResultOfOneOutputTakesTheSameConditions) {
  const auto results = "/jobs/" + finished(R"({"outputs":{"obj":{}}})") + "/results";
  EXPECT_EQ(text(get(results, {{"Range", "bytes=0-4"}})), "o b_1");
  EXPECT_EQ(get(results, {{"If-None-Match", get(results).headers.get("ETag")}}).status, 304);
}

TEST_F(RestFile, DocumentsAreNotCutIntoRanges) {
  const auto response =
      get(file_.substr(0, file_.rfind('/')), {{"Range", "bytes=0-4"}, {"If-None-Match", "*"}});
  EXPECT_EQ(response.status, 200);
  EXPECT_FALSE(response.headers.has("ETag"));
}

TEST_F(RestFile, OptionsTellWhatIsPossible) {
  const auto options = send("OPTIONS", file_);
  EXPECT_EQ(options.status, 204);
  EXPECT_EQ(options.headers.get("Allow"), "GET, HEAD, OPTIONS");
}

TEST_F(RestFile, EveryResourceThatCanBeGotAnswersHead) {
  const auto job = file_.substr(0, file_.find("/results"));
  for (const auto& path :
       {std::string("/"), std::string("/api"), std::string("/conformance"),
        std::string("/processes"), std::string("/processes/heal"), std::string("/jobs"), job,
        job + "/results", file_, std::string("/healthz"), std::string("/readyz"),
        std::string("/metrics")}) {
    const auto head = send("HEAD", path);
    EXPECT_EQ(head.status, 200) << path;
    EXPECT_EQ(head.headers.get("Content-Type"), get(path).headers.get("Content-Type")) << path;
    EXPECT_THAT(send("OPTIONS", path).headers.get("Allow"), HasSubstr("HEAD")) << path;
  }
}

}  // namespace
}  // namespace citymesh
