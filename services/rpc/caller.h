#pragma once

#include <map>
#include <string>

#include "core/base/result.h"
#include "services/access/access.h"

namespace citymesh {

/// Of a name that comes more than once the last value; empty when it does not come.
std::string last_of(const std::multimap<std::string, std::string>& metadata,
                    const std::string& name);

/// What a gRPC call shows of its client: `authorization`, `x-api-key` and the peer as gRPC names it
/// (`ipv4:192.0.2.7:4711`), behind trusted proxies the address in `x-forwarded-for`. Of a name that
/// comes more than once the last value counts, of addresses all.
Credentials credentials_of(const std::string& peer,
                           const std::multimap<std::string, std::string>& metadata,
                           const Networks& trusted_proxies);

}  // namespace citymesh
