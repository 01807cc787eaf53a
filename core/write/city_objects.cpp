#include "core/write/city_objects.h"

namespace citymesh {

std::vector<CityObject> city_objects(const BuildingBodies& building) {
  std::vector<CityObject> objects{{.gml_id = building.gml_id,
                                   .attributes = &building.attributes,
                                   .addresses = &building.addresses}};
  for (const Body& body : building.bodies) {
    if (body.kind == ObjectKind::Building && !objects[0].body) {
      objects[0].body = &body;
      continue;
    }
    const ObjectKind kind =
        body.kind == ObjectKind::Building ? ObjectKind::BuildingPart : body.kind;
    objects.push_back({body.gml_id, kind, &body.attributes, &body.addresses, &body});
  }
  return objects;
}

std::string solid_lod(const Body& body) {
  if (body.lod.empty()) return "2";
  return body.lod[0] == '0' ? "1" : body.lod;
}

}  // namespace citymesh
