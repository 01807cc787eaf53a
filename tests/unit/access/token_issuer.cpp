#include "tests/unit/access/token_issuer.h"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ecdsa.h>
#include <openssl/evp.h>
#include <openssl/rsa.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "services/access/base64url.h"

namespace citymesh {
namespace {

std::string number_of(const evp_pkey_st* key, const char* name, int bytes) {
  BIGNUM* number = nullptr;
  if (EVP_PKEY_get_bn_param(key, name, &number) != 1) std::abort();
  std::string text(static_cast<std::size_t>(bytes > 0 ? bytes : BN_num_bytes(number)), '\0');
  BN_bn2binpad(number, reinterpret_cast<unsigned char*>(text.data()),
               static_cast<int>(text.size()));
  BN_free(number);
  return encode_base64url(text);
}

}  // namespace

TokenIssuer::TokenIssuer(Kind kind, std::string key_id, unsigned rsa_bits)
    : kind_(kind),
      key_id_(std::move(key_id)),
      key_(kind == Kind::Rsa ? EVP_RSA_gen(rsa_bits) : EVP_EC_gen("P-256"), EVP_PKEY_free) {
  if (!key_) std::abort();
}

std::string TokenIssuer::jwk() const {
  nlohmann::json key = {{"kid", key_id_}};
  if (kind_ == Kind::Rsa) {
    key["kty"] = "RSA";
    key["n"] = number_of(key_.get(), OSSL_PKEY_PARAM_RSA_N, 0);
    key["e"] = number_of(key_.get(), OSSL_PKEY_PARAM_RSA_E, 0);
  } else {
    key["kty"] = "EC";
    key["crv"] = "P-256";
    key["x"] = number_of(key_.get(), OSSL_PKEY_PARAM_EC_PUB_X, 32);
    key["y"] = number_of(key_.get(), OSSL_PKEY_PARAM_EC_PUB_Y, 32);
  }
  return key.dump();
}

std::string TokenIssuer::sign(std::string_view text) const {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest(EVP_MD_CTX_new(),
                                                                       EVP_MD_CTX_free);
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  std::array<unsigned char, 1024> signature{};
  auto size = signature.size();
  if (EVP_DigestSignInit(digest.get(), nullptr, EVP_sha256(), nullptr, key_.get()) != 1 ||
      EVP_DigestSign(digest.get(), signature.data(), &size, bytes, text.size()) != 1)
    std::abort();
  if (kind_ == Kind::Rsa) return {reinterpret_cast<const char*>(signature.data()), size};

  const auto* der = signature.data();
  ECDSA_SIG* numbers = d2i_ECDSA_SIG(nullptr, &der, static_cast<long>(size));
  std::string both(64, '\0');
  auto* out = reinterpret_cast<unsigned char*>(both.data());
  BN_bn2binpad(ECDSA_SIG_get0_r(numbers), out, 32);
  BN_bn2binpad(ECDSA_SIG_get0_s(numbers), out + 32, 32);
  ECDSA_SIG_free(numbers);
  return both;
}

std::string TokenIssuer::token(std::string_view claims_json) const {
  const nlohmann::json header = {
      {"alg", kind_ == Kind::Rsa ? "RS256" : "ES256"}, {"typ", "JWT"}, {"kid", key_id_}};
  return token(header.dump(), claims_json);
}

std::string TokenIssuer::token(std::string_view header_json, std::string_view claims_json) const {
  return token_of(header_json, claims_json,
                  sign(encode_base64url(header_json) + "." + encode_base64url(claims_json)));
}

std::string token_of(std::string_view header_json, std::string_view claims_json,
                     std::string_view signature) {
  return encode_base64url(header_json) + "." + encode_base64url(claims_json) + "." +
         encode_base64url(signature);
}

}  // namespace citymesh
