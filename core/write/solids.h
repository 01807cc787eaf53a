#pragma once

#include <cstddef>
#include <vector>

#include "core/citymodel/mesh.h"

namespace citymesh {

/// Faces [begin, end) of a mesh.
struct FaceRange {
  std::size_t begin = 0, end = 0;
};

struct SolidFaces {
  FaceRange exterior{};
  std::vector<FaceRange> interiors{};  ///< a shell per cavity
};

/// The solids of a mesh without changing the order of its faces: faces of cavities belong to the
/// exterior before them. Exteriors, and cavities, that share no point are several, but those whose
/// faces are mixed stay one shell.
std::vector<SolidFaces> solids_of(const TriangleMesh& mesh);

}  // namespace citymesh
