#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// A set of IP addresses.
class Networks {
 public:
  /// Addresses and networks (`10.0.0.0/8`, `fd00::/8`, `192.0.2.7`) by comma. Errors:
  /// InvalidArgument naming the one that is none.
  static Result<Networks> parse(std::string_view list);

  /// An IPv4 address that is mapped into IPv6 counts as the IPv4 address. False for what is no
  /// address.
  bool contains(std::string_view address) const;
  bool empty() const { return networks_.empty(); }

 private:
  using Bytes = std::array<unsigned char, 16>;  // IPv4 mapped into IPv6
  struct Network {
    Bytes address{};
    unsigned prefix_bits = 128;
  };
  static bool read(std::string_view text, Bytes& address);

  std::vector<Network> networks_;
};

/// Where a request comes from.
struct Sender {
  std::string address{};    ///< of the client
  std::size_t proxies = 0;  ///< trusted ones between it and us
};

/// The peer, or behind trusted proxies the last of the addresses `forwarded` (from client to proxy,
/// perhaps with ports) that is none of them. What is no address ends the search at the one before.
Sender sender_of(std::string_view peer, const std::vector<std::string>& forwarded,
                 const Networks& trusted_proxies);

/// 127.0.0.0/8 and ::1.
bool is_loopback_address(std::string_view address);

}  // namespace citymesh
