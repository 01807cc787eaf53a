#include "services/access/jwks.h"

#include <fmt/format.h>
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ec.h>
#include <openssl/ecdsa.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "services/access/base64url.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr int kFewestRsaBits = 2048;
constexpr int kMostRsaBits = 8192;  // verifying with longer ones takes noticeable time
constexpr std::size_t kCoordinateBytes = 32;

template <auto free_it>
struct Freed {
  template <class T>
  void operator()(T* pointer) const {
    free_it(pointer);
  }
};
template <class T, auto free_it>
using Owned = std::unique_ptr<T, Freed<free_it>>;

using BigNumber = Owned<BIGNUM, BN_free>;
using Builder = Owned<OSSL_PARAM_BLD, OSSL_PARAM_BLD_free>;
using Parameters = Owned<OSSL_PARAM, OSSL_PARAM_free>;
using KeyContext = Owned<EVP_PKEY_CTX, EVP_PKEY_CTX_free>;
using DigestContext = Owned<EVP_MD_CTX, EVP_MD_CTX_free>;
using EcSignature = Owned<ECDSA_SIG, ECDSA_SIG_free>;
using PublicKey = std::shared_ptr<EVP_PKEY>;

const unsigned char* bytes_of(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

BigNumber number_of(std::string_view bytes) {
  return BigNumber(BN_bin2bn(bytes_of(bytes), static_cast<int>(bytes.size()), nullptr));
}

/// Nothing when OpenSSL finds fault with it.
PublicKey build(const char* kind, OSSL_PARAM_BLD* builder) {
  const Parameters parameters(OSSL_PARAM_BLD_to_param(builder));
  const KeyContext maker(EVP_PKEY_CTX_new_from_name(nullptr, kind, nullptr));
  EVP_PKEY* made = nullptr;
  if (!parameters || !maker || EVP_PKEY_fromdata_init(maker.get()) <= 0 ||
      EVP_PKEY_fromdata(maker.get(), &made, EVP_PKEY_PUBLIC_KEY, parameters.get()) <= 0) {
    ERR_clear_error();
    return nullptr;
  }
  PublicKey key(made, EVP_PKEY_free);
  const KeyContext checker(EVP_PKEY_CTX_new_from_pkey(nullptr, made, nullptr));
  if (checker && EVP_PKEY_public_check(checker.get()) == 1) return key;
  ERR_clear_error();
  return nullptr;
}

PublicKey rsa_key(std::string_view modulus, std::string_view exponent) {
  const Builder builder(OSSL_PARAM_BLD_new());
  const auto n = number_of(modulus);
  const auto e = number_of(exponent);
  if (!builder || !n || !e || BN_num_bits(n.get()) < kFewestRsaBits ||
      BN_num_bits(n.get()) > kMostRsaBits || BN_num_bits(e.get()) > 64 ||
      OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, n.get()) != 1 ||
      OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, e.get()) != 1)
    return nullptr;
  return build("RSA", builder.get());
}

PublicKey p256_key(std::string_view x, std::string_view y) {
  if (x.size() != kCoordinateBytes || y.size() != kCoordinateBytes) return nullptr;
  const std::string point = "\x04" + std::string(x) + std::string(y);  // uncompressed
  const Builder builder(OSSL_PARAM_BLD_new());
  if (!builder ||
      OSSL_PARAM_BLD_push_utf8_string(builder.get(), OSSL_PKEY_PARAM_GROUP_NAME, "prime256v1", 0) !=
          1 ||
      OSSL_PARAM_BLD_push_octet_string(builder.get(), OSSL_PKEY_PARAM_PUB_KEY, point.data(),
                                       point.size()) != 1)
    return nullptr;
  return build("EC", builder.get());
}

std::string text_member(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

/// A member in base64url; empty when it is none.
std::string bytes_member(const json& object, const char* name) {
  return decode_base64url(text_member(object, name)).value_or("");
}

/// Nothing for keys of other kinds or purposes.
std::optional<VerificationKey> read_key(const json& entry) {
  const auto kind = text_member(entry, "kty");
  VerificationKey key;
  key.id = text_member(entry, "kid");
  if (kind == "RSA")
    key.algorithm = "RS256";
  else if (kind == "EC" && text_member(entry, "crv") == "P-256")
    key.algorithm = "ES256";
  else
    return std::nullopt;
  const auto algorithm = text_member(entry, "alg");
  const auto use = text_member(entry, "use");
  if ((!algorithm.empty() && algorithm != key.algorithm) || (!use.empty() && use != "sig"))
    return std::nullopt;
  key.key = kind == "RSA" ? rsa_key(bytes_member(entry, "n"), bytes_member(entry, "e"))
                          : p256_key(bytes_member(entry, "x"), bytes_member(entry, "y"));
  return key;
}

/// The two numbers of an ECDSA signature in the form that OpenSSL takes.
std::string der_signature(std::string_view numbers) {
  if (numbers.size() != 2 * kCoordinateBytes) return {};
  const EcSignature signature(ECDSA_SIG_new());
  auto r = number_of(numbers.substr(0, kCoordinateBytes));
  auto s = number_of(numbers.substr(kCoordinateBytes));
  if (!signature || !r || !s || ECDSA_SIG_set0(signature.get(), r.get(), s.get()) != 1) return {};
  (void)r.release();  // the signature owns them now
  (void)s.release();
  const int bytes = i2d_ECDSA_SIG(signature.get(), nullptr);
  if (bytes <= 0) return {};
  std::string der(static_cast<std::size_t>(bytes), '\0');
  auto* out = reinterpret_cast<unsigned char*>(der.data());
  i2d_ECDSA_SIG(signature.get(), &out);
  return der;
}

}  // namespace

Result<std::vector<VerificationKey>> parse_jwks(std::string_view text) {
  const auto set = json::parse(text, nullptr, false);
  const auto keys = set.is_object() ? set.find("keys") : set.end();
  if (keys == set.end() || !keys->is_array())
    return fail(ErrorCode::InvalidArgument,
                "expected a JSON Web Key Set: an object with an array `keys`");
  std::vector<VerificationKey> usable;
  for (std::size_t i = 0; i < keys->size(); ++i) {
    auto key = read_key((*keys)[i]);
    if (!key) continue;
    if (!key->key)
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("key {} ('{}') is not usable, expected RSA with {} to {} bits in `n` "
                              "and `e`, or a point of P-256 in `x` and `y`",
                              i + 1, key->id, kFewestRsaBits, kMostRsaBits));
    usable.push_back(*std::move(key));
  }
  if (usable.empty())
    return fail(ErrorCode::InvalidArgument,
                fmt::format("none of {} keys signs with RS256 or ES256", keys->size()));
  return usable;
}

bool is_signed(const VerificationKey& key, std::string_view text, std::string_view signature) {
  const auto wanted = key.algorithm == "ES256" ? der_signature(signature) : std::string(signature);
  const DigestContext digest(EVP_MD_CTX_new());
  const bool good =
      !wanted.empty() && digest &&
      EVP_DigestVerifyInit(digest.get(), nullptr, EVP_sha256(), nullptr, key.key.get()) == 1 &&
      EVP_DigestVerify(digest.get(), bytes_of(wanted), wanted.size(), bytes_of(text),
                       text.size()) == 1;
  if (!good) ERR_clear_error();
  return good;
}

}  // namespace citymesh
