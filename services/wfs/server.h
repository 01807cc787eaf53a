#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "core/citymodel/crs.h"
#include "services/wfs/answers.h"
#include "services/wfs/url.h"
#include "services/wfs/wfs.h"

namespace citymesh::wfs {

/// A WFS and how it wants to be asked.
struct Server {
  WfsOptions options{};
  std::string url{};  ///< with user and password
  std::string shown{};
  std::string version{};
  std::string types{};       ///< as the server spells them
  std::string namespaces{};  ///< of their prefixes: "xmlns(bldg,http://…)"
  Crs crs{};                 ///< of the box: projected where the types have such a one
  std::string srs_name{};    ///< the same as the server spells it, without commas
  bool is_default_crs = true;
  bool north_first = false;     ///< of the box: geographic, latitude first
  std::optional<bool> pages{};  ///< whether it has pages; none: not said
  std::optional<std::uint64_t> count_default{};

  Error error(ErrorCode code, const std::string& what) const;
};

/// Asks for the capabilities. Errors: as open_wfs.
Result<Server> look_at(const WfsOptions& options);

struct Answer {
  std::string body{};
  AnswerHead head{};
};

/// Sends GetFeature; what may pass is tried three times. Errors: as open_wfs, and NotFound.
Result<Answer> get_features(const Server& server, const std::string& url,
                            const std::stop_token& stop);

}  // namespace citymesh::wfs
