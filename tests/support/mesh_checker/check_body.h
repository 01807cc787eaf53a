#pragma once

#include <string>
#include <vector>

#include "tests/support/mesh_checker/read_mesh.h"

namespace mesh_checker {

struct Limits {
  double least_height_m = 0.001;  ///< of a triangle
  double least_area_m2 = 1e-6;
};

/// What keeps the body from being one or more closed, 2-manifold surfaces, oriented outward
/// (cavities inward), without intersections and degenerate triangles; empty when nothing does.
/// Self-intersection is judged with exact predicates, on every body whose surface is a 2-manifold;
/// on others it has no meaning and the body fails anyhow.
std::vector<std::string> check(const Body& body, const Limits& limits = {});

/// Volume enclosed by the body; cavities count negative.
double signed_volume_m3(const Body& body);

}  // namespace mesh_checker
