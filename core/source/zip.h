#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/source/source.h"

namespace citymesh::source {

struct ZipMember {
  std::filesystem::path path{};  ///< where it has been unpacked to
  std::string name{};            ///< as the archive spells it: for reports, never a path
};

/// Whether the file begins as a zip archive does. Errors: NotFound, PermissionDenied.
Result<bool> is_zip(const std::filesystem::path& path);

/// Unpacks the regular files of an archive into `folder`, numbered, and lists them by name.
/// Folders, links, hidden files and what operating systems leave behind are passed over; archives
/// in the archive stay packed. Nothing of it is left behind when it fails. Errors, which name the
/// member: ResourceExhausted for more than 100,000 members, `max_file_bytes` in all or an absurd
/// ratio of compression; Unimplemented for encryption and unknown compression; DataLoss for damage,
/// which checksums find; NotFound and PermissionDenied for the archive; FailedPrecondition when the
/// folder cannot be written.
Result<std::vector<ZipMember>> unpack_zip(const std::filesystem::path& archive,
                                          const std::filesystem::path& folder,
                                          const ReadLimits& limits);

}  // namespace citymesh::source
