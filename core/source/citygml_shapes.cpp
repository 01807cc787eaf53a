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

}  // namespace

struct GeometryTree::Walk {
  Feature& feature;
  const DocumentOptions& options;
  std::set<std::string, std::less<>>* unresolved = nullptr;
  std::vector<Issue>* issues = nullptr;  ///< of the object whose geometry is walked; may be null
  std::uint64_t points = 0;              ///< used so far, references counted each time
  bool too_large = false;
  std::unordered_map<std::uint32_t, std::uint32_t> borrowed{};  ///< shared polygon -> own copy

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
};

void GeometryTree::clear() {
  nodes_.clear();
  roots_.clear();
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

void GeometryTree::add_reference(std::string_view href, NodeId parent, Role role) {
  add(Kind::Reference, parent, role, href);
  has_references_ = true;
}

GeometryTree::NodeId GeometryTree::add_root_reference(std::string_view href) {
  has_references_ = true;
  return add(Kind::Reference, kNone, Role::Member, href);
}

void GeometryTree::index_ids() {
  by_id_.clear();
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].kind != Kind::Reference && nodes_[n].text.size > 0)
      by_id_.emplace(text(nodes_[n]), static_cast<NodeId>(n));  // of repeated ids the first counts
}

// The node that a reference means, kNone when it is not in this feature.
GeometryTree::NodeId GeometryTree::follow(NodeId reference, Walk& walk) {
  const std::string_view href = text(nodes_[index(reference)]);
  if (href.size() < 2 || href.front() != '#') {
    walk.report(issue_code::kDanglingXlink,
                "xlink:href '" + std::string(href) + "' points outside of the document");
    return kNone;
  }
  const auto found = by_id_.find(href.substr(1));
  return found == by_id_.end() ? kNone : found->second;
}

bool GeometryTree::borrow(std::string_view id, bool reversed, Walk& walk,
                          std::vector<PolygonUse>& uses) {
  walk.feature.borrowed.emplace(id);
  if (walk.options.shared) {
    if (const auto found = walk.options.shared->by_id.find(id);
        found != walk.options.shared->by_id.end()) {
      for (const PolygonUse& use : found->second) {
        const auto [entry, is_new] = walk.borrowed.try_emplace(use.polygon, 0u);
        if (is_new)
          entry->second = copy_polygon(walk.options.shared->pool, use.polygon, walk.feature);
        if (!walk.count_points(walk.feature.polygons[entry->second])) return true;
        uses.push_back({entry->second, use.reversed != reversed});
      }
      return true;
    }
  }
  walk.report(issue_code::kDanglingXlink, "xlink:href '#" + std::string(id) + "'");
  if (walk.unresolved) walk.unresolved->emplace(id);
  return false;
}

void GeometryTree::children_surfaces(const Node& node, bool reversed, unsigned depth, Walk& walk,
                                     std::vector<PolygonUse>& uses) {
  for (NodeId child = node.first_child; child != kNone; child = nodes_[index(child)].next)
    surfaces_below(child, reversed, depth + 1, walk, uses);
}

void GeometryTree::surfaces_below(NodeId id, bool reversed, unsigned depth, Walk& walk,
                                  std::vector<PolygonUse>& uses) {
  if (!walk.step()) return;
  if (depth > walk.options.limits.max_depth) {
    walk.report(issue_code::kReadLimitExceeded, "references nested deeper than max_depth = " +
                                                    std::to_string(walk.options.limits.max_depth));
    return;
  }
  Node& node = nodes_[index(id)];
  if (node.on_path) {
    walk.report(issue_code::kCyclicXlink, "'" + std::string(text(node)) + "' contains itself");
    return;
  }
  switch (node.kind) {
    case Kind::Polygon: {
      const RawPolygon& polygon = walk.feature.polygons[node.polygon];
      if (polygon.usable && walk.count_points(polygon)) uses.push_back({node.polygon, reversed});
      return;
    }
    case Kind::Reference: {
      const NodeId target = follow(id, walk);
      if (target != kNone) {
        node.on_path = true;
        surfaces_below(target, reversed, depth + 1, walk, uses);
        node.on_path = false;
      } else if (const auto href = text(node); href.size() > 1 && href.front() == '#') {
        borrow(href.substr(1), reversed, walk, uses);
      }
      return;
    }
    default:
      break;
  }
  node.on_path = true;
  children_surfaces(node, reversed != node.reversed, depth, walk, uses);
  node.on_path = false;
}

void GeometryTree::solids_below(NodeId id, bool reversed, unsigned depth, Walk& walk,
                                RawShape& shape) {
  if (!walk.step()) return;
  if (depth > walk.options.limits.max_depth) {
    walk.report(issue_code::kReadLimitExceeded, "references nested deeper than max_depth = " +
                                                    std::to_string(walk.options.limits.max_depth));
    return;
  }
  Node& node = nodes_[index(id)];
  if (node.on_path) {
    walk.report(issue_code::kCyclicXlink, "'" + std::string(text(node)) + "' contains itself");
    return;
  }
  const auto shell_since = [&](std::size_t first) {
    std::vector<std::uint32_t> shell(shape.uses.size() - first);
    for (std::size_t i = 0; i < shell.size(); ++i) shell[i] = static_cast<std::uint32_t>(first + i);
    return shell;
  };

  node.on_path = true;
  switch (node.kind) {
    case Kind::Solid: {
      Solid solid;
      for (NodeId child = node.first_child; child != kNone; child = nodes_[index(child)].next) {
        const std::size_t first = shape.uses.size();
        surfaces_below(child, reversed, depth + 1, walk, shape.uses);
        auto shell = shell_since(first);
        if (nodes_[index(child)].role == Role::Interior)
          solid.interiors.push_back(std::move(shell));
        else
          solid.exterior.insert(solid.exterior.end(), shell.begin(), shell.end());
      }
      shape.solids.push_back(std::move(solid));
      break;
    }
    case Kind::Reference: {
      const NodeId target = follow(id, walk);
      if (target != kNone) {
        solids_below(target, reversed, depth + 1, walk, shape);
      } else if (const auto href = text(node); href.size() > 1 && href.front() == '#') {
        const std::size_t first = shape.uses.size();
        if (borrow(href.substr(1), reversed, walk, shape.uses))
          shape.solids.push_back({.exterior = shell_since(first)});
      }
      break;
    }
    case Kind::Polygon:
    case Kind::CompositeSurface:
    case Kind::Orientable:
      break;  // no volume
    default:
      for (NodeId child = node.first_child; child != kNone; child = nodes_[index(child)].next)
        solids_below(child, reversed != node.reversed, depth + 1, walk, shape);
  }
  node.on_path = false;
}

// What a property holds, seen through references.
GeometryTree::Kind GeometryTree::kind_behind(NodeId node) const {
  for (std::size_t hops = 0; hops <= nodes_.size(); ++hops) {
    const Node& at = nodes_[index(node)];
    if (at.kind != Kind::Reference) {
      if (at.kind == Kind::Surfaces && at.first_child != kNone) {
        // A MultiGeometry of solids.
        const Kind child = nodes_[index(at.first_child)].kind;
        if (child == Kind::Solid || child == Kind::CompositeSolid) return Kind::MultiSolid;
      }
      return at.kind;
    }
    const std::string_view href = text(at);
    const auto found = href.empty() ? by_id_.end() : by_id_.find(href.substr(1));
    if (found == by_id_.end()) break;
    node = found->second;
  }
  return Kind::Surfaces;
}

void GeometryTree::resolve(Feature& feature, const DocumentOptions& options,
                           std::set<std::string, std::less<>>& unresolved) {
  if (has_references_) index_ids();
  Walk walk{.feature = feature, .options = options, .unresolved = &unresolved};

  // Boundary surfaces first: a polygon that they borrow from a solid learns its surface.
  std::map<std::pair<std::int32_t, Lod>, std::vector<PolygonUse>> assembled;
  for (const Root& root : roots_) {
    if (root.object < 0 || root.surface < 0) continue;
    RawObject& object = feature.objects[index(root.object)];
    walk.issues = &object.issues;
    std::vector<PolygonUse> uses;
    surfaces_below(root.node, false, 0, walk, uses);
    for (const PolygonUse& use : uses) {
      RawPolygon& polygon = feature.polygons[use.polygon];
      if (polygon.surface >= 0) continue;
      polygon.object = root.object;
      polygon.surface = root.surface;
    }
    if (is_interior(object.surfaces[index(root.surface)].type)) continue;
    auto& all = assembled[{root.object, root.lod}];
    all.insert(all.end(), uses.begin(), uses.end());
  }

  for (const Root& root : roots_) {
    if (root.object < 0 || root.surface >= 0) continue;
    RawObject& object = feature.objects[index(root.object)];
    walk.issues = &object.issues;
    RawShape shape{.lod = root.lod, .footprint = root.footprint};
    switch (kind_behind(root.node)) {
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
    if (!shape.uses.empty()) object.shapes.push_back(std::move(shape));
  }

  for (auto& [key, uses] : assembled) {
    if (uses.empty()) continue;
    feature.objects[index(key.first)].shapes.push_back({.lod = key.second,
                                                        .assembled = true,
                                                        .footprint = key.second.major == 0,
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

void GeometryTree::collect(Feature& feature, const DocumentOptions& options,
                           const std::set<std::string, std::less<>>& wanted,
                           SharedGeometry& shared) {
  Walk walk{.feature = feature, .options = options};
  bool indexed = false;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (node.kind == Kind::Reference || node.text.size == 0) continue;
    const std::string id(text(node));
    if (!wanted.contains(id) || shared.by_id.contains(id)) continue;
    if (!std::exchange(indexed, true)) index_ids();
    std::vector<PolygonUse> uses;
    surfaces_below(static_cast<NodeId>(n), false, 0, walk, uses);
    if (walk.too_large ||
        shared.pool.points.size() + walk.points > options.limits.max_points_per_building)
      return;  // the rest stays dangling
    for (PolygonUse& use : uses) use.polygon = copy_polygon(feature, use.polygon, shared.pool);
    shared.by_id.emplace(id, std::move(uses));
    shared.places.emplace(id, SharedPlace{feature.bytes, feature.envelope});
  }
}

}  // namespace citymesh::source
