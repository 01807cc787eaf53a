#include "core/pipeline/parts.h"

#include "core/geometry/measure.h"

namespace citymesh {

Shell shell_of(const TriangleMesh& mesh) {
  Shell shell{mesh.points, mesh.faces, {""}};
  shell.surface_ids.insert(shell.surface_ids.end(), mesh.surface_ids.begin(),
                           mesh.surface_ids.end());
  for (Face& face : shell.faces) ++face.source;
  return shell;
}

void sum_up(BuildingReport& report, const std::vector<Body>& bodies) {
  report.triangles = 0;
  report.volume_after_m3 = 0;
  for (const Body& body : bodies) {
    report.triangles += body.mesh.triangles.size();
    report.volume_after_m3 += volume_m3(body.mesh.points, body.mesh.triangles);
  }
}

}  // namespace citymesh
