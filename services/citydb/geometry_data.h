#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "services/citydb/feature_builder.h"

namespace citymesh::citydb {

/// The rows of geometry_data (version 5): all polygons of a geometry in one value of PostGIS, and
/// beside it, as JSON, what they make up and their ids. For one thread; used again and again.
class GeometryData {
 public:
  GeometryData();
  ~GeometryData();

  struct Row {
    std::int64_t id = 0;
    std::string_view geometry{};    ///< EWKB
    std::string_view properties{};  ///< JSON; empty: none, then polygons have no ids
    bool solid = false;             ///< what it is where `properties` are missing
  };
  /// Adds what a row holds; kNone for points, lines and nothing. Errors: DataLoss with the id of
  /// the row, when its JSON does not describe its geometry.
  Result<FeatureBuilder::Tree::NodeId> add(const Row& row, FeatureBuilder::Owner owner,
                                           FeatureBuilder& builder);

  /// The values of a JSON list of numbers and texts, with blanks between them. Errors: DataLoss.
  Result<std::string> words(std::string_view json);

 private:
  struct Parser;
  struct Item;

  std::unique_ptr<Parser> parser_;
  std::vector<Item> items_;  ///< the geometry itself, then its children
  StoredPolygons polygons_{};
  std::vector<std::uint32_t> members_{};

  Result<void> parse(std::string_view properties);
  FeatureBuilder::Tree::NodeId add_nameless(FeatureBuilder::Owner owner, FeatureBuilder& builder);
};

}  // namespace citymesh::citydb
