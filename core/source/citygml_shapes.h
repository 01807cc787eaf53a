#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/source/feature.h"
#include "core/source/placement.h"

namespace citymesh::source {

struct SharedGeometry;

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
    BoundarySurface,  ///< a wall, roof, opening …; its children are geometries and openings
  };
  enum class Role : std::uint8_t { Member, Exterior, Interior };

  using NodeId = std::int32_t;
  static constexpr NodeId kNone = -1;

  void clear();

  NodeId add(Kind kind, NodeId parent, Role role, std::string_view gml_id);
  NodeId add_reference(std::string_view href, NodeId parent, Role role);
  /// Its geometries are added below it, with their LoD.
  NodeId add_boundary_surface(SurfaceType type, NodeId parent, std::string_view gml_id);
  void set_reversed(NodeId node) { nodes_[index(node)].reversed = true; }
  void set_polygon(NodeId node, std::uint32_t polygon) { nodes_[index(node)].polygon = polygon; }
  void set_lod(NodeId node, std::int8_t lod) { nodes_[index(node)].lod = lod; }

  /// A geometry property of an object (surface -1) or of one of its boundary surfaces; no object:
  /// only a target of references.
  struct Root {
    NodeId node = kNone;
    std::int32_t object = -1;
    std::int32_t surface = -1;
    Lod lod{};
    bool footprint = false;
    bool in_shell = true;         ///< false: volumes of windows and doors
    std::int32_t placement = -1;  ///< of implicit geometry: what add_placement() gave
  };
  void add_root(const Root& root) { roots_.push_back(root); }
  std::int32_t add_placement(const Placement& placement);
  /// A boundary surface of an object, or an opening of its surface `outer`, that stands elsewhere.
  void add_surface_reference(std::string_view href, std::int32_t object, std::int32_t outer);

  /// Follows the references and gives the objects of `feature` their shapes: the stated ones, then
  /// one assembled of the boundary surfaces per LoD. What cannot be followed becomes an issue of
  /// the object and, when the feature does not have it, is added to `facts.unresolved`.
  void resolve(Feature& feature, const DocumentOptions& options, DocumentFacts& facts);

  /// Copies what this feature has below each of the wanted ids to `shared`; what that refers to
  /// and the feature does not have is added to `facts.unresolved`.
  void collect(const Feature& feature, const DocumentOptions& options,
               const std::set<std::string, std::less<>>& wanted, DocumentFacts& facts,
               SharedGeometry& shared);

 private:
  struct Text {
    std::uint32_t offset = 0, size = 0;
  };
  struct Node {
    Kind kind = Kind::Surfaces;
    Role role = Role::Member;
    bool reversed = false;
    std::int8_t lod = -1;
    SurfaceType type = SurfaceType::Unknown;
    Text text{};  ///< gml:id, or the href of a reference
    NodeId parent = kNone, first_child = kNone, last_child = kNone, next = kNone;
    std::uint32_t polygon = 0;
  };
  struct Walk;  // state of one resolution
  /// A node of this tree or of the shared one.
  struct Place {
    const GeometryTree* tree = nullptr;
    NodeId node = kNone;
  };

  static std::size_t index(NodeId node) { return static_cast<std::size_t>(node); }
  const Node& at(NodeId node) const { return nodes_[index(node)]; }
  std::string_view text(const Node& node) const {
    return std::string_view(texts_).substr(node.text.offset, node.text.size);
  }
  Text keep(std::string_view text);
  void index_ids();
  bool is_above(NodeId above, NodeId node) const;

  bool enter(unsigned depth, Walk& walk) const;
  void surfaces_below(NodeId node, bool reversed, unsigned depth, Walk& walk,
                      std::vector<PolygonUse>& uses) const;
  void solids_below(NodeId node, bool reversed, unsigned depth, Walk& walk, RawShape& shape) const;
  template <class Action>
  void follow(NodeId reference, Walk& walk, Action&& action) const;
  Place find(NodeId reference, const Walk& walk) const;
  Kind kind_behind(NodeId node, const Walk& walk) const;
  void shape_of(const Root& root, Walk& walk, RawShape& shape) const;
  void put(const Root& root, std::vector<PolygonUse>& uses, Walk& walk) const;

  struct Assembly;
  void add_boundary(const Root& root, Walk& walk, Assembly& assembly) const;
  void borrow_surface(NodeId surface, std::int32_t object, std::int32_t outer, unsigned depth,
                      Walk& walk, Assembly& assembly) const;
  NodeId copy_below(NodeId node, NodeId parent, const Feature& feature, SharedGeometry& shared,
                    std::vector<std::string>& referred) const;

  struct SurfaceReference {
    NodeId node = kNone;
    std::int32_t object = -1, outer = -1;
  };
  std::vector<Node> nodes_{};
  std::vector<Root> roots_{};
  std::vector<Placement> placements_{};
  std::vector<SurfaceReference> surface_references_{};
  std::string texts_{};
  bool has_references_ = false;
  std::unordered_map<std::string_view, NodeId> by_id_{};
};

/// Geometry that features of a document borrow from other features, by gml:id.
struct SharedGeometry {
  Feature pool{};
  GeometryTree tree{};  ///< its polygons are those of `pool`
  TextMap<GeometryTree::NodeId> by_id{};
  TextMap<SharedPlace> places{};
};

}  // namespace citymesh::source
