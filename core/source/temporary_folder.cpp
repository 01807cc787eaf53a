#include "core/source/temporary_folder.h"

#include <stdlib.h>

#include <string>
#include <system_error>
#include <utility>

namespace citymesh::source {

namespace fs = std::filesystem;

Result<TemporaryFolder> TemporaryFolder::make(std::string_view purpose) {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "citymesh-XXXXXX").string();
  if (error || !::mkdtemp(name.data()))
    return fail(ErrorCode::Unavailable, "no temporary folder can be made " + std::string(purpose));
  TemporaryFolder folder;
  folder.path_ = name;
  return folder;
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryFolder& TemporaryFolder::operator=(TemporaryFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace citymesh::source
