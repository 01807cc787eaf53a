#include "core/pipeline/validate_building.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/citymodel/choose.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

struct ValidatedPart {
  PartReport report{};
  std::vector<SolidBody> solids{};
  bool may_overlap = true;  ///< solids of a MultiSolid may share space
};

/// What the source states at the level that is taken; what the reader assembled only where no solid
/// is stated.
std::vector<const Geometry*> stated_geometries(const Building& building, const Inputs& inputs) {
  std::vector<const Geometry*> geometries = choose_geometries(building, inputs.lod);
  if (std::any_of(geometries.begin(), geometries.end(),
                  [](const Geometry* g) { return !g->solids.empty(); }))
    std::erase_if(geometries, [](const Geometry* g) { return g->assembled; });
  return geometries;
}

ValidatedPart validate_part(const Building& building, const std::string& name,
                            const Inputs& inputs) {
  ValidatedPart part;
  PartReport& report = part.report;
  report.gml_id = building.gml_id;
  report.name = name;
  report.kind = building.kind;
  report.outcome = "delivered";
  report.issues_before = building.source_issues;
  const std::vector<const Geometry*> geometries = stated_geometries(building, inputs);
  if (geometries.empty()) {
    report.outcome = "dropped";
    report.reason = "no_geometry";
    return part;
  }
  report.lod = to_string(geometries[0]->lod);
  for (const Geometry* geometry : geometries) {
    Validated validated = validate(building, *geometry,
                                   {.snap_tolerance_m = inputs.snap_tolerance_m,
                                    .planarity_tolerance_m = inputs.planarity_tolerance_m});
    report.triangles += validated.triangles;
    for (Issue& issue : validated.issues)
      if (std::none_of(report.issues_before.begin(), report.issues_before.end(),
                       [&](const Issue& known) {
                         return known.code == issue.code && known.where == issue.where;
                       }))
        report.issues_before.push_back(std::move(issue));
    if (geometry->type == GeometryType::MultiSolid) part.may_overlap = false;
    std::move(validated.solids.begin(), validated.solids.end(), std::back_inserter(part.solids));
  }
  return part;
}

}  // namespace

ValidatedBuilding validate_building(const NamedBuilding& named, const Inputs& inputs) {
  const Building& building = named.building;
  ValidatedBuilding result;
  BuildingReport& report = result.report;
  std::string lod;
  std::vector<std::size_t> comparable;  // solids of one level
  bool sound = true;
  const auto collect = [&](ValidatedPart& part) {
    sound = sound && part.report.issues_before.empty();
    if (lod.empty()) lod = part.report.lod;
    for (SolidBody& solid : part.solids) {
      if (part.may_overlap && part.report.lod == lod) comparable.push_back(result.solids.size());
      result.solids.push_back(std::move(solid));
    }
  };

  if (takes_own_geometry(building, inputs.lod)) {
    ValidatedPart own = validate_part(building, named.name, inputs);
    static_cast<PartReport&>(report) = own.report;
    if (report.reason == "no_geometry" && !building.parts.empty()) {
      report.outcome = "delivered";
      report.reason.clear();
    }
    collect(own);
  } else {
    report.gml_id = building.gml_id;
    report.name = named.name;
    report.outcome = "delivered";
    report.issues_before = building.source_issues;
  }
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    ValidatedPart part = validate_part(building.parts[i], named.part_names[i], inputs);
    collect(part);
    report.parts.push_back(std::move(part.report));
  }
  if (sound && comparable.size() > 1) {
    std::vector<const SolidBody*> solids;
    solids.reserve(comparable.size());
    for (const std::size_t i : comparable) solids.push_back(&result.solids[i]);
    std::vector<Issue> overlaps = validate_parts(solids);
    std::move(overlaps.begin(), overlaps.end(), std::back_inserter(report.issues_before));
  }
  if (named.duplicate) {
    report.outcome = "dropped";
    report.reason = "duplicate_id";
    result.solids.clear();
  }
  return result;
}

Validation::Validation(const Inputs& inputs)
    : inputs_(inputs),
      neighbours_({.gap_threshold_m = inputs.gap_threshold_m,
                   .wall_tolerance_m = inputs.planarity_tolerance_m}) {}

std::vector<BuildingReport> Validation::validate(std::span<const NamedBuilding> batch,
                                                 const RunContext& context) {
  std::vector<ValidatedBuilding> validated(batch.size());
  parallel_for(batch.size(), context.threads, [&](std::size_t i) {
    if (!context.stopped()) validated[i] = validate_building(batch[i], inputs_);
  });
  const std::size_t first = neighbours_.size();
  for (ValidatedBuilding& building : validated)
    neighbours_.add(building.report.gml_id, std::move(building.solids));
  parallel_for(batch.size(), context.threads, [&](std::size_t i) {
    if (context.stopped()) return;
    std::vector<Issue> found = neighbours_.issues_of(first + i);
    std::move(found.begin(), found.end(), std::back_inserter(validated[i].report.issues_before));
  });
  std::vector<BuildingReport> reports;
  reports.reserve(validated.size());
  for (ValidatedBuilding& building : validated) reports.push_back(std::move(building.report));
  return reports;
}

}  // namespace citymesh
