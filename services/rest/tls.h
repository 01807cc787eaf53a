#pragma once

#include <filesystem>
#include <memory>

#include "core/base/result.h"
#include "services/rest/server.h"

namespace boost::asio::ssl {
class context;
}

namespace citymesh {

using TlsContext = std::shared_ptr<boost::asio::ssl::context>;

/// When either file was written last.
std::filesystem::file_time_type last_written(const TlsFiles& files);

/// For the server's side of TLS 1.2 and above. Errors: InvalidArgument naming the file that cannot
/// be used, or a key that is not that of the certificate.
Result<TlsContext> make_tls_context(const TlsFiles& files);

}  // namespace citymesh
