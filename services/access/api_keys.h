#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "services/access/client.h"

namespace citymesh {

/// The API keys that the service accepts, each known by its SHA-256 only. A plain hash is enough: a
/// key is 256 random bits, which nobody finds by trying, however fast the hash. (Slow hashes are
/// for what people think up, and would let strangers load the service with bad keys.)
class ApiKeys {
 public:
  /// One key per line: `NAME ROLE sha256:HEX`; `#` begins a comment. Several keys may carry one
  /// name and then stand for the same client: an old and a new one, or one that submits and one
  /// that only reads. Errors: InvalidArgument naming the line and what is expected.
  static Result<ApiKeys> parse(std::string_view text);

  /// The client whose key this is. Takes the same time for every key of the same length.
  std::optional<Client> find(std::string_view key) const;

  std::size_t size() const { return entries_.size(); }

 private:
  using Hash = std::array<unsigned char, 32>;
  struct Entry {
    Client client{};
    Hash hash{};
  };

  std::vector<Entry> entries_;
};

/// What every key begins with, so that people and secret scanners know one when they see it.
inline constexpr std::string_view kApiKeyPrefix = "citymesh_";

struct NewApiKey {
  std::string key{};   ///< to be shown once
  std::string line{};  ///< for the file of keys
};

/// A key of 256 random bits. Errors: InvalidArgument for a name that is no name, Unavailable when
/// there is no randomness.
Result<NewApiKey> make_api_key(std::string_view name, Role role);

}  // namespace citymesh
