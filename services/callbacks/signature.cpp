#include "services/callbacks/signature.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>
#include <fstream>
#include <iterator>

namespace citymesh {
namespace {

constexpr std::size_t kShortestSecret = 16;
constexpr std::size_t kLongestSecret = 4096;

}  // namespace

std::string hmac_sha256(std::string_view secret, std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
           reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data(),
           &size) == nullptr)
    return {};
  std::string hex;
  for (unsigned i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

std::string signature(std::string_view secret, std::int64_t unix_seconds, std::string_view body) {
  return fmt::format("t={},v1={}", unix_seconds,
                     hmac_sha256(secret, fmt::format("{}.{}", unix_seconds, body)));
}

Result<std::string> read_secret(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string secret(kLongestSecret + 1, '\0');
  in.read(secret.data(), static_cast<std::streamsize>(secret.size()));
  if (in.bad() || (!in.eof() && in.gcount() == 0))
    return fail(ErrorCode::Unavailable, fmt::format("secret '{}' cannot be read", file));
  secret.resize(static_cast<std::size_t>(in.gcount()));
  while (secret.ends_with('\n') || secret.ends_with('\r')) secret.pop_back();
  if (secret.size() < kShortestSecret || secret.size() > kLongestSecret)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("secret '{}' has {} bytes, expected {} to {}", file, secret.size(),
                            kShortestSecret, kLongestSecret));
  return secret;
}

}  // namespace citymesh
