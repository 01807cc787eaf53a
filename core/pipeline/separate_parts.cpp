#include "core/pipeline/separate_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/geometry/measure.h"
#include "core/pipeline/parts.h"
#include "core/pipeline/separate_bodies.h"

namespace citymesh {
namespace {

/// The report of the building itself or of one of its parts.
PartReport& report_of(BuildingReport& report, const Body& body) {
  const auto found = std::find_if(report.parts.begin(), report.parts.end(),
                                  [&](const PartReport& part) { return part.name == body.name; });
  return found == report.parts.end() ? report : *found;
}

/// The part, if it is not the building's own geometry, ends as merged.
void vanish(PartReport& part, const std::vector<std::string>& names,
            const std::vector<SharedSpace>& spaces) {
  const auto most = std::max_element(
      spaces.begin(), spaces.end(),
      [](const SharedSpace& s, const SharedSpace& t) { return s.volume_m3 < t.volume_m3; });
  part.outcome = "merged";
  part.merged_into = most == spaces.end() ? "" : names[most->to];
  part.rung.clear();
  part.issues_after.clear();
  part.volume_after_m3 = 0;
  part.triangles = 0;
}

void change(Body& body, PartReport& part, Separated separated) {
  if (body.rung == "as_is") body.rung = "healed";
  part.rung = body.rung;
  body.mesh = std::move(separated.mesh);
  for (Face& face : body.mesh.faces)
    if (face.added && face.made_by.empty()) face.made_by = body.rung;
  part.issues_after = std::move(separated.issues);
  part.volume_after_m3 = volume_m3(body.mesh.points, body.mesh.triangles);
  part.triangles = body.mesh.triangles.size();
}

}  // namespace

void separate_parts(BuildingReport& report, std::vector<Body>& bodies,
                    std::vector<std::uint64_t>& fingerprints, const Inputs& inputs,
                    const std::vector<OpenFormat>& formats, const RunContext& context) {
  if (std::count_if(bodies.begin(), bodies.end(), is_part) < 2) return;
  std::vector<std::string> names;
  names.reserve(bodies.size());
  for (const Body& body : bodies) names.push_back(body.gml_id.empty() ? body.name : body.gml_id);
  SeparatedBodies separated = separate_bodies(bodies, inputs, formats, context);
  for (const Overlap& overlap : separated.overlaps)
    report.issues_after.push_back(
        {issue_code::kPartsOverlap, names[overlap.a] + " with " + names[overlap.b], 0, overlap.at});

  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    for (const SharedSpace& space : separated.spaces[i]) {
      const Point3 at = to_metres(space.at);
      const auto note = [&](std::uint32_t body, std::string_view how, std::uint32_t other) {
        report_of(report, bodies[body])
            .repairs.push_back({"parts_separated",
                                fmt::format("{:.3f} m³ {} {}", space.volume_m3, how, names[other]),
                                0, at});
      };
      note(i, "given to", space.to);
      note(space.to, "taken from", i);
    }

  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!separated.bodies[i]) continue;
    PartReport& part = report_of(report, bodies[i]);
    for (const Push& push : separated.bodies[i]->pushes) {
      part.max_displacement_m = std::max(part.max_displacement_m, push.displacement_m);
      report.max_displacement_m = std::max(report.max_displacement_m, push.displacement_m);
      part.repairs.push_back(
          {"pushed_apart", "out of " + names[push.from], push.displacement_m, to_metres(push.at)});
    }
  }

  std::vector<Body> left;
  std::vector<std::uint64_t> marks;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    PartReport& part = report_of(report, body);
    if (std::optional<Separated>& changed = separated.bodies[i]) {
      if (changed->mesh.triangles.empty()) {
        const bool own = &part == &report;
        if (!own) vanish(part, names, separated.spaces[i]);
        continue;
      }
      fingerprints[i] = changed->fingerprint;
      change(body, part, std::move(*changed));
      if (report.rung == "as_is") report.rung = body.rung;
    }
    left.push_back(std::move(body));
    marks.push_back(fingerprints[i]);
  }
  bodies = std::move(left);
  fingerprints = std::move(marks);
  sum_up(report, bodies);
}

}  // namespace citymesh
