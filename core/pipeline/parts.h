#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/citymodel/shell.h"
#include "core/pipeline/process_building.h"

namespace citymesh {

/// The bodies of a building that stand for it and its parts: installations may stand in them.
inline bool is_part(const Body& body) { return body.kind != ObjectKind::BuildingInstallation; }

/// The faces of a mesh; surface_ids[0] is "".
Shell shell_of(const TriangleMesh& mesh);

/// Triangles and volume of a building are those of its bodies.
void sum_up(BuildingReport& report, const std::vector<Body>& bodies);

}  // namespace citymesh
