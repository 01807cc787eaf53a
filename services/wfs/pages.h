#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/source/catalogue.h"

namespace citymesh::wfs {

/// Downloaded files. A building that an earlier one has is left out.
class Pages final : public source::Catalogue {
 public:
  struct Added {
    std::uint64_t buildings = 0;  ///< in the file
    std::uint64_t fresh = 0;      ///< of them not in an earlier one
  };
  /// Looks through a file. Errors: DataLoss when it cannot be read to its end, FailedPrecondition
  /// when it is no city model, Cancelled.
  Result<Added> add(const std::filesystem::path& path, const ReadLimits& limits,
                    const std::stop_token& stop);

  std::size_t count() const { return files_.size(); }
  std::uint64_t buildings() const { return buildings_; }
  /// Of buildings and what belongs to them.
  const std::unordered_set<std::string>& ids() const { return ids_; }

  Result<std::vector<std::shared_ptr<const source::FileRecord>>> files(bool,
                                                                       const RunContext&) override;
  Result<void> buildings(const source::FileRecord& file, const source::RecordQuery& query,
                         const source::RecordSink& sink) override;

 private:
  std::vector<std::shared_ptr<const source::FileRecord>> files_{};
  std::unordered_set<std::string> ids_{};
  std::uint64_t buildings_ = 0;
};

}  // namespace citymesh::wfs
