#pragma once

#include <span>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"
#include "core/validate/body.h"

namespace citymesh {

/// val3dity's defaults; its overlap tolerance is off.
struct ValidateOptions {
  double snap_tolerance_m = 0.001;      ///< points of a shell that are closer are one
  double planarity_tolerance_m = 0.01;  ///< of 203
  double planarity_angle_deg = 20;      ///< of 204
};

struct Validated {
  std::vector<Issue> issues{};
  std::vector<SolidBody> solids{};  ///< those in which nothing was found
  std::uint64_t triangles = 0;      ///< of polygons in which nothing was found
};

// Every check of ISO 19107 with val3dity's numbers, in its order: what is built of defective things
// is not looked at. A polygon is checked when its rings are sound, a shell when all its polygons
// are, a solid when all its shells are. Each issue names polygon and ring or edge and a place; of a
// code that occurs very often the first ones are placed and the rest are counted. Coordinates are
// those of the exact grid. Nothing is changed.

/// Rings as they came (103, 102). MultiSurfaces and footprints: 1xx and 2xx; CompositeSurfaces also
/// 3xx, but for their being closed; solids everything. Surfaces that a reader assembled are checked
/// as a solid, and issues of its shell say so.
Validated validate(const Building& building, const Geometry& geometry,
                   const ValidateOptions& options);

/// A gridded boundary as one solid, faces of cavities as its inner shells.
std::vector<Issue> validate(const Shell& shell, const ValidateOptions& options);

/// Per face of a shell whose points are distinct: whether nothing is wrong with it by itself (1xx,
/// 2xx).
std::vector<bool> sound_faces(const Shell& shell, const ValidateOptions& options);

/// 601: pairs of solids of one building whose insides overlap.
std::vector<Issue> validate_parts(std::span<const SolidBody* const> solids);

}  // namespace citymesh
