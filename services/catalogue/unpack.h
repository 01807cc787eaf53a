#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::catalogue {

/// A hash of the file's bytes, as hexadecimal digits. Errors: Unavailable.
Result<std::string> content_hash(const std::filesystem::path& file);

/// The city models that a file of the data folder holds: itself, what is packed in it as a copy
/// below `folder`, or each member of an archive. Errors: Unavailable for the copies; those of
/// ReadLimits and of damaged archives.
Result<std::vector<source::FileRecord>> unpack(const source::FileRecord& file,
                                               const std::filesystem::path& folder,
                                               const ReadLimits& limits);

}  // namespace citymesh::catalogue
