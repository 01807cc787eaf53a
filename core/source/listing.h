#pragma once

#include <filesystem>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::source {

/// The files that are named, and those directly in the folders that are named in the order of their
/// names, hidden ones left out; nothing in them has been looked at. Errors: NotFound,
/// PermissionDenied, FailedPrecondition naming the path.
Result<std::vector<FileRecord>> list_files(const std::vector<std::filesystem::path>& paths);

/// The members of an archive as files of their own, unpacked into `folder`: named
/// "tiles.zip/a.gml", passed over when they are no city models. Errors: as unpack_zip.
Result<std::vector<FileRecord>> unpack_archive(const FileRecord& archive,
                                               const std::filesystem::path& folder,
                                               const ReadLimits& limits);

}  // namespace citymesh::source
