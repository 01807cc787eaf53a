#include "services/access/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "services/access/base64url.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestToken = 16 << 10;
constexpr std::size_t kLongestSubject = 255;  // OpenID Connect Core, 2

Error refused(std::string why) { return fail(ErrorCode::PermissionDenied, std::move(why)); }

struct Parts {
  json header{}, claims{};
  std::string_view signed_text{};
  std::string signature{};
};

std::optional<json> json_object(std::string_view encoded) {
  const auto text = decode_base64url(encoded);
  if (!text) return std::nullopt;
  auto value = json::parse(*text, nullptr, false);
  if (!value.is_object()) return std::nullopt;
  return value;
}

/// RFC 7515, 7.1: header.claims.signature.
std::optional<Parts> take_apart(std::string_view token) {
  const auto first = token.find('.');
  const auto second = first == token.npos ? token.npos : token.find('.', first + 1);
  if (token.size() > kLongestToken || second == token.npos ||
      token.find('.', second + 1) != token.npos)
    return std::nullopt;
  auto header = json_object(token.substr(0, first));
  auto claims = json_object(token.substr(first + 1, second - first - 1));
  auto signature = decode_base64url(token.substr(second + 1));
  if (!header || !claims || !signature) return std::nullopt;
  return Parts{*std::move(header), *std::move(claims), token.substr(0, second),
               *std::move(signature)};
}

std::string text_claim(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

/// NumericDate: seconds, perhaps with a fraction. Far beyond what a double holds is still a time.
std::optional<double> time_claim(const json& claims, const char* name) {
  const auto found = claims.find(name);
  if (found == claims.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

Result<void> check_signature(const Parts& parts, const std::vector<VerificationKey>& keys) {
  const auto algorithm = text_claim(parts.header, "alg");
  if (algorithm != "RS256" && algorithm != "ES256")
    return refused("the token is not signed with RS256 or ES256");
  if (parts.header.contains("crit"))  // RFC 7515, 4.1.11: none is understood
    return refused("the token needs extensions (`crit`) that are not supported");
  const auto id = text_claim(parts.header, "kid");
  const auto fits = [&](const VerificationKey& key) {
    return key.algorithm == algorithm && (id.empty() || key.id == id);
  };
  if (std::ranges::none_of(keys, fits))
    return refused(fmt::format("no known {} key has the id of the token", algorithm));
  for (const auto& key : keys)
    if (fits(key) && is_signed(key, parts.signed_text, parts.signature)) return {};
  return refused("the signature of the token is wrong");
}

bool names_audience(const json& claims, const std::string& audience) {
  const auto found = claims.find("aud");
  if (found == claims.end()) return false;
  if (found->is_array()) return std::ranges::find(*found, json(audience)) != found->end();
  return *found == audience;
}

Result<void> check_claims(const json& claims, const TokenRules& rules, std::int64_t now_s) {
  const auto now = static_cast<double>(now_s);
  const auto leeway = static_cast<double>(kClockLeeway_s);
  if (text_claim(claims, "iss") != rules.issuer)
    return refused("the token was issued by somebody else (`iss`)");
  if (!names_audience(claims, rules.audience))
    return refused("the token is not meant for this service (`aud`)");
  const auto expires = time_claim(claims, "exp");
  if (!expires) return refused("the token does not say when it expires (`exp`)");
  if (!(now < *expires + leeway)) return refused("the token has expired (`exp`)");
  const auto not_before = time_claim(claims, "nbf");
  if (claims.contains("nbf") && !(not_before && now + leeway >= *not_before))
    return refused("the token is not valid yet (`nbf`)");
  return {};
}

/// By its full name, which may hold dots, or else by its path.
const json* find_claim(const json& claims, std::string_view path) {
  if (const auto whole = claims.find(path); whole != claims.end()) return &*whole;
  const json* value = &claims;
  while (!path.empty()) {
    const auto dot = std::min(path.find('.'), path.size());
    if (!value->is_object()) return nullptr;
    const auto member = value->find(path.substr(0, dot));
    if (member == value->end()) return nullptr;
    value = &*member;
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return value;
}

Role role_of(const json& claims, const TokenRules& rules) {
  auto highest = Role::None;
  const auto consider = [&](std::string_view name) {
    if (!name.starts_with(rules.role_prefix)) return;
    name.remove_prefix(rules.role_prefix.size());
    highest = std::max(highest, role_from(name).value_or(Role::None));
  };
  const auto* claim = find_claim(claims, rules.role_claim);
  if (claim == nullptr) return highest;
  if (claim->is_array())
    for (const auto& name : *claim)
      if (name.is_string()) consider(name.get_ref<const std::string&>());
  if (claim->is_string()) {
    std::string_view names = claim->get_ref<const std::string&>();
    while (!names.empty()) {
      const auto blank = std::min(names.find(' '), names.size());
      consider(names.substr(0, blank));
      names.remove_prefix(std::min(blank + 1, names.size()));
    }
  }
  return highest;
}

}  // namespace

bool names_unknown_key(std::string_view token, const std::vector<VerificationKey>& keys) {
  const auto parts = take_apart(token);
  if (!parts) return false;
  const auto id = text_claim(parts->header, "kid");
  return !id.empty() &&
         std::ranges::none_of(keys, [&](const VerificationKey& key) { return key.id == id; });
}

Result<Client> client_of_token(std::string_view token, const std::vector<VerificationKey>& keys,
                               const TokenRules& rules, std::int64_t now_s) {
  const auto parts = take_apart(token);
  if (!parts) return refused("this is no JSON Web Token and no API key");
  // First of all the signature: nothing of a forged token is looked at.
  if (auto checked = check_signature(*parts, keys); !checked) return checked.error();
  if (auto checked = check_claims(parts->claims, rules, now_s); !checked) return checked.error();
  const auto subject = text_claim(parts->claims, "sub");
  const bool plain = std::ranges::none_of(
      subject, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (subject.empty() || subject.size() > kLongestSubject || !plain)
    return refused(fmt::format(
        "the token does not say whose it is (`sub`, a text of at most {} bytes)", kLongestSubject));
  return Client{"oidc:" + subject, role_of(parts->claims, rules)};
}

}  // namespace citymesh
