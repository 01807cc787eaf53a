#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/shell.h"
#include "core/geometry/arrangement.h"

namespace citymesh {

/// The triangles of a shell cut where they meet. Work limits hold.
struct CutFaces {
  Arrangement arrangement{};
  std::vector<std::uint32_t> face_of{};  ///< per triangle of the input that facets cover
};

/// Points closer than `tolerance_m` become one, or 1.5 mm where that is more: the gates ask a
/// height of triangles. None: a limit was reached, of which `max_cuts` is the one of
/// ArrangeOptions.
std::optional<CutFaces> cut_faces(const Shell& input, double tolerance_m, std::uint64_t max_cuts,
                                  const RunContext& context);

/// The same, after gaps were closed with triangles of one face past the last.
std::optional<CutFaces> cut_and_closed_faces(const Shell& input, double tolerance_m,
                                             const RunContext& context);

inline bool is_inside(double winding) { return winding >= 0.5 || winding <= -0.5; }

/// The face that a facet continues, of those that cover it: one that faces as wanted before one
/// that does not, one of the source before one that healing added; one past the last face where
/// none covers it.
std::uint32_t parent_of(std::span<const Cover> covers, bool along,
                        const std::vector<std::uint32_t>& face_of, const Shell& input);

/// Faces of all shells in their order.
Shell joined(std::span<const Shell> shells);

}  // namespace citymesh
