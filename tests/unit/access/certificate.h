#pragma once

#include <filesystem>
#include <string>

namespace citymesh {

/// A new key and a certificate for `localhost` and 127.0.0.1 that it has signed itself.
struct Certificate {
  std::string certificate_pem{};
  std::string key_pem{};
};
Certificate make_certificate();

/// Writes both as `certificate.pem` and `key.pem`.
void write_certificate(const std::filesystem::path& folder, const Certificate& certificate);

}  // namespace citymesh
