#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "services/access/networks.h"
#include "services/rest/message.h"

namespace citymesh {

/// A request as its client sees it, in front of all proxies.
struct Origin {
  std::string base{};    ///< `https://host/prefix` that the client sent it to, no slash at the end
  std::string client{};  ///< address of the client
};

/// From the connection and Host; `Forwarded` (RFC 7239), or without it `X-Forwarded-For`, `-Proto`
/// and `-Host`, and in any case `X-Forwarded-Prefix` take their place when they come from trusted
/// proxies. A `public_url` is the base whatever they say. Errors: InvalidArgument naming the header
/// that cannot be used in links.
Result<Origin> origin_of(const Request& request, const Networks& trusted_proxies,
                         std::string_view public_url = {});

}  // namespace citymesh
