#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "services/citydb/feature_builder.h"
#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// The rows of surface_geometry (version 4) as the trees that they are, flags read as the
/// exporter of 3DCityDB reads them.
class SurfaceTrees {
 public:
  /// Columns: root_id, id, parent_id, gmlid, is_solid, is_composite, is_triangulated, geometry; by
  /// root_id and id. Errors: DataLoss.
  static Result<SurfaceTrees> of(const postgres::Rows& rows);

  /// Adds the geometry below a root. False when there is no such root or nothing in it.
  bool add(std::int64_t root, FeatureBuilder::Owner owner, Lod lod, bool footprint,
           const source::Placement* placement, FeatureBuilder& builder) const;

 private:
  struct Row {
    std::int64_t id = 0, parent = 0;
    std::string_view gml_id{};
    bool solid = false, composite = false, triangulated = false;
    std::int32_t polygon = -1;  ///< index into polygons_; -1: no leaf
    std::int32_t first_child = -1, next = -1, last_child = -1;
  };
  FeatureBuilder::Tree::NodeId add(const Row& row, FeatureBuilder::Owner owner,
                                   FeatureBuilder::Tree::NodeId parent,
                                   FeatureBuilder::Tree::Role role, unsigned depth,
                                   FeatureBuilder& builder) const;

  std::vector<Row> rows_{};
  std::unordered_map<std::int64_t, std::int32_t> by_id_{};
  StoredPolygons polygons_{};
};

}  // namespace citymesh::citydb
