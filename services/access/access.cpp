#include "services/access/access.h"

#include <fmt/format.h>

#include "services/access/api_keys.h"
#include "services/access/key_file.h"

namespace citymesh {
namespace {

bool is_bearer(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  if (authorization.size() < kScheme.size()) return false;
  for (std::size_t i = 0; i < kScheme.size(); ++i) {
    const char c = authorization[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != kScheme[i]) return false;
  }
  return true;
}

std::int64_t now_s() {
  using namespace std::chrono;
  return duration_cast<seconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

struct Access::Known {
  FileState state{};
  ApiKeys keys{};

  static Result<std::shared_ptr<const Known>> read(const std::filesystem::path& file) {
    auto known = std::make_shared<Known>();
    if (file.empty()) return std::shared_ptr<const Known>(std::move(known));
    known->state = state_of(file);
    const auto text = read_key_file(file);
    if (!text) return text.error();
    auto keys = ApiKeys::parse(*text);
    if (!keys) return named(file.string(), keys.error());
    known->keys = *std::move(keys);
    return std::shared_ptr<const Known>(std::move(known));
  }
};

Access::Access(AccessOptions options) : options_(std::move(options)) {}
Access::~Access() = default;

Result<std::unique_ptr<Access>> Access::open(AccessOptions options) {
  auto proxies = Networks::parse(options.trusted_proxies);
  if (!proxies) return proxies.error();
  auto known = Known::read(options.api_keys);
  if (!known) return known.error();
  auto issuer_keys = IssuerKeys::open(options.oidc_jwks);
  if (!issuer_keys) return issuer_keys.error();
  auto access = std::unique_ptr<Access>(new Access(std::move(options)));
  access->trusted_proxies_ = *std::move(proxies);
  access->known_ = *std::move(known);
  access->issuer_keys_ = *std::move(issuer_keys);
  return access;
}

const Access& Access::for_everybody() {
  static const auto access = std::move(open({})).value();
  return *access;
}

bool Access::takes_tokens() const { return !options_.oidc_jwks.source.empty(); }

bool Access::is_required() const { return !options_.api_keys.empty() || takes_tokens(); }

std::shared_ptr<const Access::Known> Access::known() const {
  const std::scoped_lock lock(mutex_);
  return known_;
}

Result<bool> Access::reload() {
  auto issuer_keys = issuer_keys_->reload();
  if (state_of(options_.api_keys) == known()->state) return issuer_keys;
  auto now = Known::read(options_.api_keys);
  if (!now) return now.error();
  {
    const std::scoped_lock lock(mutex_);
    known_ = *std::move(now);
  }
  if (!issuer_keys) return issuer_keys;
  return true;
}

Result<Client> Access::identify(const Credentials& credentials) const {
  if (!is_required()) {
    // Those on this machine are one and the same to us; others are told apart by where they are.
    const bool local = credentials.address.empty() || is_loopback_address(credentials.address);
    return Client{local ? std::string{} : "address:" + credentials.address, Role::Admin};
  }
  if (credentials.api_key.empty() && credentials.authorization.empty()) return Client{};

  std::string_view secret = credentials.api_key;
  if (secret.empty()) {
    secret = credentials.authorization;
    if (!is_bearer(secret))
      return fail(ErrorCode::PermissionDenied, "Authorization is of another kind than Bearer");
    secret.remove_prefix(secret.find(' '));
    while (secret.starts_with(' ')) secret.remove_prefix(1);
  }
  const auto known = this->known();
  if (auto client = known->keys.find(secret)) return *std::move(client);
  if (secret.starts_with(kApiKeyPrefix) || !credentials.api_key.empty())
    return fail(ErrorCode::PermissionDenied, "the API key is not known");
  if (!takes_tokens())
    return fail(ErrorCode::PermissionDenied, "the API key is not known, and tokens are not taken");
  auto issuer_keys = issuer_keys_->current();
  if (names_unknown_key(secret, *issuer_keys)) issuer_keys = issuer_keys_->look_again();
  return client_of_token(secret, *issuer_keys, options_.token_rules, now_s());
}

}  // namespace citymesh
