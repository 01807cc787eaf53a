#include "core/pipeline/merge_parts.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/geometry/measure.h"
#include "core/heal/heal.h"
#include "core/pipeline/round_trip_gate.h"
#include "core/reconstruct/rebuild_3d.h"

namespace citymesh {
namespace {

void append(Shell& shell, const TriangleMesh& mesh) {
  const auto first_point = static_cast<std::uint32_t>(shell.points.size());
  shell.points.insert(shell.points.end(), mesh.points.begin(), mesh.points.end());
  const auto first_id = static_cast<std::uint32_t>(shell.surface_ids.size());
  shell.surface_ids.insert(shell.surface_ids.end(), mesh.surface_ids.begin(),
                           mesh.surface_ids.end());
  for (Face face : mesh.faces) {
    face.source += first_id;
    for (Ring& ring : face.rings)
      for (std::uint32_t& corner : ring) corner += first_point;
    shell.faces.push_back(std::move(face));
  }
}

}  // namespace

void merge_parts(const Building& building, BuildingReport& report, std::vector<Body>& bodies,
                 std::vector<std::uint64_t>& fingerprints, const Inputs& inputs,
                 const std::vector<OpenFormat>& formats, const RunContext& context) {
  const auto is_part = [](const Body& body) {
    return body.kind != ObjectKind::BuildingInstallation;
  };
  if (std::count_if(bodies.begin(), bodies.end(), is_part) < 2) return;
  Shell all;
  all.surface_ids.emplace_back();
  for (const Body& body : bodies)
    if (is_part(body)) append(all, body.mesh);

  RoundTripGate gate(formats);
  auto shell = rebuild_3d(all, {}, context);
  std::vector<GridPoint> cuts;
  if (!shell || !make_fit(*shell, inputs.planarity_tolerance_m, std::ref(gate), cuts).empty()) {
    report.issues_after.push_back({issue_code::kPartsNotMerged, report.gml_id, 0});
    return;
  }
  Body merged;
  merged.name = report.name;
  merged.gml_id = report.gml_id;
  merged.rung = report.rung;
  merged.lod = report.lod;
  merged.attributes = building.attributes;
  merged.addresses = building.addresses;
  merged.mesh = gate.take_mesh();
  std::vector<Body> result{std::move(merged)};
  std::vector<std::uint64_t> marks{gate.fingerprint()};
  report.triangles = result[0].mesh.triangles.size();
  report.volume_after_m3 = volume_m3(result[0].mesh.points, result[0].mesh.triangles);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (is_part(bodies[i])) continue;
    report.triangles += bodies[i].mesh.triangles.size();
    report.volume_after_m3 += volume_m3(bodies[i].mesh.points, bodies[i].mesh.triangles);
    result.push_back(std::move(bodies[i]));
    marks.push_back(fingerprints[i]);
  }
  bodies = std::move(result);
  fingerprints = std::move(marks);
  report.repairs.push_back({"parts_merged", report.gml_id, 0});
}

}  // namespace citymesh
