#include "services/citydb/geometry_data.h"

#include <fmt/format.h>
#include <simdjson.h>

#include <utility>

namespace citymesh::citydb {
namespace {

namespace dom = simdjson::dom;
using Tree = FeatureBuilder::Tree;

/// Numbers of the types in `geometry_properties`.
enum StoredType : std::int64_t {
  kStoredPolygon = 5,
  kStoredCompositeSurface = 6,
  kStoredTriangulatedSurface = 7,
  kStoredMultiSurface = 8,
  kStoredSolid = 9,
  kStoredCompositeSolid = 10,
  kStoredMultiSolid = 11
};

bool is_collection(std::int64_t type) { return type > kStoredPolygon; }

Tree::Kind kind_of(std::int64_t type) {
  switch (type) {
    case kStoredPolygon:
      return Tree::Kind::Polygon;
    case kStoredCompositeSurface:
    case kStoredTriangulatedSurface:
      return Tree::Kind::CompositeSurface;
    case kStoredSolid:
      return Tree::Kind::Solid;
    case kStoredCompositeSolid:
      return Tree::Kind::CompositeSolid;
    case kStoredMultiSolid:
      return Tree::Kind::MultiSolid;
    default:
      return Tree::Kind::Surfaces;
  }
}

Error damaged(std::string what) { return fail(ErrorCode::DataLoss, std::move(what)); }

}  // namespace

struct GeometryData::Item {
  std::int64_t type = 0;
  std::string_view id{};
  std::size_t parent = 0;  ///< index into items_
  std::int64_t polygon = -1;
  Tree::NodeId node = Tree::kNone;
};

struct GeometryData::Parser {
  dom::parser parser{};
  std::string padded{};

  dom::element parse(std::string_view json, simdjson::error_code& code) {
    padded.assign(json);
    padded.append(simdjson::SIMDJSON_PADDING, ' ');
    dom::element element;
    code = parser.parse(padded.data(), json.size(), false).get(element);
    return element;
  }
};

GeometryData::GeometryData() : parser_(std::make_unique<Parser>()) {}
GeometryData::~GeometryData() = default;

Result<std::string> GeometryData::words(std::string_view json) {
  auto code = simdjson::SUCCESS;
  const auto element = parser_->parse(json, code);
  dom::array list;
  if (code != simdjson::SUCCESS || element.get(list) != simdjson::SUCCESS)
    return damaged("expected a JSON list");
  std::string words;
  for (const dom::element value : list) {
    if (!words.empty()) words += ' ';
    std::string_view text;
    if (value.get(text) == simdjson::SUCCESS)
      words += text;
    else if (value.is_number())
      words += simdjson::minify(value);
    else
      return damaged("expected a JSON list of numbers and texts");
  }
  return words;
}

/// Fills items_; a parent stands before its children.
Result<void> GeometryData::parse(std::string_view properties) {
  items_.clear();
  auto code = simdjson::SUCCESS;
  const auto element = parser_->parse(properties, code);
  dom::object root;
  if (code != simdjson::SUCCESS || element.get(root) != simdjson::SUCCESS)
    return damaged("is no JSON object");
  Item& whole = items_.emplace_back();
  if (root["type"].get(whole.type) != simdjson::SUCCESS || whole.type < 1 ||
      whole.type > kStoredMultiSolid)
    return damaged("has no 'type' from 1 to 11");
  if (root["objectId"].get(whole.id) != simdjson::SUCCESS) whole.id = {};

  dom::element children;
  if (root["children"].get(children) != simdjson::SUCCESS || children.is_null()) return {};
  dom::array list;
  if (children.get(list) != simdjson::SUCCESS) return damaged("has 'children' that are no list");
  for (const dom::element entry : list) {
    const std::size_t number = items_.size() - 1;
    Item child;
    dom::object object;
    if (entry.get(object) != simdjson::SUCCESS ||
        object["type"].get(child.type) != simdjson::SUCCESS || child.type < 1 ||
        child.type > kStoredMultiSolid)
      return damaged(fmt::format("child {} has no 'type' from 1 to 11", number));
    if (object["objectId"].get(child.id) != simdjson::SUCCESS) child.id = {};
    dom::element value;
    if (object["parent"].get(value) == simdjson::SUCCESS) {
      std::int64_t parent = -1;
      if (value.get(parent) != simdjson::SUCCESS || parent < 0 ||
          static_cast<std::size_t>(parent) >= number)
        return damaged(fmt::format("child {} has no 'parent' before it", number));
      child.parent = static_cast<std::size_t>(parent) + 1;
    }
    if (!is_collection(items_[child.parent].type))
      return damaged(fmt::format("child {} stands below what has no children", number));
    if (child.type == kStoredPolygon &&
        object["geometryIndex"].get(child.polygon) != simdjson::SUCCESS)
      return damaged(fmt::format("child {} is a polygon without 'geometryIndex'", number));
    items_.push_back(child);
  }
  return {};
}

Result<Tree::NodeId> GeometryData::add(const Row& row, FeatureBuilder::Owner owner,
                                       FeatureBuilder& builder) {
  const auto name_row = [&](const std::string& what) {
    return damaged(fmt::format("geometry_data {}: {}", row.id, what));
  };
  polygons_.clear();
  members_.clear();
  if (row.geometry.empty()) return Tree::kNone;
  if (auto added = add_ewkb(row.geometry, polygons_, &members_); !added)
    return name_row(added.error().message);
  if (row.properties.empty()) {
    items_.assign(1, {.type = row.solid ? kStoredSolid : kStoredMultiSurface});
    if (row.solid && members_.size() > 1) items_.front().type = kStoredMultiSolid;
  } else if (auto parsed = parse(row.properties); !parsed) {
    return name_row("geometry_properties " + parsed.error().message);
  }

  const auto& all = polygons_.polygons;
  Item& root = items_.front();
  if (root.type < kStoredPolygon || all.empty()) return Tree::kNone;
  if (root.type == kStoredPolygon)
    return builder.add_polygon(owner, Tree::kNone, Tree::Role::Member, root.id, polygons_,
                               all.front());
  root.node = builder.add_node(kind_of(root.type), Tree::kNone, Tree::Role::Member, root.id);
  if (items_.size() == 1) return add_nameless(owner, builder);

  for (auto child = items_.begin() + 1; child != items_.end(); ++child) {
    const Item& parent = items_[child->parent];
    const auto role = parent.type == kStoredSolid ? Tree::Role::Exterior : Tree::Role::Member;
    if (is_collection(child->type)) {
      child->node = builder.add_node(kind_of(child->type), parent.node, role, child->id);
    } else if (child->type == kStoredPolygon) {
      if (child->polygon < 0 || static_cast<std::size_t>(child->polygon) >= all.size())
        return name_row(fmt::format("geometry_properties names polygon {} of {} in 'geometryIndex'",
                                    child->polygon, all.size()));
      builder.add_polygon(owner, parent.node, role, child->id, polygons_,
                          all[static_cast<std::size_t>(child->polygon)]);
    }
  }
  return root.node;
}

/// Polygons that nothing is told of: one shell, or one of each member of a collection of solids.
Tree::NodeId GeometryData::add_nameless(FeatureBuilder::Owner owner, FeatureBuilder& builder) {
  const Item& root = items_.front();
  std::size_t next = 0;
  const auto add_polygons = [&](std::size_t count, Tree::NodeId parent) {
    for (const auto end = next + count; next < end; ++next)
      builder.add_polygon(owner, parent, Tree::Role::Member, {}, polygons_,
                          polygons_.polygons[next]);
  };
  const auto add_shell = [&](std::size_t count, Tree::NodeId solid) {
    add_polygons(count,
                 builder.add_node(Tree::Kind::CompositeSurface, solid, Tree::Role::Exterior, {}));
  };
  switch (root.type) {
    case kStoredSolid:
      add_shell(polygons_.polygons.size(), root.node);
      break;
    case kStoredCompositeSolid:
    case kStoredMultiSolid:
      for (const auto count : members_)
        add_shell(count, builder.add_node(Tree::Kind::Solid, root.node, Tree::Role::Member, {}));
      break;
    default:
      add_polygons(polygons_.polygons.size(), root.node);
  }
  return root.node;
}

}  // namespace citymesh::citydb
