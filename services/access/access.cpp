#include "services/access/access.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <system_error>
#include <tuple>

#include "services/access/api_keys.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostFileBytes = 16 << 20;

struct FileState {
  fs::file_time_type written{};
  std::uintmax_t bytes = 0;
  friend bool operator==(const FileState&, const FileState&) = default;
};

FileState state_of(const fs::path& file) {
  std::error_code ignored;
  FileState state;
  if (file.empty()) return state;
  state.written = fs::last_write_time(file, ignored);
  state.bytes = fs::file_size(file, ignored);
  return state;
}

Result<std::string> read_small_file(const fs::path& file) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  std::ifstream input(file, std::ios::binary);
  if (error || !input)
    return fail(ErrorCode::NotFound, fmt::format("'{}' cannot be read", file.string()));
  if (bytes > kMostFileBytes)
    return fail(ErrorCode::InvalidArgument, fmt::format("'{}' has {} bytes, expected at most {}",
                                                        file.string(), bytes, kMostFileBytes));
  return std::string(std::istreambuf_iterator<char>(input), {});
}

Error in_file(const fs::path& file, const Error& error) {
  return fail(error.code, fmt::format("'{}': {}", file.string(), error.message));
}

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
  FileState keys_state{}, jwks_state{};
  ApiKeys keys{};
  std::vector<VerificationKey> issuer_keys{};

  static Result<std::shared_ptr<const Known>> read(const AccessOptions& options) {
    auto known = std::make_shared<Known>();
    known->keys_state = state_of(options.api_keys);
    known->jwks_state = state_of(options.oidc_jwks_file);
    if (const auto& file = options.api_keys; !file.empty()) {
      const auto text = read_small_file(file);
      if (!text) return text.error();
      auto keys = ApiKeys::parse(*text);
      if (!keys) return in_file(file, keys.error());
      known->keys = *std::move(keys);
    }
    if (const auto& file = options.oidc_jwks_file; !file.empty()) {
      const auto text = read_small_file(file);
      if (!text) return text.error();
      auto keys = parse_jwks(*text);
      if (!keys) return in_file(file, keys.error());
      known->issuer_keys = *std::move(keys);
    }
    return std::shared_ptr<const Known>(std::move(known));
  }
};

Access::Access(AccessOptions options) : options_(std::move(options)) {}
Access::~Access() = default;

Result<std::unique_ptr<Access>> Access::open(AccessOptions options) {
  auto proxies = Networks::parse(options.trusted_proxies);
  if (!proxies) return proxies.error();
  auto known = Known::read(options);
  if (!known) return known.error();
  auto access = std::unique_ptr<Access>(new Access(std::move(options)));
  access->trusted_proxies_ = *std::move(proxies);
  access->known_ = *std::move(known);
  return access;
}

const Access& Access::for_everybody() {
  static const auto access = std::move(open({})).value();
  return *access;
}

bool Access::is_required() const {
  return !options_.api_keys.empty() || !options_.oidc_jwks_file.empty();
}

std::shared_ptr<const Access::Known> Access::known() const {
  const std::scoped_lock lock(mutex_);
  return known_;
}

Result<bool> Access::reload() {
  const auto before = known();
  if (state_of(options_.api_keys) == before->keys_state &&
      state_of(options_.oidc_jwks_file) == before->jwks_state)
    return false;
  auto now = Known::read(options_);
  if (!now) return now.error();
  const std::scoped_lock lock(mutex_);
  known_ = *std::move(now);
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
  if (options_.oidc_jwks_file.empty())
    return fail(ErrorCode::PermissionDenied, "the API key is not known, and tokens are not taken");
  return client_of_token(secret, known->issuer_keys, options_.token_rules, now_s());
}

}  // namespace citymesh
