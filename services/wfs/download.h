#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/wfs/pages.h"
#include "services/wfs/server.h"

namespace citymesh::wfs {

struct Content {
  std::shared_ptr<Pages> pages{};
  std::vector<std::string> warnings{};
};

/// Stores what a query asks for as files in a folder: all that the server finds in the box, or
/// everything where there is neither box nor ids, then what was not among it of the ids. Errors: as
/// CitySource::select and open_wfs.
Result<Content> download(const Server& server, const BuildingQuery& query,
                         const std::filesystem::path& folder, const RunContext& context);

/// How many features there are in the box, a little enlarged, or altogether, in the server's own
/// words; none: it does not say. Errors: as download().
Result<std::optional<std::uint64_t>> count(const Server& server, const BuildingQuery& query,
                                           const RunContext& context);

}  // namespace citymesh::wfs
