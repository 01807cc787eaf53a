#include "core/reconstruct/roles.h"

#include <algorithm>
#include <cmath>

#include "core/citymodel/spikes.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/predicates.h"
#include "core/reconstruct/untangle.h"

namespace citymesh {
namespace {

constexpr double kSteepest = 0.05;  ///< normal z of what may count as vertical
constexpr double kMaxLean = 500;    ///< how far it may lean, in steps
constexpr double kFlat = 0.5;       ///< normal z of what is no wall, however narrow

}  // namespace

FaceRole role_of(const Shell& shell, const Face& face, std::int64_t tolerance_steps) {
  switch (face.type) {
    case SurfaceType::InteriorWallSurface:
    case SurfaceType::CeilingSurface:
    case SurfaceType::FloorSurface:
      return FaceRole::Ignored;
    default:
      break;
  }
  if (face.rings.empty() || face.rings[0].size() < 3) return FaceRole::Ignored;
  GridBox box = GridBox::of(shell.points[face.rings[0][0]]);
  for (const std::uint32_t v : face.rings[0]) box.add(shell.points[v]);
  const double extent = std::hypot(static_cast<double>(box.max.x - box.min.x),
                                   static_cast<double>(box.max.y - box.min.y));
  if (extent == 0) return FaceRole::Vertical;
  // The normal of a ring that crosses itself says little: then all of its sheet counts.
  Point3 sum{}, sheet{};
  for (std::size_t i = 1; i + 1 < face.rings[0].size(); ++i) {
    const Point3 n = normal_of(shell.points[face.rings[0][0]], shell.points[face.rings[0][i]],
                               shell.points[face.rings[0][i + 1]]);
    sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
    sheet = {sheet.x + std::abs(n.x), sheet.y + std::abs(n.y), sheet.z + std::abs(n.z)};
  }
  const auto length = [](const Point3& n) { return std::hypot(n.x, n.y, n.z); };
  const Point3 normal = length(sum) > 0.1 * length(sheet) ? sum : sheet;
  if (length(normal) == 0) return FaceRole::Ignored;
  const double upright = std::abs(normal.z) / length(normal),
               width = std::abs(normal.z) / 2 / extent;
  if (upright < kSteepest ? width <= kMaxLean
                          : upright < kFlat && width <= static_cast<double>(tolerance_steps))
    return FaceRole::Vertical;
  switch (face.type) {
    case SurfaceType::RoofSurface:
    case SurfaceType::OuterFloorSurface:
      return FaceRole::Up;
    case SurfaceType::GroundSurface:
    case SurfaceType::OuterCeilingSurface:
      return FaceRole::Down;
    default:
      return FaceRole::Either;
  }
}

PartitionLine seen_from_above(const Shell& shell, const Face& face) {
  const Ring& ring = face.rings[0];
  const auto [first, last] =
      std::minmax_element(ring.begin(), ring.end(), [&](std::uint32_t i, std::uint32_t j) {
        return project(shell.points[i], Axis::Z) < project(shell.points[j], Axis::Z);
      });
  return {project(shell.points[*first], Axis::Z), project(shell.points[*last], Axis::Z)};
}

Shell with_clean_rings(const Shell& shell) {
  Shell clean = shell;
  for (Face& face : clean.faces) {
    for (Ring& ring : face.rings) drop_repeats_and_spikes(ring);
    if (!face.rings.empty() && face.rings[0].empty()) face.rings.clear();
    std::erase_if(face.rings, [](const Ring& ring) { return ring.empty(); });
  }
  untangle(clean);
  return clean;
}

}  // namespace citymesh
