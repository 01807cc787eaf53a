#include "core/pipeline/totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/measure.h"

namespace citymesh {
namespace {

void count(Counts& counts, const std::string& outcome) {
  ++counts.requested;
  ++(outcome == "delivered" ? counts.delivered
     : outcome == "merged"  ? counts.merged
                            : counts.dropped);
}

}  // namespace

void Totals::add(const BuildingReport& building, const BuildingBodies* bodies) {
  count(report_.counts, building.outcome);
  for (const Issue& issue : building.issues_before) ++issues_[issue_code_text(issue.code)];
  for (const PartReport& part : building.parts) {
    for (const Issue& issue : part.issues_before) ++issues_[issue_code_text(issue.code)];
    if (part.kind == ObjectKind::BuildingPart) count(report_.part_counts, part.outcome);
  }
  if (building.outcome == "delivered") {
    if (!building.rung.empty()) ++rungs_[building.rung];
  } else {
    ++reasons_[building.reason];
  }
  if (!bodies) return;
  for (const Body& body : bodies->bodies) add(body.mesh);
}

void Totals::add_skipped(const Building& building) {
  if (!keep_installations_) installations_ += building.installations.size();
  for (const auto& [name, count] : building.skipped_ade_elements) ade_elements_[name] += count;
  for (const Building& part : building.parts) add_skipped(part);
  for (const Building& installation : building.installations) add_skipped(installation);
}

void Totals::add(const TriangleMesh& mesh) {
  contacts_.add(mesh);
  ++report_.bodies;
  report_.points += mesh.points.size();
  report_.triangles += mesh.triangles.size();
  report_.volume_m3 += volume_m3(mesh.points, mesh.triangles);
  report_.area_m2 += area_m2(mesh.points, mesh.triangles);
  for (const GridPoint& p : mesh.points) report_.extent.add(to_metres(p));
  for (const Triangle& t : mesh.triangles) {
    const double a = distance_m(mesh.points[t[1]], mesh.points[t[2]]);
    const double b = distance_m(mesh.points[t[2]], mesh.points[t[0]]);
    const double c = distance_m(mesh.points[t[0]], mesh.points[t[1]]);
    const double shortest = std::min({a, b, c}), longest = std::max({a, b, c});
    const double middle = a + b + c - shortest - longest;
    min_edge_m_ = std::min(min_edge_m_, shortest);
    // The smallest angle lies opposite the shortest edge (law of cosines).
    const double cosine =
        (middle * middle + longest * longest - shortest * shortest) / (2 * middle * longest);
    max_cosine_ = std::max(max_cosine_, std::min(cosine, 1.0));
  }
}

RunReport Totals::finish() {
  report_.contacts = contacts_.count();
  if (installations_ > 0)
    report_.warnings.push_back(
        fmt::format("{} building installations were left out", installations_));
  if (!ade_elements_.empty()) {
    std::uint64_t elements = 0;
    std::string names;
    for (const auto& [name, count] : ade_elements_) {
      elements += count;
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", name, count);
    }
    report_.warnings.push_back(
        fmt::format("{} elements of extensions (ADE) were skipped: {}", elements, names));
  }
  report_.rungs.assign(rungs_.begin(), rungs_.end());
  report_.drop_reasons.assign(reasons_.begin(), reasons_.end());
  report_.issues.assign(issues_.begin(), issues_.end());
  if (report_.triangles > 0) {
    report_.min_edge_m = min_edge_m_;
    report_.min_angle_deg = std::acos(max_cosine_) * 180.0 / 3.14159265358979323846;
  }
  return std::move(report_);
}

}  // namespace citymesh
