#include "services/callbacks/address_guard.h"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

namespace citymesh {
namespace {

constexpr std::size_t kLongestUri = 2048;

struct Network4 {
  std::uint32_t address;
  unsigned bits;
};

constexpr std::uint32_t v4(unsigned a, unsigned b, unsigned c, unsigned d) {
  return a << 24 | b << 16 | c << 8 | d;
}

// IANA's registry of special-purpose addresses, and multicast.
constexpr std::array<Network4, 16> kNotPublic4{{
    {v4(0, 0, 0, 0), 8},        // this network
    {v4(10, 0, 0, 0), 8},       // private
    {v4(100, 64, 0, 0), 10},    // carrier grade NAT
    {v4(127, 0, 0, 0), 8},      // loopback
    {v4(169, 254, 0, 0), 16},   // link-local, metadata of clouds
    {v4(172, 16, 0, 0), 12},    // private
    {v4(192, 0, 0, 0), 24},     // IETF
    {v4(192, 0, 2, 0), 24},     // documentation
    {v4(192, 31, 196, 0), 24},  // AS112
    {v4(192, 52, 193, 0), 24},  // AMT
    {v4(192, 88, 99, 0), 24},   // 6to4 relays
    {v4(192, 168, 0, 0), 16},   // private
    {v4(198, 18, 0, 0), 15},    // benchmarks
    {v4(198, 51, 100, 0), 24},  // documentation
    {v4(203, 0, 113, 0), 24},   // documentation
    {v4(224, 0, 0, 0), 3},      // multicast, reserved, broadcast
}};

struct Network6 {
  std::array<std::uint8_t, 6> prefix;
  unsigned bits;
};

// Only 2000::/3 is public, and of that not these.
constexpr std::array<Network6, 5> kNotPublic6{{
    {{0x20, 0x01, 0x00, 0x00}, 23},              // IETF, Teredo and ORCHID among them
    {{0x20, 0x01, 0x0d, 0xb8}, 32},              // documentation
    {{0x20, 0x02}, 16},                          // 6to4: holds an IPv4 address
    {{0x26, 0x20, 0x00, 0x4f, 0x80, 0x00}, 48},  // AS112
    {{0x3f, 0xff, 0x00}, 20},                    // documentation
}};

bool within(const Ipv6& address, const Network6& network) {
  unsigned bit = 0;
  for (; bit + 8 <= network.bits; bit += 8)
    if (address[bit / 8] != network.prefix[bit / 8]) return false;
  if (bit == network.bits) return true;
  const unsigned shift = 8 - (network.bits - bit);
  return address[bit / 8] >> shift == network.prefix[bit / 8] >> shift;
}

struct FreeUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
using Url = std::unique_ptr<CURLU, FreeUrl>;

std::string part(const Url& url, CURLUPart which) {
  char* text = nullptr;
  if (curl_url_get(url.get(), which, &text, 0) != CURLUE_OK) return {};
  std::string copy(text);
  curl_free(text);
  return copy;
}

Url parse(std::string_view uri) {
  Url url(curl_url());
  if (url && curl_url_set(url.get(), CURLUPART_URL, std::string(uri).c_str(), 0) != CURLUE_OK)
    url.reset();
  return url;
}

/// Whether the host is written as an address that is not public, or is a name of this machine.
bool is_plainly_within(std::string host) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  host = host.substr(0, host.find('%'));  // a zone is no part of the address
  if (const auto open = is_public_text(host)) return !*open;
  std::ranges::transform(host, host.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  while (host.ends_with('.')) host.pop_back();
  return host == "localhost" || host.ends_with(".localhost");
}

}  // namespace

bool is_public(const Ipv4& address) {
  const auto number = v4(address[0], address[1], address[2], address[3]);
  return std::ranges::none_of(kNotPublic4, [number](const Network4& network) {
    const auto shift = 32 - network.bits;
    return number >> shift == network.address >> shift;
  });
}

bool is_public(const Ipv6& address) {
  return address[0] >> 5 == 0x20 >> 5 &&
         std::ranges::none_of(
             kNotPublic6, [&address](const Network6& network) { return within(address, network); });
}

std::optional<bool> is_public_text(const std::string& address) {
  if (Ipv4 bytes{}; inet_pton(AF_INET, address.c_str(), bytes.data()) == 1) return is_public(bytes);
  if (Ipv6 bytes{}; inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1)
    return is_public(bytes);
  return std::nullopt;
}

Result<void> check_callback_uri(std::string_view uri, bool allow_private) {
  const auto refuse = [&](std::string_view expected) {
    return fail(ErrorCode::InvalidArgument,
                fmt::format("callback '{}' cannot be used, expected {}",
                            uri.substr(0, std::min<std::size_t>(uri.size(), 120)), expected));
  };
  const bool plain = std::ranges::all_of(uri, [](char c) { return c > ' ' && c <= '~'; });
  if (!plain || uri.size() > kLongestUri)
    return refuse(fmt::format("a URI of at most {} characters of ASCII", kLongestUri));
  const auto url = parse(uri);
  if (!url) return refuse("an absolute URI, http:// or https://");
  const auto scheme = part(url, CURLUPART_SCHEME);
  if (scheme != "http" && scheme != "https") return refuse("http:// or https://");
  if (!part(url, CURLUPART_USER).empty() || !part(url, CURLUPART_PASSWORD).empty())
    return refuse("no user and password");
  const auto host = part(url, CURLUPART_HOST);
  if (host.empty()) return refuse("a host");
  if (!allow_private && is_plainly_within(host)) return refuse("a public address");
  return {};
}

std::string shown_uri(std::string_view uri) {
  const auto url = parse(uri);
  if (!url) return {};
  return fmt::format("{}://{}", part(url, CURLUPART_SCHEME), part(url, CURLUPART_HOST));
}

}  // namespace citymesh
