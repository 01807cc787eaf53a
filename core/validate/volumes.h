#pragma once

#include <optional>
#include <span>

#include "core/validate/body.h"

namespace citymesh {

/// Exact volumes: answers what the predicates of body.h leave open, at the price of exact
/// constructions (Nef polyhedra, Hachenberger and Kettner 2007). None: too many triangles, or the
/// surface is no boundary of a volume after all.
inline constexpr std::size_t kMaxVolumeTriangles = 20'000;

/// Whether the interiors of two solids, cavities taken out, have a point in common.
std::optional<bool> volumes_overlap(const SolidBody& a, const SolidBody& b);

/// Whether the one lies within the other, where they may touch.
std::optional<bool> volume_within(const ClosedSurface& inner, const ClosedSurface& outer);

/// In how many pieces the cavities cut the inside of a solid.
std::optional<std::size_t> interior_pieces(const SolidBody& solid);

}  // namespace citymesh
