#include "services/callbacks/address_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace citymesh {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(AddressGuard, LetsPublicAddressesThrough) {
  for (const auto* address : {"1.1.1.1",
                              "8.8.8.8",
                              "9.255.255.255",
                              "11.0.0.0",
                              "100.63.255.255",
                              "100.128.0.0",
                              "126.255.255.255",
                              "128.0.0.1",
                              "169.253.255.255",
                              "172.15.255.255",
                              "172.32.0.0",
                              "192.167.255.255",
                              "192.169.0.0",
                              "198.17.255.255",
                              "198.20.0.0",
                              "223.255.255.255",
                              "2001:4860:4860::8888",
                              "2606:4700::1111",
                              "2a00::1",
                              "2003::1",
                              "2620:4f:7fff::1"})
    EXPECT_EQ(is_public_text(address), true) << address;
}

TEST(AddressGuard, KeepsEveryOtherAddressOut) {
  for (const auto* address :
       {// IPv4: this network, private, carrier grade NAT, loopback, link-local, IETF,
        // documentation, relays, benchmarks, multicast, reserved, broadcast
        "0.0.0.0", "0.1.2.3", "10.0.0.1", "10.255.255.255", "100.64.0.1", "100.127.255.255",
        "127.0.0.1", "127.255.255.254", "169.254.0.1", "169.254.169.254", "172.16.0.1",
        "172.31.255.255", "192.0.0.1", "192.0.2.1", "192.88.99.1", "192.168.0.1", "198.18.0.1",
        "198.19.255.255", "198.51.100.7", "203.0.113.7", "224.0.0.1", "239.255.255.255",
        "240.0.0.1", "255.255.255.255",
        // IPv6: unspecified, loopback, mapped and compatible IPv4, NAT64, discard, Teredo, 6to4,
        // documentation, unique local, link-local, site-local, multicast
        "::", "::1", "::ffff:127.0.0.1", "::ffff:8.8.8.8", "::ffff:10.0.0.1", "::127.0.0.1",
        "::ffff:0:127.0.0.1", "64:ff9b::7f00:1", "64:ff9b:1::1", "100::1", "2001::1", "2001:10::1",
        "2001:20::1", "2001:db8::1", "2002:7f00:1::", "3fff::1", "fc00::1", "fd12:3456::1",
        "fe80::1", "febf::1", "fec0::1", "ff02::1", "ffff::1", "4000::1"})
    EXPECT_EQ(is_public_text(address), false) << address;
}

TEST(AddressGuard, TellsWhatIsNoAddress) {
  for (const auto* text : {"", "example.org", "1.2.3", "1.2.3.4.5", "::g", "127.0.0.1 "})
    EXPECT_EQ(is_public_text(text), std::nullopt) << text;
}

TEST(CallbackUri, OfAPublicHostIsTaken) {
  for (const auto* uri :
       {"https://example.org/hook", "http://example.org", "https://example.org:8443/a?b=c",
        "https://8.8.8.8/", "https://[2a00::1]/hook", "HTTPS://EXAMPLE.ORG/"})
    EXPECT_TRUE(check_callback_uri(uri, false)) << uri;
}

TEST(CallbackUri, OfAHostWithinIsRefusedHoweverItIsWritten) {
  for (const auto* uri :
       {"http://127.0.0.1/", "http://localhost/", "http://LOCALHOST:80/", "http://localhost./",
        "http://a.localhost/", "http://10.0.0.1/", "http://169.254.169.254/latest/meta-data/",
        "http://[::1]/", "http://[::ffff:127.0.0.1]/", "http://[fe80::1%25eth0]/", "http://0/",
        "http://127.1/", "http://2130706433/", "http://0x7f000001/", "http://0177.0.0.1/",
        "http://[::]/", "http://192.168.1.1:8080/hook"}) {
    const auto checked = check_callback_uri(uri, false);
    ASSERT_FALSE(checked) << uri;
    EXPECT_EQ(checked.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(checked.error().message, HasSubstr("public")) << uri;
    EXPECT_TRUE(check_callback_uri(uri, true)) << uri;
  }
}

TEST(CallbackUri, ThatIsNoPlainHttpIsRefusedInAnyCase) {
  for (const auto& uri : std::vector<std::string>{
           "", "example.org", "/hook", "ftp://example.org/", "file:///etc/passwd",
           "gopher://example.org/", "javascript:alert(1)", "http://", "https://user@example.org/",
           "https://user:password@example.org/", "http://example.org/\r\nHost: other",
           "http://example.org/a b", "http://ex\xc3\xa4mple.org/",
           "http://example.org/" + std::string(3000, 'a')})
    EXPECT_FALSE(check_callback_uri(uri, true)) << uri;
}

TEST(CallbackUri, IsShownWithoutItsSecrets) {
  EXPECT_EQ(shown_uri("https://example.org:8443/hook/TOKEN?key=SECRET"), "https://example.org");
  EXPECT_THAT(shown_uri("https://user:password@example.org/"), Not(HasSubstr("password")));
  EXPECT_EQ(shown_uri("nonsense:"), "");
}

}  // namespace
}  // namespace citymesh
