#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/source/source.h"

namespace citymesh {

/// The city models at some paths: one folder that has been indexed, and whose catalogue can be
/// written, through it; anything else as files. Errors: as open_files.
Result<std::unique_ptr<CitySource>> open_input(const std::vector<std::filesystem::path>& paths);

}  // namespace citymesh
