#include "services/citydb/surface_tree.h"

namespace citymesh::citydb {
namespace {

using Tree = FeatureBuilder::Tree;

constexpr unsigned kMaxDepth = 256;

enum Column { kRoot, kId, kParent, kGmlId, kSolid, kComposite, kTriangulated, kGeometry };

}  // namespace

Result<SurfaceTrees> SurfaceTrees::of(const postgres::Rows& rows) {
  SurfaceTrees trees;
  trees.rows_.reserve(static_cast<std::size_t>(rows.size()));
  for (int r = 0; r < rows.size(); ++r) {
    Row& row = trees.rows_.emplace_back();
    row.id = rows.integer(r, kId);
    row.parent = rows.null(r, kParent) ? 0 : rows.integer(r, kParent);
    row.gml_id = rows.text(r, kGmlId);
    row.solid = rows.integer(r, kSolid) != 0;
    row.composite = rows.integer(r, kComposite) != 0;
    row.triangulated = rows.integer(r, kTriangulated) != 0;
    if (!rows.null(r, kGeometry)) {
      const auto first = trees.polygons_.polygons.size();
      if (auto added = add_ewkb(rows.text(r, kGeometry), trees.polygons_); !added)
        return fail(ErrorCode::DataLoss,
                    "surface_geometry " + std::to_string(row.id) + ": " + added.error().message);
      if (trees.polygons_.polygons.size() > first) row.polygon = static_cast<std::int32_t>(first);
    }
    trees.by_id_.emplace(row.id, r);
  }
  for (std::int32_t r = 0; r < static_cast<std::int32_t>(trees.rows_.size()); ++r) {
    const auto parent = trees.by_id_.find(trees.rows_[static_cast<std::size_t>(r)].parent);
    if (parent == trees.by_id_.end() || parent->second == r) continue;
    Row& above = trees.rows_[static_cast<std::size_t>(parent->second)];
    if (above.last_child < 0)
      above.first_child = r;
    else
      trees.rows_[static_cast<std::size_t>(above.last_child)].next = r;
    above.last_child = r;
  }
  return trees;
}

bool SurfaceTrees::add(std::int64_t root, FeatureBuilder::Owner owner, Lod lod, bool footprint,
                       const source::Placement* placement, FeatureBuilder& builder) const {
  const auto found = by_id_.find(root);
  if (found == by_id_.end()) return false;
  const auto node = add(rows_[static_cast<std::size_t>(found->second)], owner, Tree::kNone,
                        Tree::Role::Member, 0, builder);
  if (node == Tree::kNone) return false;
  builder.add_geometry(owner, node, lod, footprint, placement);
  return true;
}

/// The order of the tests is that of the exporter: a leaf, then what the flags say, then what the
/// children are.
Tree::NodeId SurfaceTrees::add(const Row& row, FeatureBuilder::Owner owner, Tree::NodeId parent,
                               Tree::Role role, unsigned depth, FeatureBuilder& builder) const {
  if (depth > kMaxDepth) return Tree::kNone;
  if (row.polygon >= 0)
    return builder.add_polygon(owner, parent, role, row.gml_id, polygons_,
                               polygons_.polygons[static_cast<std::size_t>(row.polygon)]);
  const auto at = [this](std::int32_t r) -> const Row& {
    return rows_[static_cast<std::size_t>(r)];
  };
  auto kind = row.triangulated ? Tree::Kind::CompositeSurface : Tree::Kind::Surfaces;
  if (!row.triangulated) {
    if (row.solid) {
      kind = row.composite ? Tree::Kind::CompositeSolid : Tree::Kind::Solid;
    } else if (row.composite) {
      kind = Tree::Kind::CompositeSurface;
    } else {
      bool solids = row.first_child >= 0;
      for (auto child = row.first_child; child >= 0; child = at(child).next)
        solids = solids && at(child).solid;
      if (solids) kind = Tree::Kind::MultiSolid;
    }
  }
  const auto node = builder.add_node(kind, parent, role, row.gml_id);
  for (auto child = row.first_child; child >= 0; child = at(child).next)
    add(at(child), owner, node,
        kind == Tree::Kind::Solid ? Tree::Role::Exterior : Tree::Role::Member, depth + 1, builder);
  return node;
}

}  // namespace citymesh::citydb
