#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "services/access/client.h"
#include "services/access/jwks.h"

namespace citymesh {

/// What a bearer token has to say to be one of ours.
struct TokenRules {
  std::string issuer{};              ///< `iss`, exactly
  std::string audience{};            ///< `aud`, or one of it
  std::string role_claim = "roles";  ///< a claim, or a path of members: `realm_access.roles`
  /// Of the roles in that claim those count that begin with this; without it `admin` of some other
  /// service would be admin here.
  std::string role_prefix = "citymesh:";
};

/// How far the clocks of issuer and service may be apart.
inline constexpr std::int64_t kClockLeeway_s = 60;

/// Whether a token says that it is signed with a key (`kid`) that is none of these.
bool names_unknown_key(std::string_view token, const std::vector<VerificationKey>& keys);

/// The client of a JSON Web Token (RFC 7519) that is signed by one of the keys and in force:
/// RS256 and ES256 only, whatever the token itself says. Its role is the highest one that its role
/// claim (a text with blanks, or an array) names. Any error means that the token proves nothing;
/// the message says why without repeating it.
Result<Client> client_of_token(std::string_view token, const std::vector<VerificationKey>& keys,
                               const TokenRules& rules, std::int64_t now_s);

}  // namespace citymesh
