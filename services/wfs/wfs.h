#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/source/source.h"

namespace citymesh {

struct WfsOptions {
  std::string url{};  ///< http(s)://user:password@host/path: where GetCapabilities is answered
  std::string type_names = "bldg:Building";  ///< by comma
  std::string output_format{};               ///< empty: the server's default
  std::uint32_t page = 500;                  ///< features asked for at once
  double timeout_s = 300;                    ///< of one answer
  double retry_pause_s = 1;                  ///< before the second try; twice that before the third
  std::uint64_t max_answer_bytes = 256ull << 20;
  std::uint64_t max_download_bytes = 16ull << 30;  ///< of all answers of a selection, on disk
  std::uint64_t max_features = 0;                  ///< of a selection; 0: no limit
  ReadLimits limits{};
};

/// What a source is for. One that counts selects without downloading wherever the server says how
/// many buildings there are; these cannot be read.
enum class WfsUse { Reading, Counting };

/// Opens sources over one Web Feature Service 2.0.
using WfsFactory = std::function<Result<std::unique_ptr<CitySource>>(WfsUse use)>;

/// `select` downloads what a box (enlarged a little) or the ids ask for into a folder of its own
/// below the system's for temporary files, and chooses from that as from files; the folder lives as
/// long as the selection. Buildings that come twice, by their gml:id, count once. What fails
/// because of the network or a server that is busy is tried three times. Redirects are not
/// followed. Errors, which name the server without user, password and query: Unavailable,
/// DeadlineExceeded; PermissionDenied; ResourceExhausted for a limit, also one of the server that
/// keeps back a part; FailedPrecondition with the server's own words, or for what is no WFS 2.0 or
/// lacks the types; DataLoss for an answer that cannot be read. `open_wfs` asks for the
/// capabilities.
Result<WfsFactory> open_wfs(const WfsOptions& options);

/// What may be shown of the address of a WFS: no user, no password, no query.
std::string shown_wfs_url(const std::string& url);

}  // namespace citymesh
