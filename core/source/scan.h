#pragma once

#include <filesystem>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::source {

struct FileScan : FileRecord {
  std::vector<BuildingRecord> records{};
  bool has_footprints = false;
};

/// Reads a file once from front to back, without keeping its geometry; up to three times when
/// buildings of it borrow geometry from each other. `text` is read, `path` only named. Errors:
/// Cancelled.
Result<FileScan> scan_file(FileRecord file, const ReadLimits& limits, bool with_footprints,
                           const std::stop_token& stop);

/// The polygons that a building and its parts are drawn with on a map: ground surfaces, else
/// footprints, else everything.
Footprints footprints_of(const Feature& feature);

/// A file that is its own text.
FileRecord plain_file(const std::filesystem::path& path);

}  // namespace citymesh::source
