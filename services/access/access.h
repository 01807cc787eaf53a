#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "core/base/result.h"
#include "services/access/client.h"
#include "services/access/issuer_keys.h"
#include "services/access/networks.h"
#include "services/access/tokens.h"

namespace citymesh {

struct AccessOptions {
  std::filesystem::path api_keys{};  ///< file of ApiKeys::parse; empty: none are accepted
  IssuerKeyOptions oidc_jwks{};      ///< without a source no tokens are accepted
  TokenRules token_rules{};
  std::string trusted_proxies{};  ///< Networks whose forwarded headers are believed; empty: none
};

/// What a request says about who sent it.
struct Credentials {
  std::string authorization{};  ///< the header: `Bearer` and a token or an API key
  std::string api_key{};        ///< the header X-API-Key; it counts before the other
  std::string address{};        ///< of the client; names it where nobody has to show who he is
};

/// Knows the clients of the service. Thread-safe.
class Access {
 public:
  /// Without any keys everybody may do everything. Errors: those of reading them, with the name of
  /// the file or address.
  static Result<std::unique_ptr<Access>> open(AccessOptions options);
  /// Where everybody may do everything.
  static const Access& for_everybody();
  ~Access();
  Access(const Access&) = delete;
  Access& operator=(const Access&) = delete;

  bool is_required() const;  ///< whether clients have to show who they are

  /// The client of a request. One that shows nothing has no role, or where nobody has to, every
  /// one. Every error means that what it shows proves nothing. May block as
  /// IssuerKeys::look_again.
  Result<Client> identify(const Credentials& credentials) const;

  const Networks& trusted_proxies() const { return trusted_proxies_; }

  /// Reads files that have changed and fetches what is old; true if it did. After an error what was
  /// read before stays in force.
  Result<bool> reload();

 private:
  struct Known;
  explicit Access(AccessOptions options);
  std::shared_ptr<const Known> known() const;
  bool takes_tokens() const;

  const AccessOptions options_;
  Networks trusted_proxies_;
  std::unique_ptr<IssuerKeys> issuer_keys_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Known> known_;
};

}  // namespace citymesh
