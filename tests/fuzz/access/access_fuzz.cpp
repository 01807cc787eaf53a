// What strangers send to be let in, and the files that say whom to let in: nothing of it may break
// the reader, and nobody gets in without a key.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "services/access/api_keys.h"
#include "services/access/base64url.h"
#include "services/access/jwks.h"
#include "services/access/networks.h"
#include "services/access/tokens.h"

namespace {

using namespace citymesh;

void demand(bool promise) {
  if (!promise) abort();
}

// A key of P-256 whose private half nobody has kept (RFC 7517, A.1).
constexpr std::string_view kIssuer = R"({"keys":[{"kty":"EC","crv":"P-256",
  "x":"MKBCTNIcKUSDii11ySs3526iDZ8AiTo7Tu6KPAqv7D4",
  "y":"4Etl6SRW2YiLUrN5vfvVHuhp7x8PxltmWWlbbM4IFyM"}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static const auto issuer = parse_jwks(kIssuer);
  demand(issuer.has_value());

  const auto client = client_of_token(text, *issuer, {.issuer = "i", .audience = "a"}, 1'000);
  demand(!client && !client.error().message.empty());

  if (const auto keys = ApiKeys::parse(text); keys)
    demand(!keys->find(text));
  else
    demand(!keys.error().message.empty());
  if (const auto set = parse_jwks(text); set) demand(!set->empty());
  if (const auto bytes = decode_base64url(text); bytes) demand(encode_base64url(*bytes) == text);

  if (const auto networks = Networks::parse(text); networks) {
    (void)networks->contains(text);
    const auto sender = sender_of("10.0.0.1", {std::string(text), std::string(text)}, *networks);
    demand(!sender.address.empty() && sender.proxies <= 3);
  }
  return 0;
}
