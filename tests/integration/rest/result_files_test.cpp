#include <gtest/gtest.h>

#include <string>

#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

class ResultFileOverSocket : public RestOverSocket {
 protected:
  void SetUp() override {
    start();
    while (content_.size() < (3 << 20)) content_ += fmt::format("v {0} {0} 0\n", content_.size());
    file_ = "/jobs/" + finished_job({{"obj", "model.obj", "model/obj", content_}}) + "/results/obj";
  }
  std::string get(std::string_view fields) const { return request("GET", file_, {}, fields); }

  std::string content_, file_;
};

TEST_F(ResultFileOverSocket, ABrokenDownloadIsResumedWhereItBroke) {
  std::string part, etag;
  {
    Connection broken(port_);
    broken.send(get(""));
    const auto head = broken.read(true);
    etag = head->headers.at("etag");
    part = content_.substr(0, 1'000'001);  // what the client kept
  }
  const auto rest =
      send(get(fmt::format("Range: bytes={}-\r\nIf-Range: {}\r\n", part.size(), etag)));
  EXPECT_EQ(rest.status, 206);
  EXPECT_EQ(rest.headers.at("content-range"),
            fmt::format("bytes {}-{}/{}", part.size(), content_.size() - 1, content_.size()));
  EXPECT_TRUE(part + rest.body == content_);
}

TEST_F(ResultFileOverSocket, AnswersToConditionsKeepTheConnectionInStep) {
  const auto etag = send(get("")).headers.at("etag");
  Connection connection(port_);
  connection.send(get("If-None-Match: " + etag + "\r\n") + get("Range: bytes=99999999-\r\n") +
                  get("Range: bytes=0-9\r\n") + request("HEAD", file_, {}, "Range: bytes=0-9\r\n") +
                  request("GET", "/healthz"));
  const auto unchanged = connection.read();
  EXPECT_EQ(unchanged->status, 304);
  EXPECT_FALSE(unchanged->headers.contains("content-length"));
  const auto outside = connection.read();
  EXPECT_EQ(outside->status, 416);
  EXPECT_EQ(outside->headers.at("content-range"), fmt::format("bytes */{}", content_.size()));
  EXPECT_EQ(outside->headers.at("content-type"), "application/problem+json");
  const auto first = connection.read();
  EXPECT_EQ(first->status, 206);
  EXPECT_EQ(first->body, content_.substr(0, 10));
  const auto head = connection.read(true);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->headers.at("content-length"), std::to_string(content_.size()));
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(ResultFileOverSocket, HeadersThatMakeNoSenseDoNoHarm) {
  for (const auto* fields :
       {"Range: bytes=9-1\r\n", "Range: bytes=\r\nRange: bytes=1-2\r\n", "Range: \x80\xff\r\n",
        "If-None-Match: \"\r\n", "If-Range: ,,,\r\nRange: bytes=0-1\r\n"}) {
    const auto answer = send(get(fields));
    EXPECT_EQ(answer.status, 200) << fields;
    EXPECT_TRUE(answer.body == content_) << fields;
    expect_still_working();
  }
  const auto many = "Range: bytes=" + std::string(20'000, '0') + "-\r\n";
  EXPECT_EQ(send(get(many)).status, 431);
  expect_still_working();
}

}  // namespace
}  // namespace citymesh
