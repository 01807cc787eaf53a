#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/source/source.h"

namespace citymesh {

struct CatalogueOptions {
  std::filesystem::path data{};   ///< the folder of city models
  std::filesystem::path state{};  ///< where the catalogue and unpacked copies are kept
  FileSourceOptions source{};
};

/// Where `citymesh index DIR` keeps the catalogue unless told otherwise.
std::filesystem::path default_catalogue(const std::filesystem::path& data);

/// Whether a catalogue has been made there.
bool has_catalogue(const std::filesystem::path& state);

struct CatalogueReport {
  std::uint64_t files = 0;      ///< in the folder, members of archives counted one by one
  std::uint64_t indexed = 0;    ///< new or changed
  std::uint64_t unchanged = 0;  ///< by size and time, or by content
  std::uint64_t removed = 0;    ///< no longer there
  std::uint64_t bytes = 0;      ///< read for indexing, as unpacked
  std::uint64_t buildings = 0;  ///< in the whole catalogue
  std::vector<std::pair<std::string, std::string>> problems{};  ///< file, why it was not read
};

/// Brings the catalogue of a folder up to date; makes it if there is none. Files that have not
/// changed are not read. Several processes may do it at the same time. Progress counts files.
/// Errors: NotFound, PermissionDenied for the folder; Unavailable when the catalogue cannot be
/// written; Cancelled, with what has been done kept.
Result<CatalogueReport> update_catalogue(const CatalogueOptions& options,
                                         const RunContext& context);

/// The city models of a folder through its catalogue, which is brought up to date by each
/// selection: a box or an id is found without reading files. Errors: as update_catalogue.
Result<std::unique_ptr<CitySource>> open_catalogued(const CatalogueOptions& options);

}  // namespace citymesh
