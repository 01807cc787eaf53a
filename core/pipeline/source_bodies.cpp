#include "core/pipeline/source_bodies.h"

#include <utility>

#include "core/citymodel/choose.h"
#include "core/citymodel/grid.h"

namespace citymesh {

std::vector<SourceBody> source_bodies(const NamedBuilding& named, const Inputs& inputs,
                                      const BuildingReport& report) {
  std::vector<SourceBody> bodies;
  const auto add = [&](const Building& building, const std::string& name, const PartReport* part) {
    const std::vector<const Geometry*> geometries = choose_geometries(building, inputs.lod);
    if (geometries.empty()) return;
    auto gridded = grid(building, *geometries[0]);
    if (auto* made = std::get_if<Gridded>(&gridded))
      bodies.push_back({building.gml_id, name, std::move(made->shell),
                        part ? part->issues_before : std::vector<Issue>{}});
  };
  const Building& building = named.building;
  if (takes_own_geometry(building, inputs.lod)) add(building, named.name, &report);
  const std::vector<const Building*> members = members_of(building, inputs);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const PartReport* part = nullptr;
    for (const PartReport& candidate : report.parts)
      if (candidate.name == named.part_names[i]) part = &candidate;
    add(*members[i], named.part_names[i], part);
  }
  return bodies;
}

}  // namespace citymesh
