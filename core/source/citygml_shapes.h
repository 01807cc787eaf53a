#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/source/feature.h"

namespace citymesh::source {

/// The geometry tree of one top-level feature as GML nests it, before references are followed.
class GeometryTree {
 public:
  enum class Kind : std::uint8_t {
    Polygon,
    Reference,
    Surfaces,  ///< any list
    CompositeSurface,
    Solid,
    CompositeSolid,
    MultiSolid,
    Orientable,
  };
  enum class Role : std::uint8_t { Member, Exterior, Interior };

  using NodeId = std::int32_t;
  static constexpr NodeId kNone = -1;

  void clear();

  NodeId add(Kind kind, NodeId parent, Role role, std::string_view gml_id);
  void add_reference(std::string_view href, NodeId parent, Role role);
  void set_reversed(NodeId node) { nodes_[index(node)].reversed = true; }
  void set_polygon(NodeId node, std::uint32_t polygon) { nodes_[index(node)].polygon = polygon; }

  /// A geometry property of an object (surface -1) or of one of its boundary surfaces; no object:
  /// only a target of references.
  struct Root {
    NodeId node = kNone;
    std::int32_t object = -1;
    std::int32_t surface = -1;
    Lod lod{};
    bool footprint = false;
  };
  NodeId add_root_reference(std::string_view href);
  void add_root(const Root& root) { roots_.push_back(root); }

  /// Follows the references and gives the objects of `feature` their shapes: the stated ones, then
  /// one assembled of the boundary surfaces per LoD. What cannot be followed becomes an issue of
  /// the object and, when the feature does not have it, is added to `unresolved`.
  void resolve(Feature& feature, const DocumentOptions& options,
               std::set<std::string, std::less<>>& unresolved);

  /// The polygons below each of the wanted ids that this feature has, added to `shared`.
  void collect(Feature& feature, const DocumentOptions& options,
               const std::set<std::string, std::less<>>& wanted, SharedGeometry& shared);

 private:
  struct Text {
    std::uint32_t offset = 0, size = 0;
  };
  struct Node {
    Kind kind = Kind::Surfaces;
    Role role = Role::Member;
    bool reversed = false;
    bool on_path = false;
    Text text{};  ///< gml:id, or the href of a reference
    NodeId first_child = kNone, last_child = kNone, next = kNone;
    std::uint32_t polygon = 0;
  };
  struct Walk;  // state of one resolution

  static std::size_t index(NodeId node) { return static_cast<std::size_t>(node); }
  std::string_view text(const Node& node) const {
    return std::string_view(texts_).substr(node.text.offset, node.text.size);
  }
  Text keep(std::string_view text);
  void index_ids();
  void surfaces_below(NodeId node, bool reversed, unsigned depth, Walk& walk,
                      std::vector<PolygonUse>& uses);
  void solids_below(NodeId node, bool reversed, unsigned depth, Walk& walk, RawShape& shape);
  void children_surfaces(const Node& node, bool reversed, unsigned depth, Walk& walk,
                         std::vector<PolygonUse>& uses);
  NodeId follow(NodeId reference, Walk& walk);
  Kind kind_behind(NodeId node) const;
  bool borrow(std::string_view id, bool reversed, Walk& walk, std::vector<PolygonUse>& uses);

  std::vector<Node> nodes_{};
  std::vector<Root> roots_{};
  std::string texts_{};
  bool has_references_ = false;
  std::unordered_map<std::string_view, NodeId> by_id_{};
};

}  // namespace citymesh::source
