#pragma once

#include <cstdint>
#include <memory>

#include "core/processes/inputs.h"
#include "core/source/source.h"

namespace citymesh {

/// How much one job may take from a source. 0: no limit.
struct JobLimits {
  std::uint64_t buildings = 0;
  std::uint64_t points = 0;  ///< of all buildings read, parts and installations included
};

/// Whether box or polygon is small enough: known before a source is asked. Errors: InvalidArgument,
/// with its area.
Result<void> check_area(const Inputs& inputs, double max_km2);

/// The source within limits: a selection or a reading that exceeds one ends with ResourceExhausted,
/// which names the limit and how much it was.
std::unique_ptr<CitySource> limited(std::unique_ptr<CitySource> source, const JobLimits& limits);

}  // namespace citymesh
