#pragma once

#include <filesystem>
#include <string_view>

#include "core/base/result.h"

namespace citymesh::source {

/// A folder of its own below the system's for such things, closed to other users, removed at the
/// end.
class TemporaryFolder {
 public:
  /// `purpose`: ends the message when there can be none, "to unpack archives". Errors: Unavailable.
  static Result<TemporaryFolder> make(std::string_view purpose);

  TemporaryFolder() = default;
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&& other) noexcept;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_{};
};

}  // namespace citymesh::source
