#pragma once

#include <span>
#include <vector>

#include "core/citymodel/building.h"

namespace citymesh {

/// Whether a level that a source has is the one that is wanted: "2" is any 2.x.
bool matches(Lod have, Lod wanted);

bool has_level(const Building& building, Lod wanted);

/// Geometries of the building itself at the first level of the list that it has, the finest minor
/// level; solids before surfaces assembled from boundary surfaces before stated multi surfaces
/// before footprints. Empty: none of the levels.
std::vector<const Geometry*> choose_geometries(const Building& building, std::span<const Lod> lod);

/// Whether the building's own geometry is taken beside its parts': only at the level at which the
/// first part is found; coarser, it describes the parts once more (3D BAG: a footprint on the
/// Building, solids on the parts).
bool takes_own_geometry(const Building& building, std::span<const Lod> lod);

}  // namespace citymesh
