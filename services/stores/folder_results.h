#pragma once

#include <filesystem>

#include "services/jobs/stores.h"

namespace citymesh {

/// Results under `<root>/<job>/attempt-<n>`. While an attempt is being written its folder ends in
/// `.partial`; commit flushes and renames it. Of several committed attempts the last one counts.
/// Files that are reused are hard links, where the file system has them.
class FolderResultStore final : public ResultStore {
 public:
  /// Creates `root` if needed. Errors: Unavailable naming the folder.
  static Result<std::unique_ptr<FolderResultStore>> open(const std::filesystem::path& root);

  Result<std::filesystem::path> stage(const std::string& job_id, std::uint32_t attempt) override;
  Result<void> reuse(const std::string& from_job_id, const std::vector<ResultFile>& files,
                     const std::string& job_id, std::uint32_t attempt) override;
  Result<void> commit(const std::string& job_id, std::uint32_t attempt) override;
  Result<void> discard(const std::string& job_id, std::uint32_t attempt) override;
  Result<std::string> read(const std::string& job_id, const std::string& file_name,
                           std::uint64_t offset, std::uint64_t max_bytes) override;
  Result<std::uint64_t> size(const std::string& job_id, const std::string& file_name) override;
  Result<void> erase(const std::string& job_id) override;

 private:
  explicit FolderResultStore(std::filesystem::path root) : root_(std::move(root)) {}

  std::filesystem::path root_;
};

}  // namespace citymesh
