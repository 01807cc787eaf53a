#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// The folder that `--output` names. Files are written to a hidden folder inside it and moved to
/// their place when the run is complete; a run that fails or is stopped leaves nothing behind.
class OutputFolder {
 public:
  /// Creates the folder and its parents. Errors: FailedPrecondition for a folder that is not empty
  /// unless `overwrite`, Unavailable for one that cannot be written.
  static Result<OutputFolder> open(const std::filesystem::path& folder, bool overwrite);
  /// A folder of its own under the system's temporary folder, removed at the end.
  static Result<OutputFolder> temporary();

  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  const std::filesystem::path& staged() const { return staged_; }
  const std::filesystem::path& folder() const { return folder_; }

  /// Moves the files to their place; result files of an earlier run that are not among them go.
  Result<void> publish(const std::vector<std::string>& files);

 private:
  OutputFolder(std::filesystem::path folder, std::filesystem::path staged);

  std::filesystem::path folder_;
  std::filesystem::path staged_;
};

}  // namespace citymesh
