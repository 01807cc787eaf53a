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
#include "core/pipeline/signature.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

constexpr std::array<std::string_view, 7> kRungs{
    "as_is", "healed", "rebuilt_2_5d", "rebuilt_3d", "reconstructed", "wrapped", "lod1_block"};

std::size_t rung_rank(std::string_view rung) {
  return static_cast<std::size_t>(std::find(kRungs.begin(), kRungs.end(), rung) - kRungs.begin());
}

/// The issue that a failed gate is to a reader of the report.
Issue issue_of(const GateFailure& failure, std::string_view format) {
  struct Row {
    std::string_view gate;
    int code;
  };
  constexpr std::array kRows{Row{"G1", 302},
                             Row{"G2", 303},
                             Row{"G3", issue_code::kEulerFormula},
                             Row{"G4", 306},
                             Row{"G5", issue_code::kDegenerateTriangle},
                             Row{"G6", issue_code::kTJunction},
                             Row{"G7", 307},
                             Row{"G8", issue_code::kDuplicateFace},
                             Row{"G13", issue_code::kCoordinateOutOfRange}};
  const auto row = std::find_if(kRows.begin(), kRows.end(),
                                [&](const Row& r) { return r.gate == failure.gate; });
  const int code = row == kRows.end() ? issue_code::kEncodingLoss : row->code;
  return {code, fmt::format("{} {} ({})", failure.gate, failure.where, format),
          static_cast<double>(failure.count)};
}

/// All that a reader of `text` finds, as one set of triangles.
Result<WeldedBody> read_back(std::string_view format, std::string_view text) {
  ParsedBody all;
  auto parsed = parse_text(format, text, [&](ParsedBody&& body) -> Result<void> {
    all.float32 = body.float32;
    all.centre = body.centre;  // where a file has several, it has one of them per body
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), body.points.begin(), body.points.end());
    for (const Triangle& t : body.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return {};
  });
  if (!parsed) return parsed.error();
  return weld(all);
}

/// Judges shells as the files would hold them, and keeps the mesh of the shell it judged last.
class RoundTripGate {
 public:
  explicit RoundTripGate(const std::vector<OpenFormat>& formats) : formats_(formats) {}

  std::vector<Issue> operator()(const Shell& shell) {
    Meshed meshed = mesh(shell);
    if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
    mesh_ = std::get<TriangleMesh>(std::move(meshed));
    fingerprint_ = signature(mesh_.points, mesh_.triangles);

    std::vector<Issue> issues;
    const auto judge = [&](const WeldedBody& body, std::string_view where) {
      for (const GateFailure& failure : check_shell(body.points, body.triangles, {}))
        issues.push_back(issue_of(failure, where));
    };
    BuildingBodies building;
    building.bodies.push_back({});
    building.bodies[0].name = "body";
    building.bodies[0].mesh = std::move(mesh_);
    bool judged = false;
    for (const OpenFormat& open : formats_) {
      auto text = open.writer->encode(building);
      if (!text && text.error().code == ErrorCode::FailedPrecondition) refused_ = text.error();
      auto body = text ? read_back(open.format->key, *text) : Result<WeldedBody>(text.error());
      if (!body) {
        issues.push_back({issue_code::kEncodingLoss, body.error().message, 0});
        continue;
      }
      if (signature(body->points, body->triangles) != fingerprint_) {
        issues.push_back(
            {issue_code::kEncodingLoss,
             fmt::format("{} holds {} triangles that differ from the {} meant", open.format->key,
                         body->triangles.size(), building.bodies[0].mesh.triangles.size()),
             0});
        continue;
      }
      // The same triangles need the same verdict only once.
      if (!std::exchange(judged, true)) judge(*body, open.format->key);
    }
    mesh_ = std::move(building.bodies[0].mesh);
    return issues;
  }

  TriangleMesh take_mesh() { return std::move(mesh_); }
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// A format that cannot hold such coordinates at all, whatever the rung.
  const std::optional<Error>& refused() const { return refused_; }

 private:
  const std::vector<OpenFormat>& formats_;
  TriangleMesh mesh_;
  std::uint64_t fingerprint_ = 0;
  std::optional<Error> refused_;
};

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
  RoundTripGate gate(formats);
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
  processed.bodies = BuildingBodies{building.gml_id, report.rung, building.attributes,
                                    building.addresses, std::move(bodies)};
  return processed;
}

}  // namespace citymesh
