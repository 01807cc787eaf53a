#include "services/access/networks.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace citymesh {
namespace {

constexpr unsigned kIpv4Offset_bits = 96;  // of an IPv4 address in an IPv6 address

bool is_ipv4(std::string_view address) { return address.find(':') == std::string_view::npos; }

/// Of `192.0.2.7:80`, `[2001:db8::1]:80` and `[2001:db8::1]`.
std::string_view without_port(std::string_view text) {
  if (text.starts_with('[')) return text.substr(1, std::min(text.find(']'), text.size()) - 1);
  const auto colon = text.find(':');
  const bool has_port = colon != std::string_view::npos && text.find(':', colon + 1) == text.npos;
  return has_port ? text.substr(0, colon) : text;
}

}  // namespace

bool Networks::read(std::string_view text, Bytes& address) {
  const std::string terminated(text);
  address = {};
  if (!is_ipv4(text)) return inet_pton(AF_INET6, terminated.c_str(), address.data()) == 1;
  address[10] = address[11] = 0xff;
  return inet_pton(AF_INET, terminated.c_str(), address.data() + 12) == 1;
}

Result<Networks> Networks::parse(std::string_view list) {
  Networks networks;
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    auto text = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);

    Network network;
    const auto slash = std::min(text.find('/'), text.size());
    const auto address = text.substr(0, slash);
    const unsigned offset = is_ipv4(address) ? kIpv4Offset_bits : 0;
    unsigned bits = 128 - offset;
    bool good = read(address, network.address);
    if (slash < text.size()) {
      const auto number = text.substr(slash + 1);
      const auto most = bits;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), bits);
      good = good && !number.empty() && error == std::errc{} &&
             end == number.data() + number.size() && bits <= most;
    }
    if (!good)
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("'{}' is no address or network, expected for example 10.0.0.0/8 or "
                              "fd00::/8",
                              text));
    network.prefix_bits = bits + offset;
    networks.networks_.push_back(network);
  }
  return networks;
}

bool Networks::contains(std::string_view text) const {
  Bytes address{};
  if (!read(text, address)) return false;
  return std::ranges::any_of(networks_, [&](const Network& network) {
    for (unsigned bit = 0; bit < network.prefix_bits; ++bit)
      if (((address[bit / 8] ^ network.address[bit / 8]) & (0x80u >> (bit % 8))) != 0) return false;
    return true;
  });
}

Sender sender_of(std::string_view peer, const std::vector<std::string>& forwarded,
                 const Networks& trusted_proxies) {
  static const auto every_address = *Networks::parse("0.0.0.0/0, ::/0");
  Sender sender{std::string(peer), 0};
  auto hop = forwarded.rbegin();
  while (trusted_proxies.contains(sender.address)) {
    ++sender.proxies;
    if (hop == forwarded.rend()) break;
    const auto address = without_port(*hop);
    if (!every_address.contains(address)) break;
    sender.address = address;
    ++hop;
  }
  return sender;
}

bool is_loopback_address(std::string_view address) {
  static const auto loopback = *Networks::parse("127.0.0.0/8, ::1");
  return loopback.contains(address);
}

}  // namespace citymesh
