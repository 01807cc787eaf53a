#pragma once

#include <map>
#include <string>

#include "core/source/source.h"
#include "tests/integration/citydb/canonical.h"

namespace citymesh {

/// The buildings by gml:id, each as canonical text.
using Model = std::map<std::string, std::string>;

inline Result<Model> read_model(CitySource& source, const BuildingQuery& query) {
  const auto selection = source.select(query, {});
  if (!selection) return selection.error();
  Model model;
  auto done = source.read(query, *selection,
                          [&](Building&& building) -> Result<void> {
                            model[building.gml_id] += canonical(building);
                            return {};
                          },
                          {});
  if (!done) return done.error();
  return model;
}

}  // namespace citymesh
