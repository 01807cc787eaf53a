#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/citymodel/mesh.h"
#include "core/write/write.h"

namespace citymesh {

/// What the finished files must hold, body by body.
class Manifest {
 public:
  /// `fingerprints`: the signature of each body's triangles.
  void add(const BuildingBodies& building, std::span<const std::uint64_t> fingerprints);

  /// Re-reads a finished file once. A body is fit when the file holds exactly the triangles that
  /// passed the gates. Errors: DataLoss naming file, body and gate; Cancelled.
  Result<void> check(const Format& format, const std::filesystem::path& file, bool by_type,
                     const RunContext& context) const;

 private:
  std::unordered_map<std::string, std::uint64_t> bodies_;
  std::unordered_set<std::uint64_t> fingerprints_;
  std::uint64_t sum_ = 0;
};

}  // namespace citymesh
