#include "core/citymodel/choose.h"

#include <algorithm>

namespace citymesh {

bool matches(Lod have, Lod wanted) {
  return have.major == wanted.major && (wanted.minor < 0 || have.minor == wanted.minor);
}

bool has_level(const Building& building, Lod wanted) {
  return std::any_of(
      building.geometries.begin(), building.geometries.end(),
      [&](const Geometry& g) { return !g.polygons.empty() && matches(g.lod, wanted); });
}

std::vector<const Geometry*> choose_geometries(const Building& building, std::span<const Lod> lod) {
  const auto rank = [](const Geometry* g) {
    return g->footprint ? 3 : !g->solids.empty() ? 0 : g->assembled ? 1 : 2;
  };
  for (const Lod& wanted : lod) {
    std::vector<const Geometry*> found;
    for (const Geometry& geometry : building.geometries)
      if (matches(geometry.lod, wanted) && !geometry.polygons.empty()) found.push_back(&geometry);
    if (found.empty()) continue;
    std::stable_sort(found.begin(), found.end(), [&](const Geometry* a, const Geometry* b) {
      if (a->lod.minor != b->lod.minor) return a->lod.minor > b->lod.minor;
      return rank(a) < rank(b);
    });
    const Lod taken = found[0]->lod;
    std::erase_if(found, [&](const Geometry* g) { return g->lod != taken; });
    return found;
  }
  return {};
}

bool takes_own_geometry(const Building& building, std::span<const Lod> lod) {
  if (building.parts.empty()) return true;
  for (const Lod& wanted : lod) {
    if (has_level(building, wanted)) return true;
    if (std::any_of(building.parts.begin(), building.parts.end(),
                    [&](const Building& part) { return has_level(part, wanted); }))
      return false;
  }
  return false;
}

}  // namespace citymesh
