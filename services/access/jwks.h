#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

struct evp_pkey_st;

namespace citymesh {

/// A public key of those who issue tokens.
struct VerificationKey {
  std::string id{};         ///< `kid`; may be empty
  std::string algorithm{};  ///< RS256 or ES256, the only one it is good for
  std::shared_ptr<evp_pkey_st> key{};
};

/// The keys of a JSON Web Key Set (RFC 7517) that sign with RS256 (2048 to 8192 bits) or ES256;
/// others in it are passed over. Errors: InvalidArgument for what is no key set, a key of these
/// kinds that is malformed, and a set without any.
Result<std::vector<VerificationKey>> parse_jwks(std::string_view text);

/// `signature` as JSON Web Signatures have it (RFC 7518, 3.3 and 3.4).
bool is_signed(const VerificationKey& key, std::string_view text, std::string_view signature);

}  // namespace citymesh
