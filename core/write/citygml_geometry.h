#pragma once

#include <string>

#include "core/write/citygml_features.h"
#include "core/write/gml_ids.h"
#include "core/write/write.h"

namespace citymesh {

/// The geometry of an object as CityGML: boundary surfaces that own the polygons, and a solid whose
/// members refer to them in the order of the faces. Made once, its parts written where the schema
/// wants them.
class GmlGeometry {
 public:
  GmlGeometry(CityGml version, const CityObject& object, const Point3& origin, GmlIds& ids);

  /// lodNSolid; of an installation in 2.0: lodNGeometry.
  const std::string& solid() const { return solid_; }
  /// bldg:boundedBy or boundary elements; empty where the schema has none at this level of detail:
  /// then the solid owns the polygons.
  const std::string& boundaries() const { return boundaries_; }
  /// In 2.0 boundaries stand between what LoD2 and LoD3 have.
  int lod() const { return lod_; }

 private:
  std::string solid_{};
  std::string boundaries_{};
  int lod_ = 2;
};

}  // namespace citymesh
