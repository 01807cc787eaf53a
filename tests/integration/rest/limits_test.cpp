#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "services/access/networks.h"
#include "tests/integration/rest/rest_over_socket.h"

namespace citymesh {
namespace {

/// An IPv4 address of this machine that is not loopback; empty: there is none.
std::string own_address() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return {};
  std::string found;
  for (const auto* entry = all; entry != nullptr && found.empty(); entry = entry->ifa_next) {
    char text[INET_ADDRSTRLEN] = {};
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    inet_ntop(AF_INET, &address->sin_addr, text, sizeof text);
    if (!is_loopback_address(text)) found = text;
  }
  freeifaddrs(all);
  return found;
}

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

TEST_F(RestOverSocket, ThisMachineMayHaveMoreConnectionsThanOtherAddresses) {
  start({.max_client_connections = 1});
  Connection first(port_), second(port_);
  for (auto* connection : {&first, &second}) {
    connection->send(request("GET", "/healthz"));
    EXPECT_EQ(connection->read()->status, 200);
  }
}

TEST_F(RestOverSocket, AnAddressHasALimitOfItsOwn) {
  // The only other address of every machine is one of its own that is not loopback.
  const auto address = own_address();
  if (address.empty()) GTEST_SKIP() << "this machine has loopback only";
  start({.host = "0.0.0.0", .max_client_connections = 1});
  {
    Connection first(port_, nullptr, address.c_str());
    first.send(request("GET", "/healthz"));
    EXPECT_EQ(first.read()->status, 200);
    Connection second(port_, nullptr, address.c_str());
    const auto refused = second.read();
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 503);
    EXPECT_TRUE(refused->headers.contains("retry-after"));
    EXPECT_THAT(refused->body, testing::HasSubstr("1 connections from " + address));
  }
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
  EXPECT_EQ(must(service_.jobs().get(open[0].id)).state, JobState::Dismissed);
}

}  // namespace
}  // namespace citymesh
