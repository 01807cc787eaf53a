#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/source/citygml_shapes.h"
#include "core/source/feature.h"
#include "services/citydb/ewkb.h"

namespace citymesh::citydb {

/// Puts a building together of what the tables hold, so that it is what a reader of files would
/// have made of the same building. Importers copy a polygon into every geometry that refers to it:
/// copies with the same gml:id become one polygon again. Used for one building after another.
class FeatureBuilder {
 public:
  using Tree = source::GeometryTree;

  /// `srs`: of all coordinates, index into `facts.srs_names`.
  FeatureBuilder(source::DocumentFacts facts, std::uint32_t srs, ReadLimits limits);

  void start();

  /// The first is the top-level building; a parent stands before what belongs to it.
  std::int32_t add_object(ObjectKind kind, std::string_view gml_id, std::int32_t parent);
  source::RawObject& object(std::int32_t index);
  void report(std::int32_t object, int code, std::string where);

  /// What is no surface of ours, by the name of its class: counted, and left out.
  void leave_out(std::int32_t object, std::string_view name);
  /// A boundary surface of an object, or an opening in its surface `outer`; its index there.
  std::int32_t add_surface(std::int32_t object, SurfaceType type, std::string_view gml_id,
                           std::int32_t outer = -1);

  /// Whose geometry follows.
  struct Owner {
    std::int32_t object = -1, surface = -1;
  };
  Tree::NodeId add_node(Tree::Kind kind, Tree::NodeId parent, Tree::Role role,
                        std::string_view gml_id);
  Tree::NodeId add_polygon(Owner owner, Tree::NodeId parent, Tree::Role role,
                           std::string_view gml_id, const StoredPolygons& stored,
                           const StoredPolygon& polygon);
  /// A geometry is complete. The reference point of a placement has the CRS of all coordinates.
  void add_geometry(Owner owner, Tree::NodeId root, Lod lod, bool footprint = false,
                    const source::Placement* placement = nullptr);

  /// The building; valid until the next start().
  source::Feature& finish();

 private:
  bool same_rings(std::uint32_t polygon, const StoredPolygons& stored, const StoredPolygon& other,
                  bool reversed) const;

  source::DocumentFacts facts_;
  std::uint32_t srs_;
  ReadLimits limits_;
  source::Feature feature_{};
  Tree tree_{};
  std::unordered_map<std::string, std::uint32_t> polygon_by_id_{};
};

/// Attributes of an object, in order; texts of repeated names are joined with ';'.
void add_attribute(Attributes& attributes, std::string_view name, AttributeValue value);

/// "(1,2)--/\--(3)": what the importer joined is joined as our readers do.
std::string joined_codes(std::string_view stored);

}  // namespace citymesh::citydb
