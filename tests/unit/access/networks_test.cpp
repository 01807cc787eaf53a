#include "services/access/networks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace citymesh {
namespace {

TEST(NetworksTest, ContainWhatTheirPrefixSays) {
  const auto networks = Networks::parse("10.0.0.0/8, 192.0.2.7,fd00::/8,2001:db8::1");
  ASSERT_TRUE(networks) << networks.error().message;
  for (const auto* inside :
       {"10.255.0.1", "192.0.2.7", "::ffff:10.1.2.3", "fd12::1", "2001:db8::1"})
    EXPECT_TRUE(networks->contains(inside)) << inside;
  for (const auto* outside : {"11.0.0.1", "192.0.2.8", "fe00::1", "2001:db8::2", "::a00:1", "",
                              "10.0.0", "unknown", "10.0.0.1:80", "_hidden"})
    EXPECT_FALSE(networks->contains(outside)) << outside;
}

TEST(NetworksTest, WhatIsNoneIsNamed) {
  for (const auto* wrong : {"10.0.0.0/33", "10.0.0/8", "::/129", "10.0.0.0/", "10.0.0.0/x", "host",
                            "10.0.0.1,,10.0.0.2", "10.0.0.0/-1"}) {
    const auto networks = Networks::parse(wrong);
    ASSERT_FALSE(networks) << wrong;
    EXPECT_EQ(networks.error().code, ErrorCode::InvalidArgument);
  }
  EXPECT_TRUE(Networks::parse("")->empty());
  EXPECT_TRUE(Networks::parse("0.0.0.0/0")->contains("203.0.113.9"));
}

TEST(NetworksTest, LoopbackIsKnown) {
  for (const auto* local : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(is_loopback_address(local)) << local;
  for (const auto* other : {"128.0.0.1", "0.0.0.0", "::", "localhost"})
    EXPECT_FALSE(is_loopback_address(other)) << other;
}

TEST(SenderTest, TheLastAddressThatIsNoTrustedProxyIsTheClient) {
  const auto proxies = *Networks::parse("10.0.0.0/8");
  const auto address = [&](const char* peer, const std::vector<std::string>& forwarded) {
    return sender_of(peer, forwarded, proxies).address;
  };
  EXPECT_EQ(address("10.0.0.1", {"203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(address("10.0.0.1", {"203.0.113.9", "10.0.0.2"}), "203.0.113.9");
  // What the client itself has written in front does not count.
  EXPECT_EQ(address("10.0.0.1", {"127.0.0.1", "203.0.113.9"}), "203.0.113.9");
  EXPECT_EQ(address("198.51.100.4", {"203.0.113.9"}), "198.51.100.4");
  EXPECT_EQ(address("10.0.0.1", {"unknown"}), "10.0.0.1");
  EXPECT_EQ(address("10.0.0.1", {}), "10.0.0.1");
  EXPECT_EQ(address("10.0.0.1", {"203.0.113.9:4711"}), "203.0.113.9");
  EXPECT_EQ(address("10.0.0.1", {"[2001:db8::9]:4711"}), "2001:db8::9");
  EXPECT_EQ(address("10.0.0.1", {"2001:db8::9"}), "2001:db8::9");
  for (const auto* broken : {"[", "[]", ":", "::1]:80", "[::1"})
    EXPECT_NE(address("10.0.0.1", {broken}), "") << broken;
  EXPECT_EQ(sender_of("10.0.0.1", {"203.0.113.9"}, {}).address, "10.0.0.1");
}

TEST(SenderTest, TrustedProxiesOnTheWayAreCounted) {
  const auto proxies = *Networks::parse("10.0.0.0/8");
  EXPECT_EQ(sender_of("198.51.100.4", {"203.0.113.9"}, proxies).proxies, 0u);
  EXPECT_EQ(sender_of("10.0.0.1", {}, proxies).proxies, 1u);
  EXPECT_EQ(sender_of("10.0.0.1", {"203.0.113.9"}, proxies).proxies, 1u);
  EXPECT_EQ(sender_of("10.0.0.1", {"203.0.113.9", "10.0.0.2"}, proxies).proxies, 2u);
}

}  // namespace
}  // namespace citymesh
