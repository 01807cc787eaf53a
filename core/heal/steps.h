#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"
#include "core/geometry/predicates.h"

namespace citymesh {

/// What a healing step may do and where it writes down what it did.
struct StepContext {
  double tolerance_m = 0.001;           ///< of snapping and T-junctions in this attempt
  double planarity_tolerance_m = 0.01;  ///< of holes
  double max_hole_area_m2 = 10000;      ///< larger loops stay open
  std::vector<Face> broken{};           ///< set aside until their places are closed
  std::vector<Repair> repairs{};
  double max_displacement_m = 0;

  void note(std::string kind, std::string where, double displacement_m = 0);
  void note(std::string kind, const GridPoint& at, double displacement_m = 0);
};

// Every step takes a shell that may be defective and leaves one that is no worse. Order matters:
// see heal.cpp.

/// Points within the tolerance of an earlier one (in x, y, z order) take its place.
void snap_points(Shell& shell, StepContext& context);

/// Drops repeated corners and spikes, splits rings that touch themselves, drops rings of fewer than
/// three corners and faces without an exterior (S3-10 b).
void clean_rings(Shell& shell, StepContext& context);

/// Sets faces aside that cannot be triangulated: their rings cross or overlap (104, 201). The edges
/// that they leave free tell better than they do where they should be.
void drop_broken_faces(Shell& shell, StepContext& context);

/// Faces that closed the place of a broken one get its type and source.
void restore_broken_faces(Shell& shell, StepContext& context);

/// Puts vertices that lie on the edge of a face into that edge (S2-04).
void insert_junctions(Shell& shell, StepContext& context);

/// Of faces over the same corners keeps one, or none where they are an inner wall (S2-04, S3-14).
void drop_duplicate_faces(Shell& shell, StepContext& context);

/// Drops plane pieces that bound nothing: walls across a house, sheets that hang free. Each hangs
/// together across edges of two faces and ends in edges of one face or of more than two (S3-14).
void drop_inner_sheets(Shell& shell, StepContext& context);

/// Turns faces so that neighbours agree and every component faces outwards (cavities inwards).
void orient_faces(Shell& shell, StepContext& context);

/// Closes loops of free edges: planar ones, or planar pieces of them along chords, with a face;
/// nested loops in one plane become holes of it. Other loops get triangles of the least area.
void close_holes(Shell& shell, StepContext& context);

/// Where two faces lie on each other in the same triangles: an inner wall between touching volumes
/// goes, of doubles one stays. Faces that lose triangles fall apart into the rest.
void drop_double_triangles(Shell& shell, StepContext& context);

/// Cuts faces that readers may find not plane, or crossing themselves where they look along another
/// direction than citymesh, into plane pieces or into triangles. They keep type and source.
/// `sound`: sound_faces() of the shell, those stay. Returns the first corner of each face that it
/// cut.
std::vector<GridPoint> split_uneven_faces(Shell& shell, const std::vector<bool>& sound,
                                          double planarity_tolerance_m, bool into_triangles);

/// Where the shell has several exteriors puts the faces of each together, those of its cavities
/// behind them: what solids are written of.
void group_solids(Shell& shell);

/// Gives faces without a type one by their normal: up a roof, down a ground, else a wall.
void type_faces(Shell& shell);

/// Hands the LoD1 blocks of the contract to `take`, the likeliest first, later ones of simpler
/// outlines, until it takes one. Returns "" when one was taken, else why not: no_geometry or
/// no_height when there is none, not_healed when none was taken.
std::string lod1_block(const Shell& shell, bool footprint_only,
                       std::optional<double> measured_height_m,
                       const std::function<bool(Shell&)>& take);

}  // namespace citymesh
