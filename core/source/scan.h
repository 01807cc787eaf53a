#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/source/area.h"
#include "core/source/document.h"

namespace citymesh::source {

/// What a selection needs to know of a top-level building; coordinates and axes as in the file.
struct ScannedBuilding {
  std::string gml_id{};
  std::vector<std::string> part_ids{};
  Box3 extent{};                                 ///< empty: no geometry
  std::uint32_t srs = 0;                         ///< of its first polygon
  std::uint32_t first_ring = 0, ring_count = 0;  ///< run of Footprints::rings
};

/// A file read once from front to back, without keeping its geometry.
struct FileScan {
  std::filesystem::path path{};
  std::optional<Format> format{};  ///< none: not recognised, the reason is `facts.failure`
  DocumentFacts facts{};
  std::vector<ScannedBuilding> buildings{};
  std::shared_ptr<const SharedGeometry> shared{};
  bool has_footprints = false;
  Footprints footprints{};
};

/// Reads the file up to three times when buildings of it borrow geometry from each other. Errors:
/// Cancelled.
Result<FileScan> scan_file(const std::filesystem::path& path, const ReadLimits& limits,
                           bool with_footprints, const std::stop_token& stop);

}  // namespace citymesh::source
