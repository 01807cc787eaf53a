#pragma once

#include <filesystem>
#include <string>

namespace citymesh {

/// Text that differs whenever a file of the data does, as far as the file system tells: by name,
/// size and the times of the last change of content and of rights. `data` is a folder of city
/// models or one of them. Empty when it cannot be told.
std::string data_version(const std::filesystem::path& data);

}  // namespace citymesh
