#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::catalogue {

/// A hash of the file's bytes, as hexadecimal digits. Errors: Unavailable.
Result<std::string> content_hash(const std::filesystem::path& file);

/// Where unpacked copies of a file are: of this name and this content, of no other.
std::filesystem::path copies_of(const std::filesystem::path& state, const std::string& name,
                                const std::string& content_hash);

/// The city models that a file of the data folder holds: itself, what is packed in it as a copy in
/// `copies`, or each member of an archive. The copies appear complete or not at all, also when
/// several processes make them. Errors: Unavailable for the copies; those of ReadLimits and of
/// damaged archives.
Result<std::vector<source::FileRecord>> unpack(const source::FileRecord& file,
                                               const std::filesystem::path& copies,
                                               const ReadLimits& limits);

}  // namespace citymesh::catalogue
