#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "tests/support/citydb/test_server.h"

namespace citymesh::citydb_support {

struct LoadOptions {
  Schema schema{};
  /// The file this many times on a square grid without overlaps; gml:ids of the copies end in
  /// "_c1", "_c2" and so on.
  std::uint32_t copies = 1;
  /// Where the file states none; the importers take the time of the import.
  std::string creation_date = "2026-01-02T03:04:05Z";
};

/// What was stored, and what the tables have no place for.
struct LoadReport {
  std::uint64_t buildings = 0;           ///< top-level ones
  std::uint64_t polygons = 0;            ///< rows or faces, copies of shared ones included
  std::uint64_t dropped_rings = 0;       ///< fewer than four corners
  std::uint64_t dropped_cavities = 0;    ///< inner shells
  std::uint64_t dropped_geometries = 0;  ///< second ones of a property, of a LoD without property
  std::uint64_t dropped_surfaces = 0;    ///< of no class, openings of no wall
};

/// Reads a city model and stores it as the official importers do: importer-exporter 5 for version
/// 4, citydb-tool 1 for version 5.
///
/// - Coordinates are not transformed; where the file has north before east they are swapped, as an
///   operator tells the importers to do.
/// - Objects, surfaces and polygons without gml:id get "ID_<uuid>"; so do all geometries above the
///   polygons, whose own ids our reader does not keep. Shared polygons are copied with their id.
/// - Implicit geometry is stored where it was put, nested surfaces as one list.
/// - Attributes that have no column or property of their own become generic ones; "set.name" is put
///   into the set.
/// Everything or nothing is stored. Errors: of the file, and of the database.
Result<LoadReport> load(const std::string& url, const LoadOptions& options,
                        const std::filesystem::path& file);

/// The EPSG code of the horizontal CRS of a file; 0 when it states none.
Result<int> srid_of(const std::filesystem::path& file);

}  // namespace citymesh::citydb_support
