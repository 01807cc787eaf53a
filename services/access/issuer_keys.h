#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "services/access/jwks.h"
#include "services/access/key_file.h"

namespace citymesh {

struct IssuerKeyOptions {
  /// A file, or an address: https, on this machine http, too. Empty: there are no keys.
  std::string source{};
  double timeout_s = 3;                     ///< of fetching
  std::chrono::milliseconds pause{30'000};  ///< between two times of looking for an unknown key
  std::chrono::milliseconds longest_age{300'000};  ///< after which `reload` fetches again
};

/// The public keys of those who issue tokens, from a file or from the address where the provider
/// publishes them. Thread-safe.
class IssuerKeys {
 public:
  using Keys = std::shared_ptr<const std::vector<VerificationKey>>;

  /// Errors: those of the file or of fetching it, and what parse_jwks finds, with the source's
  /// name.
  static Result<std::unique_ptr<IssuerKeys>> open(IssuerKeyOptions options);

  Keys current() const;

  /// Reads a changed file, or fetches what is old or could not be fetched; true if it did. After an
  /// error those read before stay in force.
  Result<bool> reload();

  /// The keys after a look for new ones: a provider that changes its keys signs with one that is
  /// not known yet. Waits at most `timeout_s` for somebody else's look and as long for its own, and
  /// looks at most once in every `pause`, for anybody can name keys that do not exist.
  Keys look_again();

 private:
  using Clock = std::chrono::steady_clock;

  explicit IssuerKeys(IssuerKeyOptions options);
  Result<void> read();
  Result<void> try_to_read();

  const IssuerKeyOptions options_;
  const bool is_fetched_;
  std::timed_mutex reading_;  ///< held while reading; protects what follows
  FileState file_{};
  Clock::time_point last_try_{};
  bool has_failed_ = false;  ///< the last try
  mutable std::mutex mutex_;
  Keys keys_ = std::make_shared<const std::vector<VerificationKey>>();
};

}  // namespace citymesh
