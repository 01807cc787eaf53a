#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/shell.h"
#include "core/geometry/point.h"
#include "core/reconstruct/reconstruct.h"

namespace citymesh {

/// Space that several bodies took up and that is now one's alone.
struct SharedSpace {
  std::uint32_t from = 0, to = 0;  ///< indices of the bodies
  double volume_m3 = 0;
  GridPoint at{};  ///< a corner of it
};

struct SharedOut {
  std::vector<Shell> bodies{};        ///< in their order; without faces where others got everything
  std::vector<SharedSpace> spaces{};  ///< by `from`, then `to`
};

/// Makes bodies that overlap touch: all are cut where they meet, and what lies in several goes to
/// the smallest of them (by volume, of equal ones the first), so that a tower which stands through
/// a roof stays whole and the house has a niche for it. Faces in which two bodies touch afterwards
/// are the same triangles in both, or polygons of one exact plane. The bodies must be closed and
/// face outwards. None: a work limit was reached.
std::optional<SharedOut> share_space(std::span<const Shell> bodies,
                                     const ReconstructOptions& options, const RunContext& context);

/// Only which space that would be; empty: no two overlap by more than the tolerance.
std::optional<std::vector<SharedSpace>> shared_space(std::span<const Shell> bodies,
                                                     const ReconstructOptions& options,
                                                     const RunContext& context);

}  // namespace citymesh
