#include "core/pipeline/process_building.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/citymodel/choose.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/heal/heal.h"
#include "core/mesh/mesh.h"
#include "core/pipeline/merge_parts.h"
#include "core/pipeline/round_trip_gate.h"
#include "core/pipeline/separate_parts.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

constexpr std::array<std::string_view, 7> kRungs{
    "as_is", "healed", "rebuilt_2_5d", "rebuilt_3d", "reconstructed", "wrapped", "lod1_block"};

std::size_t rung_rank(std::string_view rung) {
  return static_cast<std::size_t>(std::find(kRungs.begin(), kRungs.end(), rung) - kRungs.begin());
}

struct ProcessedPart {
  PartReport report{};
  std::optional<Body> body{};
  std::uint64_t fingerprint = 0;
  std::optional<Error> refused{};
};

/// Faces that no source has say which rung made them. A block has none of its source.
void mark_new_faces(Body& body) {
  const bool all = body.rung == "lod1_block";
  for (Face& face : body.mesh.faces)
    if (all || face.added) face.made_by = body.rung;
}

ProcessedPart process_part(const Building& building, const std::string& name, const Inputs& inputs,
                           const std::vector<OpenFormat>& formats, const RunContext& context) {
  RoundTripGate gate(formats, name);
  // A block stands on the ground: no stand-in for a balcony or a chimney.
  const bool installation = building.kind == ObjectKind::BuildingInstallation;
  const HealOptions options{inputs.snap_tolerance_m, inputs.planarity_tolerance_m,
                            inputs.max_displacement_m, inputs.max_hole_area_m2,
                            inputs.block_on_failure && !installation};
  Healed healed = heal(building, inputs.lod, options, std::ref(gate), context);

  ProcessedPart processed;
  processed.refused = gate.refused();
  PartReport& report = processed.report;
  report.gml_id = building.gml_id;
  report.name = name;
  report.kind = building.kind;
  report.outcome = healed.rung.empty() ? "dropped" : "delivered";
  report.reason = std::move(healed.reason);
  report.lod = healed.rung.empty() && healed.issues.empty() ? "" : to_string(healed.lod);
  report.lane = std::move(healed.lane);
  report.rung = healed.rung;
  report.issues_before = building.source_issues;
  report.issues_before.insert(report.issues_before.end(), healed.issues.begin(),
                              healed.issues.end());
  if (healed.rung.empty()) {
    report.issues_after = report.issues_before;
    return processed;
  }
  report.reason.clear();
  if (report.rung != "as_is" || !healed.issues.empty())
    report.issues_after =
        validate(healed.shell, {inputs.snap_tolerance_m, inputs.planarity_tolerance_m});
  report.repairs = std::move(healed.repairs);
  report.max_displacement_m = healed.max_displacement_m;
  report.deviation_max_m = healed.deviation.max_m;
  report.deviation_mean_m = healed.deviation.mean_m;
  report.volume_before_m3 = healed.volume_before_m3;

  Body body;
  body.name = name;
  body.gml_id = building.gml_id;
  body.kind = building.kind;
  body.rung = report.rung;
  body.lod = report.lod;
  body.attributes = building.attributes;
  body.addresses = building.addresses;
  body.mesh = gate.take_mesh();
  mark_new_faces(body);
  processed.fingerprint = gate.fingerprint();
  report.volume_after_m3 = volume_m3(body.mesh.points, body.mesh.triangles);
  report.triangles = body.mesh.triangles.size();
  processed.body = std::move(body);
  return processed;
}

/// A building is as its parts are: the worst rung, the sums and the maxima.
void add_up(BuildingReport& report, const PartReport& part) {
  if (report.rung.empty() || rung_rank(part.rung) > rung_rank(report.rung)) report.rung = part.rung;
  if (report.lane.empty() || part.lane == "3d") report.lane = part.lane;
  if (report.lod.empty()) report.lod = part.lod;
  report.max_displacement_m = std::max(report.max_displacement_m, part.max_displacement_m);
  report.deviation_max_m = std::max(report.deviation_max_m, part.deviation_max_m);
  report.deviation_mean_m = std::max(report.deviation_mean_m, part.deviation_mean_m);
  if (!report.volume_before_m3 || !part.volume_before_m3)
    report.volume_before_m3.reset();
  else
    *report.volume_before_m3 += *part.volume_before_m3;
  report.volume_after_m3 += part.volume_after_m3;
  report.triangles += part.triangles;
}

}  // namespace

std::vector<const Building*> members_of(const Building& building, const Inputs& inputs) {
  std::vector<const Building*> members;
  const auto add = [&](const std::vector<Building>& all) {
    for (const Building& member : all) members.push_back(&member);
  };
  add(building.parts);
  if (!inputs.keep_installations) return members;
  add(building.installations);
  for (const Building& part : building.parts) add(part.installations);
  return members;
}

ProcessedBuilding process_building(const NamedBuilding& named, const Inputs& inputs,
                                   const std::vector<OpenFormat>& formats,
                                   const RunContext& context) {
  const Building& building = named.building;
  const std::vector<const Building*> members = members_of(building, inputs);
  ProcessedBuilding processed;
  BuildingReport& report = processed.report;
  report.gml_id = building.gml_id;
  report.name = named.name;

  std::vector<Body> bodies;
  const auto drop = [&](const std::string& reason) {
    report.outcome = "dropped";
    report.reason = reason;
    report.rung.clear();
    if (!members.empty()) report.volume_before_m3.reset();
    report.volume_after_m3 = 0;
    report.triangles = 0;
    for (PartReport& part : report.parts) {
      if (part.outcome == "dropped") continue;
      part.outcome = "dropped";
      part.reason = "building_dropped";
      part.rung.clear();
    }
  };
  if (named.duplicate) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      report.parts.push_back({});
      report.parts.back().gml_id = members[i]->gml_id;
      report.parts.back().name = named.part_names[i];
      report.parts.back().kind = members[i]->kind;
    }
    drop("duplicate_id");
    return processed;
  }

  std::string first_reason;
  bool any_geometry = false;
  if (takes_own_geometry(building, inputs.lod)) {
    ProcessedPart own = process_part(building, named.name, inputs, formats, context);
    const bool silent = own.report.reason == "no_geometry" && !building.parts.empty();
    static_cast<PartReport&>(report) = own.report;
    processed.refused = own.refused;
    if (own.body) {
      bodies.push_back(std::move(*own.body));
      processed.fingerprints.push_back(own.fingerprint);
      any_geometry = true;
    } else if (!silent) {
      first_reason = own.report.reason;
    }
  } else {
    report.issues_before = building.source_issues;
  }
  report.outcome = "delivered";
  if (bodies.empty() && !members.empty()) report.volume_before_m3 = 0;  // that of its parts
  for (std::size_t i = 0; i < members.size(); ++i) {
    ProcessedPart part = process_part(*members[i], named.part_names[i], inputs, formats, context);
    if (part.refused) processed.refused = part.refused;
    const bool installation = members[i]->kind == ObjectKind::BuildingInstallation;
    if (part.body) {
      add_up(report, part.report);
      bodies.push_back(std::move(*part.body));
      processed.fingerprints.push_back(part.fingerprint);
      any_geometry = any_geometry || !installation;
    } else if (first_reason.empty() && !installation) {
      first_reason = part.report.reason;
    }
    report.parts.push_back(std::move(part.report));
  }
  if (!first_reason.empty() || !any_geometry) {
    drop(first_reason.empty() ? "no_geometry" : first_reason);
    return processed;
  }
  report.reason.clear();
  if (inputs.merge_parts)
    merge_parts(building, report, bodies, processed.fingerprints, inputs, formats, context);
  else
    separate_parts(report, bodies, processed.fingerprints, inputs, formats, context);
  processed.bodies = BuildingBodies{building.gml_id, report.rung, building.attributes,
                                    building.addresses, std::move(bodies)};
  return processed;
}

}  // namespace citymesh
