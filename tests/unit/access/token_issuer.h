#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_pkey_st;

namespace citymesh {

/// Signs tokens as an identity provider does.
class TokenIssuer {
 public:
  enum class Kind { Rsa, P256 };
  explicit TokenIssuer(Kind kind, std::string key_id = "key-1", unsigned rsa_bits = 2048);

  /// A JSON Web Key without more than is needed, and a set of this key only.
  std::string jwk() const;
  std::string jwks() const { return R"({"keys":[)" + jwk() + "]}"; }

  /// A token with a fitting header.
  std::string token(std::string_view claims_json) const;
  /// A token with this header, signed with this key whatever the header says.
  std::string token(std::string_view header_json, std::string_view claims_json) const;

 private:
  std::string sign(std::string_view text) const;

  Kind kind_;
  std::string key_id_;
  std::shared_ptr<evp_pkey_st> key_;
};

/// `header.claims.` and a signature that the caller has.
std::string token_of(std::string_view header_json, std::string_view claims_json,
                     std::string_view signature);

}  // namespace citymesh
