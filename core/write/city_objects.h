#pragma once

#include <string>
#include <vector>

#include "core/citymodel/mesh.h"

namespace citymesh {

/// A Building, BuildingPart or BuildingInstallation as city model formats have it: at most one
/// body.
struct CityObject {
  std::string gml_id{};
  ObjectKind kind = ObjectKind::Building;
  const Attributes* attributes = nullptr;
  const std::vector<Address>* addresses = nullptr;
  const Body* body = nullptr;
};

/// The building first, then what belongs to it. A further body of the building itself becomes a
/// part. Points into `building`.
std::vector<CityObject> city_objects(const BuildingBodies& building);

/// The level of detail that a solid is written with: a solid is never LoD0, and "2" where nothing
/// is known.
std::string solid_lod(const Body& body);

}  // namespace citymesh
