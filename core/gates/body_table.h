#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace citymesh {

/// What PLY and VTU say of a body.
struct BodyRecord {
  std::string name{};
  std::uint64_t points = 0, triangles = 0;
};

/// Reads `{"body":0,"name":…,"points":8,"triangles":12,…}`; the number must be the next of the
/// table. Errors: DataLoss.
Result<void> append_body_record(std::string_view json, std::vector<BodyRecord>& table);

/// Reads "0 Unknown 1 GroundSurface …". Errors: DataLoss.
Result<std::vector<std::string>> parse_legend(std::string_view text);

}  // namespace citymesh
