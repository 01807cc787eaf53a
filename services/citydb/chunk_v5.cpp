#include "services/citydb/chunk_v5.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/citymodel/issue.h"
#include "core/source/citygml_names.h"
#include "core/source/placement.h"
#include "services/citydb/attributes_v5.h"
#include "services/citydb/geometry_data.h"
#include "services/citydb/row_index.h"

namespace citymesh::citydb {
namespace {

using postgres::Rows;
using postgres::Statement;

// How many rows a recursion makes the planner can only guess, and guessing high it would read whole
// tables. OFFSET 0 keeps the subqueries apart: each is a look into an index.

constexpr const char* kHierarchy =
    "WITH RECURSIVE h(parent_id, link_id, name, id, objectclass_id, objectid) AS ("
    "SELECT 0::bigint, f.id, ''::text, f.id, f.objectclass_id, f.objectid"
    " FROM unnest($1::bigint[]) x(id) CROSS JOIN LATERAL (SELECT * FROM feature b"
    " WHERE b.id = x.id AND b.termination_date IS NULL OFFSET 0) f"
    " UNION SELECT h.id, p.id, p.name, f.id, f.objectclass_id, f.objectid FROM h"
    " CROSS JOIN LATERAL (SELECT p.id, p.name, p.val_feature_id FROM property p"
    " WHERE p.feature_id = h.id AND p.val_relation_type = 1 AND p.name IN"
    " ('boundary', 'fillingSurface', 'buildingPart', 'buildingInstallation') OFFSET 0) p"
    " CROSS JOIN LATERAL (SELECT * FROM feature b WHERE b.id = p.val_feature_id"
    " AND b.termination_date IS NULL OFFSET 0) f)"
    " SELECT parent_id, link_id, name, id, objectclass_id, objectid FROM h";
enum HierarchyColumn { kLinkName = 2, kFeatureId, kClass, kGmlId };

constexpr const char* kGeometries =
    "SELECT p.feature_id, p.id, p.name, p.val_lod, p.val_geometry_id, g.geometry,"
    " g.geometry_properties::text, p.val_implicitgeom_id, i.relative_geometry_id,"
    " p.val_implicitgeom_refpoint, p.val_array::text FROM unnest($1::bigint[]) x(id)"
    " CROSS JOIN LATERAL (SELECT * FROM property a WHERE a.feature_id = x.id"
    " AND (a.val_geometry_id IS NOT NULL AND a.name LIKE ANY"
    " ('{lod%Solid,lod%Surface,lod%Geometry,lod%FootPrint,lod%RoofEdge}')"
    " OR a.val_implicitgeom_id IS NOT NULL) OFFSET 0) p"
    " LEFT JOIN LATERAL (SELECT * FROM geometry_data d WHERE d.id = p.val_geometry_id OFFSET 0) g"
    " ON true LEFT JOIN LATERAL (SELECT * FROM implicit_geometry t"
    " WHERE t.id = p.val_implicitgeom_id OFFSET 0) i ON true";
enum GeometryColumn {
  kProperty = 2,
  kLod,
  kGeometryId,
  kGeometry,
  kGeometryProperties,
  kImplicit,
  kTemplateId,
  kAnchor,
  kMatrix
};

constexpr const char* kTemplates =
    "SELECT g.id, 0::bigint, g.implicit_geometry, g.geometry_properties::text"
    " FROM unnest($1::bigint[]) x(id) CROSS JOIN LATERAL (SELECT * FROM geometry_data d"
    " WHERE d.id = x.id OFFSET 0) g";
enum TemplateColumn { kTemplate = 2, kTemplateProperties };

constexpr const char* kOwnColumns =
    "SELECT f.id, 0::bigint, f.identifier,"
    " to_char(f.creation_date AT TIME ZONE 'UTC', 'YYYY-MM-DD'),"
    " to_char(f.valid_from AT TIME ZONE 'UTC', 'YYYY-MM-DD'),"
    " to_char(f.valid_to AT TIME ZONE 'UTC', 'YYYY-MM-DD')"
    " FROM unnest($1::bigint[]) x(id) CROSS JOIN LATERAL (SELECT * FROM feature b"
    " WHERE b.id = x.id OFFSET 0) f";
enum OwnColumn { kIdentifier = 2 };

constexpr const char* kAddresses =
    "SELECT p.feature_id, p.id, a.street, a.house_number, a.po_box, a.zip_code, a.city, a.state,"
    " a.country FROM unnest($1::bigint[]) x(id)"
    " CROSS JOIN LATERAL (SELECT * FROM property q WHERE q.feature_id = x.id"
    " AND q.val_address_id IS NOT NULL OFFSET 0) p"
    " CROSS JOIN LATERAL (SELECT * FROM address d WHERE d.id = p.val_address_id OFFSET 0) a";
enum AddressColumn { kStreet = 2 };

// The order of Tables::rows.
enum Table {
  kOfHierarchy,
  kOfGeometries,
  kOfAttributes,
  kOfOwnColumns,
  kOfAddresses,
  kOfTemplates
};

enum class Link : std::uint8_t { Root, Boundary, Filling, Part, Installation };

Link link_from(std::string_view name) {
  if (name.empty()) return Link::Root;
  if (name == "boundary") return Link::Boundary;
  if (name == "fillingSurface") return Link::Filling;
  return name == "buildingPart" ? Link::Part : Link::Installation;
}

bool is_surface(Link link) { return link == Link::Boundary || link == Link::Filling; }

std::vector<std::int64_t> without_repetitions(std::vector<std::int64_t> ids) {
  std::ranges::sort(ids);
  const auto repeated = std::ranges::unique(ids);
  ids.erase(repeated.begin(), repeated.end());
  return ids;
}

/// Builds the buildings of one chunk.
class Builder {
 public:
  Builder(const Tables& tables, const Instance& instance, FeatureBuilder& builder)
      : rows_(tables.rows),
        instance_(instance),
        builder_(builder),
        links_(rows_[kOfHierarchy]),
        geometries_(rows_[kOfGeometries]),
        attributes_(rows_[kOfAttributes]),
        own_columns_(rows_[kOfOwnColumns]),
        addresses_(rows_[kOfAddresses]),
        templates_(rows_[kOfTemplates]) {
    for (const int row : links_.of(0))
      roots_.emplace(rows_[kOfHierarchy].integer(row, kFeatureId), row);
  }

  /// False when there is no such building.
  Result<bool> build(std::int64_t root) {
    builder_.start();
    seen_.clear();
    const auto found = roots_.find(root);
    if (found == roots_.end()) return false;
    // In the order of a document: what belongs to an object comes with it.
    due_.assign(1, {found->second, {}});
    while (!due_.empty()) {
      const Due due = due_.back();
      due_.pop_back();
      if (auto added = add(due); !added) return added.error();
    }
    return true;
  }

 private:
  /// A row of the hierarchy that waits, and what it belongs to.
  struct Due {
    int row = 0;
    FeatureBuilder::Owner owner{};
  };

  /// Cyclic data, and features that two others have, come more than once.
  Result<void> add(const Due& due) {
    const auto& rows = rows_[kOfHierarchy];
    const auto id = rows.integer(due.row, kFeatureId);
    const auto link = link_from(rows.text(due.row, kLinkName));
    const bool below_surface = due.owner.surface >= 0;
    if (below_surface != (link == Link::Filling) || !seen_.insert(id).second) return {};

    FeatureBuilder::Owner owner = due.owner;
    if (is_surface(link)) {
      const auto known = instance_.classes.find(rows.integer(due.row, kClass));
      if (known == instance_.classes.end()) return {};
      if (!known->second.surface) {
        builder_.leave_out(owner.object, known->second.name);
        return {};
      }
      owner.surface = builder_.add_surface(owner.object, *known->second.surface,
                                           rows.text(due.row, kGmlId), owner.surface);
    } else {
      const auto kind = link == Link::Root   ? ObjectKind::Building
                        : link == Link::Part ? ObjectKind::BuildingPart
                                             : ObjectKind::BuildingInstallation;
      owner.object = builder_.add_object(kind, rows.text(due.row, kGmlId), owner.object);
      add_attributes(id, owner.object);
      add_addresses(id, owner.object);
    }
    for (const int row : geometries_.of(id))
      if (auto added = add_geometry(row, owner); !added) return added;
    const auto children = links_.of(id);
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      due_.push_back({*child, owner});
    return {};
  }

  Result<void> add_geometry(int row, FeatureBuilder::Owner owner) {
    const auto& rows = rows_[kOfGeometries];
    const auto element = source::element_name(source::Ns::Building, rows.text(row, kProperty));
    const auto level = lod_from(rows.text(row, kLod))
                           .value_or(Lod{static_cast<std::int8_t>(std::max<int>(element.lod, 0))});
    if (!rows.null(row, kImplicit)) return add_implicit(row, owner, level);
    if (element.tag != source::Tag::GeometryProperty) return {};
    GeometryData::Row stored{.id = rows.integer(row, kGeometryId),
                             .geometry = rows.text(row, kGeometry),
                             .properties = rows.text(row, kGeometryProperties),
                             .solid = rows.text(row, kProperty).ends_with("Solid")};
    if (stored.geometry.empty()) {
      builder_.report(owner.object, issue_code::kUnreadableGeometry,
                      fmt::format("geometry_data has nothing for id {}", stored.id));
      return {};
    }
    const auto node = data_.add(stored, owner, builder_);
    if (!node) return node.error();
    if (*node != FeatureBuilder::Tree::kNone)
      builder_.add_geometry(owner, *node, level, level.major == 0);
    return {};
  }

  Result<void> add_implicit(int row, FeatureBuilder::Owner owner, Lod level) {
    const auto& rows = rows_[kOfGeometries];
    source::Placement placement;
    const auto reference = point_of_ewkb(rows.text(row, kAnchor));
    auto matrix = std::optional(placement.matrix);
    if (!rows.null(row, kMatrix)) {
      const auto numbers = data_.words(rows.text(row, kMatrix));
      matrix = numbers ? source::matrix_from(*numbers) : std::nullopt;
    }
    auto node = FeatureBuilder::Tree::kNone;
    for (const int found : templates_.of(rows.integer(row, kTemplateId))) {
      const auto& templates = rows_[kOfTemplates];
      const auto added = data_.add({.id = rows.integer(row, kTemplateId),
                                    .geometry = templates.text(found, kTemplate),
                                    .properties = templates.text(found, kTemplateProperties)},
                                   owner, builder_);
      if (!added) return added.error();
      node = *added;
    }
    if (!reference || !matrix || node == FeatureBuilder::Tree::kNone) {
      builder_.report(owner.object, issue_code::kUnreadableGeometry,
                      fmt::format("implicit geometry of LoD {}: no geometry, reference point or "
                                  "transformation of 16 numbers",
                                  to_string(level)));
      return {};
    }
    placement.matrix = *matrix;
    placement.reference = *reference;
    builder_.add_geometry(owner, node, level, level.major == 0, &placement);
    return {};
  }

  void add_attributes(std::int64_t id, std::int32_t index) {
    auto& object = builder_.object(index);
    constexpr std::array<std::string_view, 4> kNames{"identifier", "creationDate", "validFrom",
                                                     "validTo"};
    const auto& own = rows_[kOfOwnColumns];
    for (const int row : own_columns_.of(id))
      for (int i = 0; i < static_cast<int>(kNames.size()); ++i)
        if (const auto text = own.text(row, kIdentifier + i); !text.empty())
          add_attribute(object.attributes, kNames[static_cast<std::size_t>(i)], std::string(text));
    add_attributes_v5(rows_[kOfAttributes], attributes_.of(id), data_, object);
    // Version 5 has one property for installations outside and inside.
    object.inside = object.kind == ObjectKind::BuildingInstallation &&
                    std::ranges::any_of(object.attributes, [](const auto& attribute) {
                      return attribute.first == "relationToConstruction" &&
                             attribute.second == AttributeValue(std::string("inside"));
                    });
  }

  void add_addresses(std::int64_t id, std::int32_t index) {
    constexpr std::array kFields{&Address::street,   &Address::house_number, &Address::po_box,
                                 &Address::zip_code, &Address::city,         &Address::state,
                                 &Address::country};
    for (const int row : addresses_.of(id)) {
      Address address;
      for (std::size_t i = 0; i < kFields.size(); ++i)
        address.*kFields[i] = rows_[kOfAddresses].text(row, kStreet + static_cast<int>(i));
      builder_.object(index).addresses.push_back(std::move(address));
    }
  }

  const std::vector<Rows>& rows_;
  const Instance& instance_;
  FeatureBuilder& builder_;
  RowIndex links_, geometries_, attributes_, own_columns_, addresses_, templates_;
  std::unordered_map<std::int64_t, int> roots_{};  ///< rows by id
  std::unordered_set<std::int64_t> seen_{};        ///< features of the building
  std::vector<Due> due_{};                         ///< the next at the end
  GeometryData data_{};
};

/// `features`, and the objects among them: lists of ids.
std::vector<Statement> about_features(const std::string& features, const std::string& objects) {
  return {{kGeometries, {features}},
          {kAttributesV5, {objects}},
          {kOwnColumns, {objects}},
          {kAddresses, {objects}}};
}

}  // namespace

Result<Tables> fetch_v5(postgres::Connection& connection, std::vector<std::int64_t> ids,
                        const std::stop_token& stop) {
  Tables tables{.ids = std::move(ids)};
  tables.sent.push_back({kHierarchy, {postgres::array_of(tables.ids)}});
  auto hierarchy = connection.run(tables.sent.back(), stop);
  if (!hierarchy) return hierarchy.error();
  std::vector<std::int64_t> features, objects;
  for (int row = 0; row < hierarchy->size(); ++row) {
    const auto id = hierarchy->integer(row, kFeatureId);
    features.push_back(id);
    if (!is_surface(link_from(hierarchy->text(row, kLinkName)))) objects.push_back(id);
  }
  const auto about = about_features(postgres::array_of(without_repetitions(std::move(features))),
                                    postgres::array_of(without_repetitions(std::move(objects))));
  auto rows = connection.run(about, stop);
  if (!rows) return rows.error();

  std::vector<std::int64_t> templates;
  const auto& geometries = rows->front();
  for (int row = 0; row < geometries.size(); ++row)
    if (!geometries.null(row, kTemplateId))
      templates.push_back(geometries.integer(row, kTemplateId));
  tables.sent.insert(tables.sent.end(), about.begin(), about.end());
  tables.sent.push_back(
      {kTemplates, {postgres::array_of(without_repetitions(std::move(templates)))}});
  auto shared = connection.run(tables.sent.back(), stop);
  if (!shared) return shared.error();
  tables.rows = *std::move(rows);
  tables.rows.insert(tables.rows.begin(), *std::move(hierarchy));
  tables.rows.push_back(*std::move(shared));
  return tables;
}

Result<void> build_v5(const Tables& tables, const Instance& instance, FeatureBuilder& builder,
                      const source::FeatureSink& sink) {
  Builder buildings(tables, instance, builder);
  for (const auto id : tables.ids) {
    const auto built = buildings.build(id);
    if (!built) return built.error();
    if (!*built)
      return fail(ErrorCode::DataLoss,
                  fmt::format("feature {} is no present Building any more", id));
    if (auto taken = sink(builder.finish()); !taken) return taken;
  }
  return {};
}

}  // namespace citymesh::citydb
