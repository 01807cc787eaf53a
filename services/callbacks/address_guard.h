#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

// What a client asks the service to call must not lead into the service's own network (server-side
// request forgery, CWE-918).

/// Whether an address belongs to the public internet: not loopback, private, link-local, carrier
/// grade NAT, multicast, unique local, documentation, or an IPv4 address in the clothes of IPv6.
using Ipv4 = std::array<std::uint8_t, 4>;
using Ipv6 = std::array<std::uint8_t, 16>;
bool is_public(const Ipv4& address);
bool is_public(const Ipv6& address);
/// Of an address as text; nothing when it is none.
std::optional<bool> is_public_text(const std::string& address);

/// Whether a callback may be asked for: http or https, a host without user and password, and not
/// plainly an address within. A name is judged when it is resolved. Errors: InvalidArgument.
Result<void> check_callback_uri(std::string_view uri, bool allow_private);

/// Scheme and host, for logs: paths and queries may hold secrets.
std::string shown_uri(std::string_view uri);

}  // namespace citymesh
