#include "services/rest/tls.h"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <boost/asio/ssl/context.hpp>
#include <string_view>
#include <system_error>

namespace citymesh {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

/// HTTP/1.1 for clients that ask by ALPN (RFC 7301), whatever else they would take.
int choose_protocol(SSL*, const unsigned char** chosen, unsigned char* size,
                    const unsigned char* offered, unsigned int offered_bytes, void*) {
  constexpr std::string_view kHttp = "\x08http/1.1";
  const std::string_view all(reinterpret_cast<const char*>(offered), offered_bytes);
  for (std::size_t at = 0; at < all.size(); at += 1u + static_cast<unsigned char>(all[at])) {
    if (all.substr(at, kHttp.size()) != kHttp) continue;
    *chosen = offered + at + 1;
    *size = static_cast<unsigned char>(kHttp.size() - 1);
    return SSL_TLSEXT_ERR_OK;
  }
  return SSL_TLSEXT_ERR_ALERT_FATAL;
}

}  // namespace

std::filesystem::file_time_type last_written(const TlsFiles& files) {
  std::error_code ignored;
  return std::max(std::filesystem::last_write_time(files.certificate, ignored),
                  std::filesystem::last_write_time(files.key, ignored));
}

Result<TlsContext> make_tls_context(const TlsFiles& files) {
  error_code error;
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  auto* native = context->native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
  SSL_CTX_set_options(
      native, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_alpn_select_cb(native, choose_protocol, nullptr);
  // A key behind a password would be asked for on the terminal.
  context->set_password_callback(
      [](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);

  const auto refuse = [&](std::string_view what, const std::filesystem::path& file,
                          std::string_view expected) {
    ERR_clear_error();
    return fail(ErrorCode::InvalidArgument,
                fmt::format("{} '{}' cannot be used ({}), expected {}", what, file.string(),
                            error.message(), expected));
  };
  context->use_certificate_chain_file(files.certificate.string(), error);
  if (error)
    return refuse("TLS certificate", files.certificate,
                  "a PEM file with the certificate and those that issued it");
  context->use_private_key_file(files.key.string(), ssl::context::pem, error);
  if (error)
    return refuse("TLS key", files.key,
                  "a PEM file without a password, with the key of the certificate");
  return context;
}

}  // namespace citymesh
