#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace citymesh {

/// By which a changed file is known.
struct FileState {
  std::filesystem::file_time_type written{};
  std::uintmax_t bytes = 0;
  friend bool operator==(const FileState&, const FileState&) = default;
};
FileState state_of(const std::filesystem::path& file);

/// The content of a file of keys. Errors: NotFound, InvalidArgument for one that is too large.
Result<std::string> read_key_file(const std::filesystem::path& file);

/// An error with the name of the file or address that it is about.
Error named(const std::string& where, const Error& error);

}  // namespace citymesh
