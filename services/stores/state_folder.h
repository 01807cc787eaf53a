#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace citymesh {

/// The folder under `--state`, held by a lock on its file `lock` for as long as this object lives
/// and the process runs. Several processes may hold it; the first one knows that it is alone.
class StateFolder {
 public:
  /// Creates the folder if needed. Errors: Unavailable naming folder and reason.
  static Result<StateFolder> open(const std::filesystem::path& folder);

  StateFolder(StateFolder&& other) noexcept;
  StateFolder& operator=(StateFolder&& other) noexcept;
  ~StateFolder();

  /// No other process held the folder when it was opened; others wait until share().
  bool alone() const { return alone_; }
  /// Lets other processes in.
  Result<void> share();

  std::filesystem::path jobs_file() const { return folder_ / "jobs.sqlite"; }
  std::filesystem::path results_folder() const { return folder_ / "results"; }

 private:
  StateFolder(std::filesystem::path folder, int lock, bool alone);

  std::filesystem::path folder_;
  int lock_ = -1;
  bool alone_ = false;
};

}  // namespace citymesh
