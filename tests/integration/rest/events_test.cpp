#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class EventsOverSocket : public RestOverSocket {
 protected:
  std::string submit() {
    const auto created = send(request("POST", "/processes/export-for-simulation/execution", kBox));
    return json::parse(created.body)["jobID"];
  }
};

TEST_F(EventsOverSocket, ComeWhileTheJobRunsAndEndWithIt) {
  start();
  const auto id = submit();
  Connection stream(port_);
  stream.send(request("GET", "/jobs/" + id + "/events"));
  const auto head = stream.read(true);
  EXPECT_EQ(head->headers.at("content-type"), "text/event-stream");
  EXPECT_EQ(head->headers.at("connection"), "close");
  EXPECT_FALSE(head->headers.contains("content-length"));
  EXPECT_THAT(stream.read_until("\"accepted\""), HasSubstr("event: status"));
  const auto claim = service_.start();
  EXPECT_THAT(stream.read_until("\"running\""), HasSubstr("id: "));
  service_.succeed(claim, JobService::export_files());
  EXPECT_THAT(stream.read_to_end(), HasSubstr("\"successful\""));
}

TEST_F(EventsOverSocket, TakeNoThreadAndAClientThatLeavesDisturbsNobody) {
  start({.io_threads = 1, .handler_threads = 1});
  const auto id = submit();
  std::vector<std::unique_ptr<Connection>> streams;
  for (int i = 0; i < 100; ++i) {
    streams.push_back(std::make_unique<Connection>(port_));
    streams.back()->send(request("GET", "/jobs/" + id + "/events"));
    streams.back()->read_until("\"accepted\"");
  }
  streams.resize(50);
  expect_still_working();
  service_.succeed(service_.start(), JobService::export_files());
  for (const auto& stream : streams)
    EXPECT_THAT(stream->read_to_end(), HasSubstr("\"successful\""));
  expect_still_working();
}

TEST_F(EventsOverSocket, EndWhenTheServerStops) {
  start();
  Connection stream(port_);
  stream.send(request("GET", "/jobs/" + submit() + "/events"));
  stream.read_until("\"accepted\"");
  server_->stop();
  EXPECT_THAT(stream.read_to_end(), ::testing::Not(HasSubstr("event:")));
}

TEST_F(EventsOverSocket, HeadHasNoEvents) {
  start();
  const auto id = submit();
  Connection connection(port_);
  connection.send(request("HEAD", "/jobs/" + id + "/events"));
  EXPECT_EQ(connection.read(true)->headers.at("content-type"), "text/event-stream");
  EXPECT_TRUE(connection.is_closed());
}

}  // namespace
}  // namespace citymesh
