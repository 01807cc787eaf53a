#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/source/source.h"

namespace citymesh {

/// What a run would process and leave behind, told before anything is read but what the source
/// knows of its buildings.
struct Estimate {
  struct Output {
    std::string output{};  ///< id: `report` or a format
    std::uint64_t bytes = 0;
  };

  std::string process{};
  std::uint64_t buildings = 0;  ///< that would be processed; exact
  /// Triangles and sizes go by what cities usually need: right within a factor of three for most.
  std::uint64_t triangles = 0;
  std::vector<Output> outputs{};
  std::uint64_t bytes = 0;  ///< of the outputs together
  std::string crs{};        ///< the run would work in; empty: metres, not known which
  /// What is wrong already, for people: inputs that cannot be read, ids that nothing has, nothing
  /// selected, warnings of the source.
  std::vector<std::string> problems{};
};

/// Errors: those of run() that do not need buildings to be read.
Result<Estimate> estimate(std::string_view process, std::string_view inputs_json,
                          CitySource& source, const RunContext& context);

/// `process`, `buildings`, `expected` (`triangles`, `bytes`, `outputs` by id), `crs`, `problems`.
std::string to_json(const Estimate& estimate);

}  // namespace citymesh
