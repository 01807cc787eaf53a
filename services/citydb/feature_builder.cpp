#include "services/citydb/feature_builder.h"

#include <algorithm>
#include <utility>

namespace citymesh::citydb {

FeatureBuilder::FeatureBuilder(source::DocumentFacts facts, std::uint32_t srs, ReadLimits limits)
    : facts_(std::move(facts)), srs_(srs), limits_(limits) {}

void FeatureBuilder::start() {
  feature_.clear();
  feature_.srs = srs_;
  tree_.clear();
  polygon_by_id_.clear();
}

std::int32_t FeatureBuilder::add_object(ObjectKind kind, std::string_view gml_id,
                                        std::int32_t parent) {
  feature_.objects.push_back({.kind = kind, .gml_id = std::string(gml_id), .parent = parent});
  return static_cast<std::int32_t>(feature_.objects.size() - 1);
}

source::RawObject& FeatureBuilder::object(std::int32_t index) {
  return feature_.objects[static_cast<std::size_t>(index)];
}

void FeatureBuilder::report(std::int32_t index, int code, std::string where) {
  constexpr std::size_t kMaxIssues = 1000;
  auto& issues = object(index).issues;
  if (issues.size() < kMaxIssues) issues.push_back({code, std::move(where)});
}

void FeatureBuilder::leave_out(std::int32_t index, std::string_view name) {
  source::count_name(object(index).skipped_ade_elements, name);
}

std::int32_t FeatureBuilder::add_surface(std::int32_t index, SurfaceType type,
                                         std::string_view gml_id, std::int32_t outer) {
  auto& surfaces = object(index).surfaces;
  surfaces.push_back({type, std::string(gml_id), outer});
  return static_cast<std::int32_t>(surfaces.size() - 1);
}

FeatureBuilder::Tree::NodeId FeatureBuilder::add_node(Tree::Kind kind, Tree::NodeId parent,
                                                      Tree::Role role, std::string_view gml_id) {
  return tree_.add(kind, parent, role, gml_id);
}

bool FeatureBuilder::same_rings(std::uint32_t polygon, const StoredPolygons& stored,
                                const StoredPolygon& other, bool reversed) const {
  const auto& known = feature_.polygons[polygon];
  if (known.ring_count != other.ring_count) return false;
  for (std::uint32_t r = 0; r < other.ring_count; ++r) {
    const auto& ours = feature_.rings[known.first_ring + r];
    const auto& theirs = stored.rings[other.first_ring + r];
    if (ours.count != theirs.count) return false;
    for (std::uint32_t p = 0; p < ours.count; ++p) {
      const auto q = reversed ? ours.count - 1 - p : p;
      if (!(feature_.points[ours.first + q] == stored.points[theirs.first + p])) return false;
    }
  }
  return true;
}

FeatureBuilder::Tree::NodeId FeatureBuilder::add_polygon(Owner owner, Tree::NodeId parent,
                                                         Tree::Role role, std::string_view gml_id,
                                                         const StoredPolygons& stored,
                                                         const StoredPolygon& polygon) {
  if (!gml_id.empty()) {
    if (const auto known = polygon_by_id_.find(std::string(gml_id)); known != polygon_by_id_.end())
      for (const bool reversed : {false, true}) {
        if (!same_rings(known->second, stored, polygon, reversed)) continue;
        auto above = parent;
        if (reversed) {
          above = tree_.add(Tree::Kind::Orientable, parent, role, {});
          tree_.set_reversed(above);
        }
        const auto reference = tree_.add_reference("#" + std::string(gml_id), above,
                                                   reversed ? Tree::Role::Member : role);
        return reversed ? above : reference;
      }
  }
  const auto number = static_cast<std::uint32_t>(feature_.polygons.size());
  feature_.polygons.push_back({.gml_id = std::string(gml_id),
                               .first_ring = static_cast<std::uint32_t>(feature_.rings.size()),
                               .ring_count = polygon.ring_count,
                               .object = owner.surface >= 0 ? owner.object : -1,
                               .surface = owner.surface,
                               .srs = srs_});
  for (std::uint32_t r = 0; r < polygon.ring_count; ++r) {
    const auto& ring = stored.rings[polygon.first_ring + r];
    feature_.rings.push_back({static_cast<std::uint32_t>(feature_.points.size()), ring.count});
    const auto begin = stored.points.begin() + ring.first;
    feature_.points.insert(feature_.points.end(), begin, begin + ring.count);
  }
  if (!gml_id.empty()) polygon_by_id_.emplace(gml_id, number);
  const auto node = tree_.add(Tree::Kind::Polygon, parent, role, gml_id);
  tree_.set_polygon(node, number);
  return node;
}

void FeatureBuilder::add_geometry(Owner owner, Tree::NodeId root, Lod lod, bool footprint,
                                  const source::Placement* placement) {
  tree_.set_lod(root, lod.major);
  std::int32_t place = -1;
  if (placement != nullptr) {
    auto here = *placement;
    here.srs = srs_;
    place = tree_.add_placement(here);
  }
  tree_.add_root({.node = root,
                  .object = owner.object,
                  .surface = owner.surface,
                  .lod = lod,
                  .footprint = footprint,
                  .placement = place});
}

source::Feature& FeatureBuilder::finish() {
  const source::DocumentOptions options{.limits = limits_};
  tree_.resolve(feature_, options, facts_);
  return feature_;
}

void add_attribute(Attributes& attributes, std::string_view name, AttributeValue value) {
  const auto known = std::ranges::find(
      attributes, name, [](const auto& entry) -> const auto& { return entry.first; });
  if (known == attributes.end()) {
    attributes.emplace_back(name, std::move(value));
    return;
  }
  auto* text = std::get_if<std::string>(&known->second);
  const auto* more = std::get_if<std::string>(&value);
  if (text != nullptr && more != nullptr) *text += ";" + *more;
}

std::string joined_codes(std::string_view stored) {
  constexpr std::string_view kSeparator = "--/\\--";
  std::string codes(stored);
  for (auto at = codes.find(kSeparator); at != std::string::npos; at = codes.find(kSeparator, at))
    codes.replace(at, kSeparator.size(), ";");
  return codes;
}

}  // namespace citymesh::citydb
