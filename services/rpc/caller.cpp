#include "services/rpc/caller.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

namespace citymesh {
namespace {

/// Of `ipv4:192.0.2.7:4711` and `ipv6:%5B2001:db8::1%5D:4711`; of others as it stands there.
std::string address_of(std::string_view peer) {
  if (!peer.starts_with("ipv4:") && !peer.starts_with("ipv6:")) return std::string(peer);
  peer.remove_prefix(peer.find(':') + 1);
  peer = peer.substr(0, peer.rfind(':'));
  for (const auto* bracket : {"%5B", "["})
    if (peer.starts_with(bracket)) peer.remove_prefix(std::string_view(bracket).size());
  for (const auto* bracket : {"%5D", "]"})
    if (peer.ends_with(bracket)) peer.remove_suffix(std::string_view(bracket).size());
  return std::string(peer);
}

}  // namespace

std::string last_of(const std::multimap<std::string, std::string>& metadata,
                    const std::string& name) {
  const auto end = metadata.upper_bound(name);
  if (end == metadata.begin()) return {};
  const auto last = std::prev(end);
  return last->first == name ? last->second : std::string{};
}

Credentials credentials_of(const std::string& peer,
                           const std::multimap<std::string, std::string>& metadata,
                           const Networks& trusted_proxies) {
  std::vector<std::string> forwarded;
  const auto [first, last] = metadata.equal_range("x-forwarded-for");
  for (auto entry = first; entry != last; ++entry)
    for (std::string_view list = entry->second; !list.empty();) {
      const auto comma = std::min(list.find(','), list.size());
      auto address = list.substr(0, comma);
      list.remove_prefix(std::min(comma + 1, list.size()));
      while (address.starts_with(' ')) address.remove_prefix(1);
      while (address.ends_with(' ')) address.remove_suffix(1);
      forwarded.emplace_back(address);
    }
  return {last_of(metadata, "authorization"), last_of(metadata, "x-api-key"),
          sender_of(address_of(peer), forwarded, trusted_proxies).address};
}

}  // namespace citymesh
