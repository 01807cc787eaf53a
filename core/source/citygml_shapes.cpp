#include "core/source/citygml_shapes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/citymodel/issue.h"

namespace citymesh::source {
namespace {

/// Copies one polygon of another feature.
std::uint32_t copy_polygon(const Feature& from, std::uint32_t polygon, Feature& to) {
  RawPolygon copy = from.polygons[polygon];
  const std::uint32_t first_ring = copy.first_ring;
  copy.first_ring = static_cast<std::uint32_t>(to.rings.size());
  copy.object = -1;
  copy.surface = -1;
  for (std::uint32_t r = 0; r < copy.ring_count; ++r) {
    const RawRing ring = from.rings[first_ring + r];
    to.rings.push_back({static_cast<std::uint32_t>(to.points.size()), ring.count});
    const auto begin = from.points.begin() + ring.first;
    to.points.insert(to.points.end(), begin, begin + ring.count);
  }
  to.polygons.push_back(std::move(copy));
  return static_cast<std::uint32_t>(to.polygons.size() - 1);
}

constexpr std::size_t kMaxIssues = 1000;  // of one object; more tell nobody more

bool is_interior(SurfaceType type) {
  return type == SurfaceType::InteriorWallSurface || type == SurfaceType::CeilingSurface ||
         type == SurfaceType::FloorSurface;
}

bool is_local(std::string_view href) { return href.size() > 1 && href.front() == '#'; }

}  // namespace

struct GeometryTree::Walk {
  const GeometryTree& own;
  Feature& feature;
  const DocumentOptions& options;
  DocumentFacts& facts;
  std::vector<Issue>* issues = nullptr;  ///< of the object whose geometry is walked; may be null
  std::uint64_t points = 0;              ///< used so far, references counted each time
  bool too_large = false;
  std::unordered_map<std::uint32_t, std::uint32_t> borrowed{};  ///< shared polygon -> own copy
  /// Surfaces of polygons that boundary surfaces of several objects have, of all but the first
  /// object: a wall between house and garage.
  std::map<std::pair<std::int32_t, std::uint32_t>, std::int32_t> further_surfaces{};
  std::vector<Place> path{};  ///< the references that are open

  void report(int code, std::string where) const {
    if (issues && issues->size() < kMaxIssues) issues->push_back({code, std::move(where)});
  }
  /// References can multiply: n lists that name each other twice stand for 2^n polygons.
  bool step() {
    if (++points > options.limits.max_points_per_building) too_large = true;
    return !too_large;
  }
  bool count_points(const RawPolygon& polygon) {
    for (std::uint32_t r = 0; r < polygon.ring_count; ++r)
      points += feature.rings[polygon.first_ring + r].count;
    return step();
  }
  /// The polygon of a node of `tree` as one of the feature.
  std::uint32_t polygon(const GeometryTree& tree, std::uint32_t number) {
    if (&tree == &own) return number;
    const auto [entry, is_new] = borrowed.try_emplace(number, 0u);
    if (is_new) entry->second = copy_polygon(options.shared->pool, number, feature);
    return entry->second;
  }
};

void GeometryTree::clear() {
  nodes_.clear();
  roots_.clear();
  placements_.clear();
  surface_references_.clear();
  texts_.clear();
  by_id_.clear();
  has_references_ = false;
}

GeometryTree::Text GeometryTree::keep(std::string_view text) {
  const Text kept{static_cast<std::uint32_t>(texts_.size()),
                  static_cast<std::uint32_t>(text.size())};
  texts_.append(text);
  return kept;
}

GeometryTree::NodeId GeometryTree::add(Kind kind, NodeId parent, Role role,
                                       std::string_view gml_id) {
  const auto id = static_cast<NodeId>(nodes_.size());
  Node& node = nodes_.emplace_back();
  node.kind = kind;
  node.role = role;
  node.parent = parent;
  node.text = keep(gml_id);
  if (parent == kNone) return id;
  Node& above = nodes_[index(parent)];
  if (above.last_child == kNone)
    above.first_child = id;
  else
    nodes_[index(above.last_child)].next = id;
  above.last_child = id;
  return id;
}

GeometryTree::NodeId GeometryTree::add_reference(std::string_view href, NodeId parent, Role role) {
  has_references_ = true;
  return add(Kind::Reference, parent, role, href);
}

GeometryTree::NodeId GeometryTree::add_boundary_surface(SurfaceType type, NodeId parent,
                                                        std::string_view gml_id) {
  const NodeId node = add(Kind::BoundarySurface, parent, Role::Member, gml_id);
  nodes_[index(node)].type = type;
  return node;
}

std::int32_t GeometryTree::add_placement(const Placement& placement) {
  placements_.push_back(placement);
  return static_cast<std::int32_t>(placements_.size() - 1);
}

void GeometryTree::add_surface_reference(std::string_view href, std::int32_t object,
                                         std::int32_t outer) {
  surface_references_.push_back({add_reference(href, kNone, Role::Member), object, outer});
}

void GeometryTree::index_ids() {
  by_id_.clear();
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].kind != Kind::Reference && nodes_[n].text.size > 0)
      by_id_.emplace(text(nodes_[n]), static_cast<NodeId>(n));  // of repeated ids the first counts
}

bool GeometryTree::is_above(NodeId above, NodeId node) const {
  while (node != kNone && node != above) node = at(node).parent;
  return node == above;
}

// ---- references --------------------------------------------------------------------------------

// Where a reference leads: in its own feature first, then in what others share.
GeometryTree::Place GeometryTree::find(NodeId reference, const Walk& walk) const {
  const std::string_view href = text(at(reference));
  if (!is_local(href)) return {};
  const std::string_view id = href.substr(1);
  if (this == &walk.own)
    if (const auto found = by_id_.find(id); found != by_id_.end()) return {this, found->second};
  if (!walk.options.shared) return {};
  const auto found = walk.options.shared->by_id.find(id);
  if (found == walk.options.shared->by_id.end()) return {};
  return {&walk.options.shared->tree, found->second};
}

template <class Action>
void GeometryTree::follow(NodeId reference, Walk& walk, Action&& action) const {
  const std::string_view href = text(at(reference));
  if (!is_local(href))
    return walk.report(issue_code::kDanglingXlink,
                       "xlink:href '" + std::string(href) + "' points outside of the document");
  const Place target = find(reference, walk);
  if (target.tree != &walk.own) walk.feature.borrowed.emplace(href.substr(1));
  if (!target.tree) {
    walk.facts.unresolved.emplace(href.substr(1));
    return walk.report(issue_code::kDanglingXlink, "xlink:href '" + std::string(href) + "'");
  }
  walk.path.push_back({this, reference});
  const bool cyclic = std::any_of(walk.path.begin(), walk.path.end(), [&](const Place& open) {
    return open.tree == target.tree && open.tree->is_above(target.node, open.node);
  });
  if (cyclic)
    walk.report(issue_code::kCyclicXlink, "'" + std::string(href.substr(1)) + "' contains itself");
  else
    action(*target.tree, target.node);
  walk.path.pop_back();
}

bool GeometryTree::enter(unsigned depth, Walk& walk) const {
  if (!walk.step()) return false;
  if (depth <= walk.options.limits.max_depth) return true;
  walk.report(issue_code::kReadLimitExceeded, "references nested deeper than max_depth = " +
                                                  std::to_string(walk.options.limits.max_depth));
  return false;
}

void GeometryTree::surfaces_below(NodeId id, bool reversed, unsigned depth, Walk& walk,
                                  std::vector<PolygonUse>& uses) const {
  if (!enter(depth, walk)) return;
  const Node& node = at(id);
  if (node.kind == Kind::Polygon) {
    const std::uint32_t polygon = walk.polygon(*this, node.polygon);
    const RawPolygon& raw = walk.feature.polygons[polygon];
    if (raw.usable && walk.count_points(raw)) uses.push_back({polygon, reversed});
    return;
  }
  if (node.kind == Kind::Reference)
    return follow(id, walk, [&](const GeometryTree& tree, NodeId target) {
      tree.surfaces_below(target, reversed, depth + 1, walk, uses);
    });
  for (NodeId child = node.first_child; child != kNone; child = at(child).next)
    surfaces_below(child, reversed != node.reversed, depth + 1, walk, uses);
}

void GeometryTree::solids_below(NodeId id, bool reversed, unsigned depth, Walk& walk,
                                RawShape& shape) const {
  if (!enter(depth, walk)) return;
  const Node& node = at(id);
  switch (node.kind) {
    case Kind::Solid: {
      Solid solid;
      for (NodeId child = node.first_child; child != kNone; child = at(child).next) {
        std::vector<std::uint32_t> shell;
        const std::size_t first = shape.uses.size();
        surfaces_below(child, reversed, depth + 1, walk, shape.uses);
        for (std::size_t i = first; i < shape.uses.size(); ++i)
          shell.push_back(static_cast<std::uint32_t>(i));
        if (at(child).role == Role::Interior)
          solid.interiors.push_back(std::move(shell));
        else
          solid.exterior.insert(solid.exterior.end(), shell.begin(), shell.end());
      }
      shape.solids.push_back(std::move(solid));
      return;
    }
    case Kind::Reference:
      return follow(id, walk, [&](const GeometryTree& tree, NodeId target) {
        tree.solids_below(target, reversed, depth + 1, walk, shape);
      });
    case Kind::Polygon:
    case Kind::CompositeSurface:
    case Kind::Orientable:
    case Kind::BoundarySurface:
      return;  // no volume
    default:
      for (NodeId child = node.first_child; child != kNone; child = at(child).next)
        solids_below(child, reversed != node.reversed, depth + 1, walk, shape);
  }
}

// What a property holds, seen through references.
GeometryTree::Kind GeometryTree::kind_behind(NodeId node, const Walk& walk) const {
  const GeometryTree* tree = this;
  for (std::uint32_t hops = 0; hops <= walk.options.limits.max_depth; ++hops) {
    const Node& here = tree->at(node);
    if (here.kind == Kind::Surfaces && here.first_child != kNone) {
      // A MultiGeometry of solids.
      Kind child = tree->at(here.first_child).kind;
      if (child == Kind::Reference)
        if (const Place target = tree->find(here.first_child, walk); target.tree)
          child = target.tree->at(target.node).kind;
      if (child == Kind::Solid || child == Kind::CompositeSolid) return Kind::MultiSolid;
    }
    if (here.kind != Kind::Reference) return here.kind;
    const Place target = tree->find(node, walk);
    if (!target.tree) break;
    tree = target.tree;
    node = target.node;
  }
  return Kind::Surfaces;
}

// ---- shapes ------------------------------------------------------------------------------------

/// What boundary surfaces are assembled to.
struct GeometryTree::Assembly {
  std::map<std::pair<std::int32_t, Lod>, std::vector<PolygonUse>> uses{};  ///< by object and LoD
};

void GeometryTree::put(const Root& root, std::vector<PolygonUse>& uses, Walk& walk) const {
  if (root.placement < 0) return;
  const Placement& placement = placements_[index(root.placement)];
  const Placer placer(placement, walk.facts.srs_names[placement.srs]);
  for (PolygonUse& use : uses) use = placer.copy(walk.feature, use, walk.feature);
}

void GeometryTree::add_boundary(const Root& root, Walk& walk, Assembly& assembly) const {
  std::vector<PolygonUse> uses;
  surfaces_below(root.node, false, 0, walk, uses);
  put(root, uses, walk);
  for (PolygonUse& use : uses) {
    RawPolygon& polygon = walk.feature.polygons[use.polygon];
    use.surface = root.surface;
    if (polygon.surface >= 0) {
      if (polygon.object != root.object)
        walk.further_surfaces.emplace(std::pair(root.object, use.polygon), root.surface);
      continue;
    }
    polygon.object = root.object;
    polygon.surface = root.surface;
  }
  const RawObject& object = walk.feature.objects[index(root.object)];
  if (!root.in_shell || is_interior(object.surfaces[index(root.surface)].type)) return;
  auto& all = assembly.uses[{root.object, root.lod}];
  all.insert(all.end(), uses.begin(), uses.end());
}

// Gives an object a boundary surface that stands elsewhere, with its openings.
void GeometryTree::borrow_surface(NodeId id, std::int32_t object_index, std::int32_t outer,
                                  unsigned depth, Walk& walk, Assembly& assembly) const {
  if (!enter(depth, walk)) return;
  const Node& node = at(id);
  if (node.kind != Kind::BoundarySurface)
    return walk.report(issue_code::kUnreadableGeometry,
                       "'" + std::string(text(node)) + "' is no boundary surface");
  RawObject& object = walk.feature.objects[index(object_index)];
  object.surfaces.push_back({node.type, std::string(text(node)), outer});
  const auto surface = static_cast<std::int32_t>(object.surfaces.size() - 1);
  for (NodeId child = node.first_child; child != kNone; child = at(child).next) {
    if (at(child).kind == Kind::BoundarySurface)
      borrow_surface(child, object_index, surface, depth + 1, walk, assembly);
    else
      add_boundary(
          {.node = child, .object = object_index, .surface = surface, .lod = {at(child).lod}}, walk,
          assembly);
  }
}

void GeometryTree::shape_of(const Root& root, Walk& walk, RawShape& shape) const {
  switch (kind_behind(root.node, walk)) {
    case Kind::Solid:
      shape.type = GeometryType::Solid;
      break;
    case Kind::CompositeSolid:
      shape.type = GeometryType::CompositeSolid;
      break;
    case Kind::MultiSolid:
      shape.type = GeometryType::MultiSolid;
      break;
    case Kind::CompositeSurface:
      shape.type = GeometryType::CompositeSurface;
      break;
    default:
      shape.type = GeometryType::MultiSurface;
  }
  if (shape.type == GeometryType::MultiSurface || shape.type == GeometryType::CompositeSurface)
    surfaces_below(root.node, false, 0, walk, shape.uses);
  else
    solids_below(root.node, false, 0, walk, shape);
  put(root, shape.uses, walk);
}

void GeometryTree::resolve(Feature& feature, const DocumentOptions& options, DocumentFacts& facts) {
  if (has_references_) index_ids();
  Walk walk{.own = *this, .feature = feature, .options = options, .facts = facts};

  // Boundary surfaces first: a polygon that they borrow from a solid learns its surface.
  Assembly assembly;
  for (const Root& root : roots_) {
    if (root.object < 0 || root.surface < 0) continue;
    walk.issues = &feature.objects[index(root.object)].issues;
    add_boundary(root, walk, assembly);
  }
  for (const SurfaceReference& reference : surface_references_) {
    if (reference.object < 0) continue;
    walk.issues = &feature.objects[index(reference.object)].issues;
    follow(reference.node, walk, [&](const GeometryTree& tree, NodeId target) {
      tree.borrow_surface(target, reference.object, reference.outer, 0, walk, assembly);
    });
  }
  for (const Root& root : roots_) {
    if (root.object < 0 || root.surface >= 0) continue;
    RawObject& object = feature.objects[index(root.object)];
    walk.issues = &object.issues;
    RawShape shape{.lod = root.lod, .footprint = root.footprint, .closed_rings = true};
    shape_of(root, walk, shape);
    for (PolygonUse& use : shape.uses)
      if (const auto further = walk.further_surfaces.find({root.object, use.polygon});
          further != walk.further_surfaces.end())
        use.surface = further->second;
    if (!shape.uses.empty()) object.shapes.push_back(std::move(shape));
  }
  for (auto& [key, uses] : assembly.uses) {
    if (uses.empty()) continue;
    feature.objects[index(key.first)].shapes.push_back({.lod = key.second,
                                                        .assembled = true,
                                                        .footprint = key.second.major == 0,
                                                        .closed_rings = true,
                                                        .uses = std::move(uses)});
  }

  if (walk.too_large) {
    for (RawObject& object : feature.objects) object.shapes.clear();
    feature.objects.front().issues.push_back(
        {issue_code::kReadLimitExceeded,
         "more than max_points_per_building = " +
             std::to_string(options.limits.max_points_per_building) + " points"});
  }
}

// ---- sharing -----------------------------------------------------------------------------------

GeometryTree::NodeId GeometryTree::copy_below(NodeId id, NodeId parent, const Feature& feature,
                                              SharedGeometry& shared,
                                              std::vector<std::string>& referred) const {
  const Node& node = at(id);
  const NodeId copy = shared.tree.add(node.kind, parent, node.role, text(node));
  Node& made = shared.tree.nodes_[index(copy)];
  made.reversed = node.reversed;
  made.lod = node.lod;
  made.type = node.type;
  if (node.kind == Kind::Polygon) made.polygon = copy_polygon(feature, node.polygon, shared.pool);
  if (node.kind == Kind::Reference && is_local(text(node)))
    referred.emplace_back(text(node).substr(1));
  for (NodeId child = node.first_child; child != kNone; child = at(child).next)
    copy_below(child, copy, feature, shared, referred);
  return copy;
}

void GeometryTree::collect(const Feature& feature, const DocumentOptions& options,
                           const std::set<std::string, std::less<>>& wanted, DocumentFacts& facts,
                           SharedGeometry& shared) {
  std::vector<std::string> due;
  for (const Node& node : nodes_)
    if (node.kind != Kind::Reference && node.text.size > 0 && wanted.contains(text(node)))
      due.emplace_back(text(node));
  if (due.empty()) return;
  index_ids();
  while (!due.empty()) {
    const std::string id = std::move(due.back());
    due.pop_back();
    if (shared.by_id.contains(id)) continue;
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) {
      facts.unresolved.emplace(id);
      continue;
    }
    if (shared.pool.points.size() > options.limits.max_points_per_building)
      return;  // the rest stays dangling
    shared.by_id.emplace(id, copy_below(found->second, kNone, feature, shared, due));
    shared.places.emplace(id, SharedPlace{feature.bytes, feature.envelope});
  }
}

}  // namespace citymesh::source
