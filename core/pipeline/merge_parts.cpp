#include "core/pipeline/merge_parts.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/heal/heal.h"
#include "core/pipeline/parts.h"
#include "core/pipeline/round_trip_gate.h"
#include "core/reconstruct/cut_faces.h"
#include "core/reconstruct/rebuild_3d.h"

namespace citymesh {

void merge_parts(const Building& building, BuildingReport& report, std::vector<Body>& bodies,
                 std::vector<std::uint64_t>& fingerprints, const Inputs& inputs,
                 const std::vector<OpenFormat>& formats, const RunContext& context) {
  if (std::count_if(bodies.begin(), bodies.end(), is_part) < 2) return;
  std::vector<Shell> parts;
  for (const Body& body : bodies)
    if (is_part(body)) parts.push_back(shell_of(body.mesh));

  RoundTripGate gate(formats);
  auto shell = rebuild_3d(joined(parts), {}, context);
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
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (is_part(bodies[i])) continue;
    result.push_back(std::move(bodies[i]));
    marks.push_back(fingerprints[i]);
  }
  bodies = std::move(result);
  fingerprints = std::move(marks);
  sum_up(report, bodies);
  report.repairs.push_back({"parts_merged", report.gml_id, 0});
}

}  // namespace citymesh
