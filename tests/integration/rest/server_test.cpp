#include "services/rest/server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string large_text(std::size_t bytes) {
  std::string text;
  text.reserve(bytes + 32);
  for (std::size_t line = 0; text.size() < bytes; ++line)
    text += fmt::format("v {0} {0} 0\n", line);
  return text;
}

TEST_F(RestOverSocket, JobCycleFromExecutionToDownload) {
  start();
  const auto created = send(request("POST", "/processes/export-for-simulation/execution", kBox));
  ASSERT_EQ(created.status, 201);
  const auto id = json::parse(created.body)["jobID"].get<std::string>();
  EXPECT_EQ(created.headers.at("location"), "http://localhost/jobs/" + id);

  service_.succeed(service_.start(), JobService::export_files());
  const auto status = json::parse(send(request("GET", "/jobs/" + id)).body);
  EXPECT_EQ(status["status"], "successful");
  const auto file = send(request("GET", "/jobs/" + id + "/results/obj"));
  EXPECT_EQ(file.headers.at("content-type"), "model/obj");
  EXPECT_EQ(file.body, "o b_1\nv 0 0 0\n");
}

TEST_F(RestOverSocket, HealIsAProcessWhoseModelIsFetched) {
  start();
  EXPECT_THAT(send(request("GET", "/processes/heal")).body, HasSubstr("max_hole_area_m2"));
  const auto created = send(request("POST", "/processes/heal/execution", kBox, kAsync));
  ASSERT_EQ(created.status, 201);
  const auto id = json::parse(created.body)["jobID"].get<std::string>();
  service_.succeed(service_.start(), {{"cityjson", "model.city.json", "application/city+json",
                                       R"({"type":"CityJSON"})"}});
  const auto file = send(request("GET", "/jobs/" + id + "/results/cityjson"));
  EXPECT_EQ(file.headers.at("content-type"), "application/city+json");
  EXPECT_EQ(file.body, R"({"type":"CityJSON"})");
  const auto refused =
      send(request("POST", "/processes/heal/execution", R"({"inputs":{"parts":"split"}})"));
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("`parts`"));
}

TEST_F(RestOverSocket, ConnectionIsKeptAliveAndClosedWhenAskedTo) {
  start();
  Connection connection(port_);
  for (int i = 0; i < 3; ++i) {
    connection.send(request("GET", "/healthz"));
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->headers.at("connection"), "keep-alive");
  }
  connection.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(connection.read()->headers.at("connection"), "close");
  EXPECT_TRUE(connection.is_closed());
}

TEST_F(RestOverSocket, PipelinedRequestsAreAnsweredInOrder) {
  start();
  Connection connection(port_);
  connection.send(request("GET", "/healthz") + request("GET", "/nothing") +
                  request("POST", "/processes/validate/execution", "{}", kAsync) +
                  request("GET", "/readyz"));
  EXPECT_EQ(connection.read()->body, "ok\n");
  EXPECT_EQ(connection.read()->status, 404);
  EXPECT_EQ(connection.read()->status, 201);
  EXPECT_EQ(connection.read()->body, "ready\n");
}

TEST_F(RestOverSocket, GarbageAfterAPipelinedRequestDoesNotSpoilItsAnswer) {
  start();
  Connection connection(port_);
  connection.send(request("GET", "/healthz") + "\x16\x03\x01 garbage\r\n\r\n");
  EXPECT_EQ(connection.read()->status, 200);
  EXPECT_EQ(connection.read()->status, 400);
  EXPECT_TRUE(connection.is_closed());
  expect_still_working();
}

TEST_F(RestOverSocket, HeadHasTheHeadersOfGetAndNoBody) {
  start();
  Connection connection(port_);
  connection.send(request("HEAD", "/healthz") + request("GET", "/healthz"));
  const auto head = connection.read(true);
  EXPECT_EQ(head->headers.at("content-length"), "3");
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(RestOverSocket, AnswersWithoutABodyHaveNoContentLength) {
  start();
  Connection connection(port_);
  connection.send(request("OPTIONS", "/jobs") + request("GET", "/healthz"));
  const auto options = connection.read();
  EXPECT_EQ(options->status, 204);
  EXPECT_FALSE(options->headers.contains("content-length"));
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(RestOverSocket, WhatIsNotHttpIsRefused) {
  start();
  for (const auto* bytes :
       {"GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "G\x01T / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost localhost\r\n\r\n",
        "POST /jobs HTTP/1.1\r\nHost: h\r\nContent-Length: -1\r\n\r\n",
        "POST /jobs HTTP/1.1\r\nHost: h\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n",
        "GET / HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"}) {
    const auto answer = send(bytes);
    EXPECT_EQ(answer.status, 400) << bytes;
    EXPECT_EQ(answer.headers.at("content-type"), "application/problem+json");
    expect_still_working();
  }
}

TEST_F(RestOverSocket, OversizeBodiesAreRefusedWhetherAnnouncedOrChunked) {
  start({.max_body_bytes = 1000});
  const std::string head = "POST /processes/validate/execution HTTP/1.1\r\nHost: localhost\r\n";
  const auto announced = send(head + "Content-Length: 99999999999\r\n\r\n");
  EXPECT_EQ(announced.status, 413);
  EXPECT_THAT(announced.body, HasSubstr("larger than 1000 bytes"));
  expect_still_working();

  std::string chunks;
  for (int i = 0; i < 100; ++i) chunks += "40\r\n" + std::string(64, ' ') + "\r\n";
  EXPECT_EQ(send(head + "Transfer-Encoding: chunked\r\n\r\n" + chunks + "0\r\n\r\n").status, 413);
  expect_still_working();
}

TEST_F(RestOverSocket, ChunkedBodyWithinTheLimitIsTaken) {
  start();
  EXPECT_EQ(send("POST /processes/validate/execution HTTP/1.1\r\nHost: localhost\r\n"
                 "Prefer: respond-async\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n")
                .status,
            201);
}

TEST_F(RestOverSocket, OversizeHeaderIsRefused) {
  start({.max_header_bytes = 2000});
  const auto answer =
      send("GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: " + std::string(5000, 'x') + "\r\n\r\n");
  EXPECT_EQ(answer.status, 431);
  EXPECT_THAT(answer.body, HasSubstr("larger than 2000 bytes"));
  expect_still_working();
}

TEST_F(RestOverSocket, ExpectContinueIsAnsweredBeforeTheBodyIsSent) {
  start();
  Connection connection(port_);
  connection.send(
      "POST /processes/validate/execution HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n"
      "Prefer: respond-async\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(connection.read()->status, 100);
  connection.send("{}");
  EXPECT_EQ(connection.read()->status, 201);
}

TEST_F(RestOverSocket, SlowHeadersAndSlowBodiesAreCutOff) {
  start({.header_timeout_s = 0.2, .body_timeout_s = 0.2});
  Connection header(port_), body(port_), idle(port_);
  header.send("GET / HTTP/1.1\r\nHo");
  body.send("POST /processes/validate/execution HTTP/1.1\r\nHost: h\r\nContent-Length: 2\r\n\r\n{");
  EXPECT_TRUE(header.is_closed());
  EXPECT_TRUE(body.is_closed());
  EXPECT_TRUE(idle.is_closed());
  expect_still_working();
}

TEST_F(RestOverSocket, HalfClosedClientStillGetsItsAnswer) {
  start();
  Connection connection(port_);
  connection.send(request("GET", "/healthz"));
  connection.half_close();
  EXPECT_EQ(connection.read()->body, "ok\n");
  EXPECT_TRUE(connection.is_closed());
}

TEST_F(RestOverSocket, LargeResultIsStreamedByteForByte) {
  start();
  const auto content = large_text(24 << 20);
  const auto id = finished_job({{"obj", "model.obj", "model/obj", content}});
  const auto answer = send(request("GET", "/jobs/" + id + "/results/obj"));
  EXPECT_EQ(answer.body.size(), content.size());
  EXPECT_TRUE(answer.body == content);
}

TEST_F(RestOverSocket, ClientThatLeavesDuringADownloadDisturbsNobody) {
  start();
  const auto id = finished_job({{"obj", "model.obj", "model/obj", large_text(24 << 20)}});
  for (int i = 0; i < 5; ++i) {
    Connection connection(port_);
    connection.send(request("GET", "/jobs/" + id + "/results/obj"));
    ASSERT_TRUE(connection.read(true));
  }
  expect_still_working();
}

TEST_F(RestOverSocket, MoreConnectionsThanAllowedAreToldSo) {
  start({.max_connections = 2});
  Connection first(port_), second(port_);
  for (auto* connection : {&first, &second}) {
    connection->send(request("GET", "/healthz"));
    EXPECT_EQ(connection->read()->status, 200);
  }
  Connection third(port_);
  const auto refused = third.read();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_TRUE(refused->headers.contains("retry-after"));
  first.send(request("GET", "/healthz"));
  EXPECT_EQ(first.read()->status, 200);
}

TEST_F(RestOverSocket, ManyClientsAtOnceAreServed) {
  start();
  std::vector<std::thread> clients;
  std::atomic<int> answered = 0;
  for (int i = 0; i < 16; ++i)
    clients.emplace_back([&] {
      Connection connection(port_);
      for (int j = 0; j < 20; ++j) {
        connection.send(j % 4 == 0 ? request("POST", "/processes/validate/execution", "{\"x")
                                   : request("GET", "/jobs"));
        const auto answer = connection.read();
        if (answer && answer->status == (j % 4 == 0 ? 400 : 200)) ++answered;
      }
    });
  for (auto& client : clients) client.join();
  EXPECT_EQ(answered, 16 * 20);
}

TEST_F(RestOverSocket, StopLetsADownloadFinishAndClosesIdleConnections) {
  start();
  const auto content = large_text(8 << 20);
  const auto id = finished_job({{"obj", "model.obj", "model/obj", content}});
  Connection idle(port_), downloading(port_);
  downloading.send(request("GET", "/jobs/" + id + "/results/obj"));
  ASSERT_EQ(downloading.read(true)->status, 200);

  std::thread stopping([this] { server_->stop(); });
  EXPECT_TRUE(idle.is_closed());
  EXPECT_EQ(downloading.read_to_end().size(), content.size());
  stopping.join();
}

TEST_F(RestOverSocket, StopEndsAClientThatReadsNothing) {
  start({.drain_timeout_s = 0.1});
  const auto id = finished_job({{"obj", "model.obj", "model/obj", large_text(24 << 20)}});
  Connection stuck(port_);
  stuck.send(request("GET", "/jobs/" + id + "/results/obj"));
  ASSERT_TRUE(stuck.read(true));
  server_->stop();
  server_->stop();
  SUCCEED();
}

TEST_F(RestOverSocket, TakenPortAndWrongAddressAreErrors) {
  start();
  RestServer second(service_.jobs(), service_.metrics(), {.port = port_});
  const auto taken = second.start();
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(taken.error().message, HasSubstr(std::to_string(port_)));

  RestServer nowhere(service_.jobs(), service_.metrics(), {.host = "no such host", .port = 0});
  const auto wrong = nowhere.start();
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace citymesh
