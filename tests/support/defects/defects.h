#pragma once

#include <array>
#include <string_view>

#include "tests/support/defects/house.h"
#include "tests/support/defects/random.h"

namespace citymesh::testing {

/// What goes wrong in real city models.
enum class Defect {
  NonPlanarRoof,
  InteriorWall,
  MissingWall,
  MissingGround,
  FlippedFace,
  DuplicateFace,
  BowTie,
  TJunction,
  UnsnappedVertex,
  RepeatedPoint,
};
/// In the order in which several are injected: a face is torn before points are moved.
inline constexpr std::array kDefects{
    Defect::NonPlanarRoof,   Defect::InteriorWall,  Defect::MissingWall, Defect::MissingGround,
    Defect::FlippedFace,     Defect::DuplicateFace, Defect::BowTie,      Defect::TJunction,
    Defect::UnsnappedVertex, Defect::RepeatedPoint};

std::string_view to_string(Defect defect);

/// Puts one defect of the kind into the house, at a random place. Returns by how much the volume is
/// not defined any more (m³): what the corner of a roof that left its plane sweeps. A house that
/// has no place for the defect stays as it is.
double inject(House& house, Defect defect, Random& random);

}  // namespace citymesh::testing
