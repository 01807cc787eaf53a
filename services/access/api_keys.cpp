#include "services/access/api_keys.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>

#include "services/access/base64url.h"

namespace citymesh {
namespace {

constexpr std::string_view kHashPrefix = "sha256:";
constexpr std::size_t kLongestName = 64;
constexpr std::string_view kNameExpected =
    "a name of 1 to 64 letters, digits, dots, hyphens and underscores";

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == '_';
  });
}

std::array<unsigned char, 32> sha256(std::string_view text) {
  std::array<unsigned char, 32> hash{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash.data());
  return hash;
}

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

std::optional<std::array<unsigned char, 32>> parse_hash(std::string_view text) {
  std::array<unsigned char, 32> hash{};
  if (!text.starts_with(kHashPrefix)) return std::nullopt;
  text.remove_prefix(kHashPrefix.size());
  if (text.size() != 2 * hash.size()) return std::nullopt;
  for (std::size_t i = 0; i < hash.size(); ++i) {
    const auto high = hex_digit(text[2 * i]);
    const auto low = hex_digit(text[2 * i + 1]);
    if (!high || !low) return std::nullopt;
    hash[i] = static_cast<unsigned char>(*high * 16 + *low);
  }
  return hash;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.empty()) return words;
    const auto end = std::min(line.find_first_of(kBlanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

}  // namespace

Result<ApiKeys> ApiKeys::parse(std::string_view text) {
  ApiKeys keys;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = std::min(text.find('\n'), text.size());
    const auto words = words_of(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (words.empty()) continue;
    // What stands there may be a key by mistake: it is never repeated.
    const auto refuse = [number](std::string_view what) {
      return fail(ErrorCode::InvalidArgument, fmt::format("line {}: {}", number, what));
    };
    if (words.size() != 3)
      return refuse(
          fmt::format("{} words, expected NAME ROLE sha256:HEX as `citymesh make-key` prints them",
                      words.size()));
    if (!is_name(words[0])) return refuse(fmt::format("expected {}", kNameExpected));
    const auto role = role_from(words[1]);
    if (!role) return refuse("unknown role, expected read-own, submit, write-back or admin");
    const auto hash = parse_hash(words[2]);
    if (!hash) return refuse("the key is no hash, expected sha256: and 64 hexadecimal digits");
    if (std::ranges::any_of(keys.entries_, [&](const Entry& e) { return e.hash == *hash; }))
      return refuse("this key stands in the file already");
    keys.entries_.push_back({{fmt::format("key:{}", words[0]), *role}, *hash});
  }
  return keys;
}

std::optional<Client> ApiKeys::find(std::string_view key) const {
  const auto hash = sha256(key);
  const Entry* found = nullptr;
  for (const auto& entry : entries_)  // always all of them
    if (CRYPTO_memcmp(entry.hash.data(), hash.data(), hash.size()) == 0) found = &entry;
  if (found == nullptr) return std::nullopt;
  return found->client;
}

Result<NewApiKey> make_api_key(std::string_view name, Role role) {
  if (!is_name(name))
    return fail(ErrorCode::InvalidArgument,
                fmt::format("'{}' cannot name a key, expected {}", name, kNameExpected));
  std::array<unsigned char, 32> bytes{};
  if (RAND_priv_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    return fail(ErrorCode::Unavailable, "the system gives no random numbers for a key");
  NewApiKey made;
  made.key =
      fmt::format("{}{}", kApiKeyPrefix,
                  encode_base64url({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  OPENSSL_cleanse(bytes.data(), bytes.size());
  made.line = fmt::format("{} {} {}{:02x}", name, to_string(role), kHashPrefix,
                          fmt::join(sha256(made.key), ""));
  return made;
}

}  // namespace citymesh
