#pragma once

#include <variant>

#include "core/citymodel/issue.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/shell.h"

namespace citymesh {

/// A triangle mesh, or the defect that forbids one.
using Meshed = std::variant<TriangleMesh, Issue>;

/// Constrained Delaunay triangles of every face, corners kept, nothing moved; points that no face
/// uses are left out. A face whose rings cross or overlap in its plane is a defect (104, or 201
/// with several rings).
Meshed mesh(const Shell& shell);

}  // namespace citymesh
