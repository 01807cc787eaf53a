#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/source/source.h"
#include "services/wfs/wfs.h"
#include "tests/support/wfs/test_wfs.h"

namespace citymesh::wfs_support {

/// What a source gives for a query: everything of the buildings as text, ordered by it.
struct Reading {
  Error error{};  ///< of the first step that failed; an empty message: none
  Selection selection{};
  std::vector<std::string> buildings{};
};

Reading read(CitySource& source, const BuildingQuery& query);
Reading read_file(const std::filesystem::path& file, const BuildingQuery& query);

/// With short pauses and pages of seven.
WfsOptions options_for(const TestWfs& server);
Reading read_wfs(const TestWfs& server, const BuildingQuery& query);
Reading read_wfs(const WfsOptions& options, const BuildingQuery& query);

}  // namespace citymesh::wfs_support
