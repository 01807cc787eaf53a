#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

/// Sends one byte after the other, each well within any limit, until the server has had enough.
bool drips_for_ever(Connection& connection, char byte) {
  for (int i = 0; i < 1000; ++i) {
    if (!connection.send({&byte, 1})) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

TEST_F(RestOverSocket, AHeaderThatComesDropByDropIsNotWaitedFor) {
  start({.idle_timeout_s = 60, .header_timeout_s = 0.3});
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Slow: ");
  EXPECT_FALSE(drips_for_ever(connection, 'a'));
  expect_still_working();
}

TEST_F(RestOverSocket, ABodyThatComesDropByDropIsNotWaitedFor) {
  start({.header_timeout_s = 60, .body_timeout_s = 0.3});
  Connection connection(port_);
  connection.send(
      "POST /processes/validate/execution HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000\r\n"
      "\r\n{");
  EXPECT_FALSE(drips_for_ever(connection, ' '));
  expect_still_working();
}

TEST_F(RestOverSocket, AnIdleConnectionIsClosedAndOneInUseIsNot) {
  start({.idle_timeout_s = 0.3, .header_timeout_s = 60});
  Connection used(port_), idle(port_);
  for (auto* connection : {&used, &idle}) {
    connection->send(request("GET", "/healthz"));
    EXPECT_EQ(connection->read()->status, 200);
  }
  used.send("GET /healthz HTTP/1.1\r\n");  // a request has begun
  EXPECT_TRUE(idle.is_closed());
  used.send("Host: localhost\r\n\r\n");
  EXPECT_EQ(used.read()->status, 200);
}

TEST_F(RestOverSocket, AConnectionThatNeverAsksIsClosed) {
  start({.idle_timeout_s = 60, .header_timeout_s = 0.3});
  Connection silent(port_);
  EXPECT_TRUE(silent.is_closed());
  expect_still_working();
}

TEST_F(RestOverSocket, AClientThatAsksAheadAndLeavesTakesItsWaitingJobWithIt) {
  start();
  Connection connection(port_);
  connection.send(request("POST", "/processes/heal/execution", kBox) + request("GET", "/healthz"));
  std::vector<Job> open;
  while ((open = must(service_.jobs().list({}))).empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  connection.leave();
  while (!is_final(must(service_.jobs().get(open[0].id)).state))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

}  // namespace
}  // namespace citymesh
