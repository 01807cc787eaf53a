#include "core/source/cityjson.h"

#include <simdjson.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/citymodel/issue.h"
#include "core/source/json_text.h"
#include "core/source/placement.h"
#include "core/source/positions.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

void note_failure(DocumentFacts& facts, std::string reason) {
  if (facts.failure.empty()) facts.failure = std::move(reason);
}

Error stopped() { return fail(ErrorCode::Cancelled, "reading was stopped"); }

std::optional<std::string_view> text_member(dom::object object, std::string_view key) {
  std::string_view text;
  if (object[key].get(text) != simdjson::SUCCESS) return std::nullopt;
  return text;
}

std::optional<double> finite_number(dom::element element) {
  double value = 0;
  if (element.get(value) != simdjson::SUCCESS || !std::isfinite(value)) return std::nullopt;
  return value;
}

// ---- header ------------------------------------------------------------------------------------

struct Header {
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> translate{0, 0, 0};
  std::uint32_t srs = 0;
  Feature templates{};  ///< an object for each geometry template

  Point3 place(double x, double y, double z) const {
    return {x * scale[0] + translate[0], y * scale[1] + translate[1], z * scale[2] + translate[2]};
  }
};

bool read_three(dom::object transform, std::string_view key, std::array<double, 3>& values) {
  dom::array list;
  if (transform[key].get(list) != simdjson::SUCCESS || list.size() != 3) return false;
  std::size_t i = 0;
  for (const dom::element element : list) {
    const auto value = finite_number(element);
    if (!value) return false;
    values[i++] = *value;
  }
  return true;
}

// Returns what is wrong, or "".
std::string read_type_and_version(std::optional<std::string_view> type,
                                  std::optional<std::string_view> version, bool sequence,
                                  DocumentFacts& facts) {
  facts.not_a_city_model = type != "CityJSON";
  if (facts.not_a_city_model)
    return "member 'type' is '" + std::string(type.value_or("missing")) + "', expected 'CityJSON'";
  if (!version)
    return "member 'version' is missing or no text, expected \"1.0\", \"1.1\" or \"2.0\"";
  const auto known = version->substr(0, 3);
  if (known != "1.0" && known != "1.1" && known != "2.0")
    return "CityJSON version '" + std::string(version->substr(0, 20)) +
           "' is not read, expected 1.0, 1.1 or 2.0";
  facts.format = std::string(sequence ? "CityJSONSeq " : "CityJSON ") + std::string(known);
  return {};
}

std::string read_transform(std::optional<dom::element> element, const DocumentFacts& facts,
                           Header& header) {
  if (!element) {
    if (facts.format == "CityJSON 1.0") return {};
    return "member 'transform' is missing, " + facts.format + " requires it";
  }
  dom::object transform;
  if (element->get(transform) != simdjson::SUCCESS ||
      !read_three(transform, "scale", header.scale) ||
      !read_three(transform, "translate", header.translate))
    return "member 'transform' must have 'scale' and 'translate' with three numbers each";
  return {};
}

void read_metadata(dom::element element, DocumentFacts& facts, Header& header) {
  dom::object metadata;
  if (element.get(metadata) != simdjson::SUCCESS) return;
  dom::object old_crs;
  std::int64_t old_code = 0;
  if (const auto name = text_member(metadata, "referenceSystem"))
    header.srs = facts.intern_srs(*name);
  else if (metadata["crs"].get(old_crs) == simdjson::SUCCESS &&
           old_crs["epsg"].get(old_code) == simdjson::SUCCESS && old_code > 0)
    header.srs = facts.intern_srs("EPSG:" + std::to_string(old_code));
  dom::array extent;
  if (metadata["geographicalExtent"].get(extent) != simdjson::SUCCESS || extent.size() != 6) return;
  std::array<double, 6> values{};
  std::size_t i = 0;
  for (const dom::element value : extent) {
    const auto number = finite_number(value);
    if (!number) return;
    values[i++] = *number;
  }
  facts.declared_extent.add(Point3{values[0], values[1], values[2]});
  facts.declared_extent.add(Point3{values[3], values[4], values[5]});
  facts.declared_srs = header.srs;
}

// ---- one city object ---------------------------------------------------------------------------

std::optional<Lod> lod_of(dom::object geometry) {
  dom::element element;
  if (geometry["lod"].get(element) != simdjson::SUCCESS) return std::nullopt;
  if (element.is_string()) return lod_from(std::string_view(element));
  std::int64_t whole = 0;
  if (element.get(whole) == simdjson::SUCCESS)
    return whole >= 0 && whole <= 9 ? std::optional(Lod{static_cast<std::int8_t>(whole)})
                                    : std::nullopt;
  const auto number = finite_number(element);
  if (!number || *number < 0 || *number >= 10) return std::nullopt;
  const auto tenths = static_cast<int>(std::lround(*number * 10));
  return Lod{static_cast<std::int8_t>(tenths / 10), static_cast<std::int8_t>(tenths % 10)};
}

Attributes attributes_of(dom::object object) {
  Attributes attributes;
  dom::object members;
  if (object["attributes"].get(members) != simdjson::SUCCESS) return attributes;
  for (const auto& [key, value] : members) {
    const std::string name(key);
    switch (value.type()) {
      case dom::element_type::BOOL:
        attributes.emplace_back(name, bool(value));
        break;
      case dom::element_type::INT64:
        attributes.emplace_back(name, std::int64_t(value));
        break;
      case dom::element_type::UINT64:
      case dom::element_type::DOUBLE:
        attributes.emplace_back(name, double(value));
        break;
      case dom::element_type::STRING:
        attributes.emplace_back(name, std::string(std::string_view(value)));
        break;
      case dom::element_type::ARRAY:
      case dom::element_type::OBJECT:
        attributes.emplace_back(name, simdjson::minify(value));
        break;
      case dom::element_type::NULL_VALUE:
        break;
    }
  }
  return attributes;
}

std::string text_of(dom::element value) {
  if (value.is_string()) return std::string(std::string_view(value));
  if (value.is_number()) return simdjson::minify(value);
  return {};
}

// Of an address; the names of CityJSON 1.x and 2.0 and of what programs write, in small letters.
struct AddressName {
  std::string_view name;
  std::string Address::*field;
};
constexpr std::array kAddressNames{
    AddressName{"country", &Address::country},
    AddressName{"countryname", &Address::country},
    AddressName{"administrativearea", &Address::state},
    AddressName{"administrativeareaname", &Address::state},
    AddressName{"state", &Address::state},
    AddressName{"locality", &Address::city},
    AddressName{"localityname", &Address::city},
    AddressName{"city", &Address::city},
    AddressName{"thoroughfarename", &Address::street},
    AddressName{"street", &Address::street},
    AddressName{"thoroughfarenumber", &Address::house_number},
    AddressName{"housenumber", &Address::house_number},
    AddressName{"postalcode", &Address::zip_code},
    AddressName{"postcode", &Address::zip_code},
    AddressName{"zipcode", &Address::zip_code},
    AddressName{"postbox", &Address::po_box},
    AddressName{"pobox", &Address::po_box},
};

void add_address(dom::object object, std::vector<Address>& addresses) {
  Address address;
  for (const auto& [key, value] : object) {
    std::string name;
    for (const char c : key)
      if (c != '_') name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    for (const AddressName& known : kAddressNames)
      if (known.name == name && (address.*known.field).empty())
        address.*known.field = text_of(value);
  }
  if (!(address == Address{})) addresses.push_back(std::move(address));
}

// An object in 1.x, a list of them in 2.0.
std::vector<Address> addresses_of(dom::object city_object) {
  std::vector<Address> addresses;
  dom::element element;
  if (city_object["address"].get(element) != simdjson::SUCCESS) return addresses;
  dom::object object;
  dom::array list;
  if (element.get(object) == simdjson::SUCCESS) {
    add_address(object, addresses);
  } else if (element.get(list) == simdjson::SUCCESS) {
    for (const dom::element entry : list)
      if (entry.get(object) == simdjson::SUCCESS) add_address(object, addresses);
  }
  return addresses;
}

/// Appends the geometries of one city object to a feature.
class GeometryBuilder {
 public:
  GeometryBuilder(Feature& feature, std::size_t object, const std::vector<Point3>& vertices,
                  std::uint32_t srs, std::uint64_t max_points)
      : feature_(feature),
        object_(feature.objects[object]),
        object_index_(static_cast<std::int32_t>(object)),
        vertices_(vertices),
        srs_(srs),
        max_points_(max_points) {}

  void use_templates(const Feature& templates, std::string_view srs_name) {
    templates_ = &templates;
    srs_name_ = srs_name;
  }

  void add_one(dom::object geometry) {
    place_ = "template";
    add(geometry);
  }

  void add_all(dom::object city_object) {
    dom::element element;
    if (city_object["geometry"].get(element) != simdjson::SUCCESS) return;
    dom::array geometries;
    if (element.get(geometries) != simdjson::SUCCESS)
      return unreadable("member 'geometry' is no list");
    for (const dom::element geometry : geometries) {
      place_ = "geometry " + std::to_string(number_++);
      dom::object object;
      if (geometry.get(object) != simdjson::SUCCESS) {
        unreadable("no JSON object");
        continue;
      }
      add(object);
    }
  }
  bool too_large() const { return too_large_; }

 private:
  void report(int code, const std::string& what, double measured = 0) {
    constexpr std::size_t kMaxIssues = 1000;
    if (object_.issues.size() < kMaxIssues)
      object_.issues.push_back({code, place_ + ": " + what, measured});
  }
  void unreadable(const std::string& what) { report(issue_code::kUnreadableGeometry, what); }

  void add(dom::object geometry) {
    const auto type = text_member(geometry, "type");
    if (!type) return unreadable("member 'type' is missing or no text");
    if (*type == "MultiPoint" || *type == "MultiLineString") return;  // no surfaces
    if (*type == "GeometryInstance") return add_instance(geometry);
    RawShape shape;
    int nesting = 0;  // lists between boundaries and surfaces
    if (*type == "MultiSurface") {
      shape.type = GeometryType::MultiSurface;
    } else if (*type == "CompositeSurface") {
      shape.type = GeometryType::CompositeSurface;
    } else if (*type == "Solid") {
      shape.type = GeometryType::Solid;
      nesting = 1;
    } else if (*type == "MultiSolid" || *type == "CompositeSolid") {
      shape.type = *type == "MultiSolid" ? GeometryType::MultiSolid : GeometryType::CompositeSolid;
      nesting = 2;
    } else {
      return unreadable("geometry type '" + std::string(type->substr(0, 60)) + "' is not read");
    }
    const auto lod = lod_of(geometry);
    if (!lod) return unreadable("member 'lod' is missing or no level of detail");
    shape.lod = *lod;
    shape.footprint = lod->major == 0;

    dom::array boundaries;
    if (geometry["boundaries"].get(boundaries) != simdjson::SUCCESS)
      return unreadable("member 'boundaries' is missing or no list");
    std::optional<dom::element> values;
    read_semantics(geometry, values);

    const std::size_t polygons_before = feature_.polygons.size();
    bool readable = true;
    if (nesting == 0) {
      readable = add_surfaces(boundaries, values, shape.uses);
    } else if (nesting == 1) {
      readable = add_solid(boundaries, values, shape);
    } else {
      ParallelValues solids_values(values);
      for (const dom::element solid : boundaries) {
        dom::array shells;
        readable = readable && solid.get(shells) == simdjson::SUCCESS &&
                   add_solid(shells, solids_values.next(), shape);
      }
    }
    if (!readable) {
      feature_.polygons.resize(polygons_before);
      return unreadable("'boundaries' are not nested as " + std::string(*type) + " requires");
    }
    if (!shape.uses.empty()) object_.shapes.push_back(std::move(shape));
  }

  void add_instance(dom::object geometry) {
    std::uint64_t number = 0;
    if (geometry["template"].get(number) != simdjson::SUCCESS || !templates_ ||
        number >= templates_->objects.size())
      return unreadable("member 'template' names none of the geometry templates");
    const RawObject& model = templates_->objects[static_cast<std::size_t>(number)];
    if (model.shapes.empty())
      return unreadable("geometry template " + std::to_string(number) + " is not readable");
    Placement placement{.srs = srs_};
    dom::array anchors, matrix;
    std::uint64_t anchor = 0;
    if (geometry["boundaries"].get(anchors) != simdjson::SUCCESS || anchors.size() != 1 ||
        anchors.at(0).get(anchor) != simdjson::SUCCESS || anchor >= vertices_.size())
      return unreadable("'boundaries' of an instance must be the number of one vertex");
    placement.reference = vertices_[static_cast<std::size_t>(anchor)];
    if (geometry["transformationMatrix"].get(matrix) != simdjson::SUCCESS || matrix.size() != 16)
      return unreadable("'transformationMatrix' must have 16 numbers");
    std::size_t at = 0;
    for (const dom::element value : matrix) {
      const auto entry = finite_number(value);
      if (!entry) return unreadable("'transformationMatrix' must have 16 numbers");
      placement.matrix[at++] = *entry;
    }
    if (placement.matrix[15] == 0)
      return unreadable("the last number of 'transformationMatrix' is 0");

    const auto first = static_cast<std::int32_t>(object_.surfaces.size());
    for (Surface surface : model.surfaces) {
      if (surface.parent >= 0) surface.parent += first;
      object_.surfaces.push_back(std::move(surface));
    }
    const Placer placer(placement, srs_name_);
    for (const RawShape& template_shape : model.shapes) {
      RawShape shape = template_shape;
      for (PolygonUse& use : shape.uses) {
        use = placer.copy(*templates_, use, feature_);
        RawPolygon& polygon = feature_.polygons[use.polygon];
        polygon.object = object_index_;
        if (polygon.surface >= 0) polygon.surface += first;
        if (feature_.points.size() > max_points_) too_large_ = true;
        if (too_large_) return;
      }
      object_.shapes.push_back(std::move(shape));
    }
  }

  /// The semantic values that stand beside a list of boundaries; missing ones are none.
  struct ParallelValues {
    explicit ParallelValues(const std::optional<dom::element>& list) {
      if (list && list->get(values) == simdjson::SUCCESS) {
        at = values.begin();
        any = true;
      }
    }
    std::optional<dom::element> next() {
      if (!any || !(at != values.end())) return std::nullopt;
      const dom::element value = *at;
      ++at;
      return value;
    }
    dom::array values{};
    dom::array::iterator at{};
    bool any = false;
  };

  void read_semantics(dom::object geometry, std::optional<dom::element>& values) {
    first_surface_ = object_.surfaces.size();
    dom::object semantics;
    dom::array surfaces;
    if (geometry["semantics"].get(semantics) != simdjson::SUCCESS ||
        semantics["surfaces"].get(surfaces) != simdjson::SUCCESS)
      return;
    for (const dom::element element : surfaces) {
      Surface surface;
      dom::object semantic;
      if (element.get(semantic) == simdjson::SUCCESS) {
        if (const auto type = text_member(semantic, "type"))
          surface.type = surface_type_from(*type).value_or(SurfaceType::Unknown);
        if (const auto id = text_member(semantic, "id")) surface.gml_id = *id;
        std::uint64_t parent = 0;
        if (semantic["parent"].get(parent) == simdjson::SUCCESS && parent < surfaces.size())
          surface.parent = static_cast<std::int32_t>(first_surface_ + parent);
      }
      object_.surfaces.push_back(std::move(surface));
    }
    // Openings may be named by their wall only.
    std::size_t wall = first_surface_;
    for (const dom::element element : surfaces) {
      dom::object semantic;
      dom::array children;
      if (element.get(semantic) == simdjson::SUCCESS &&
          semantic["children"].get(children) == simdjson::SUCCESS)
        for (const dom::element child : children) {
          std::uint64_t index = 0;
          if (child.get(index) != simdjson::SUCCESS || index >= surfaces.size()) continue;
          Surface& opening = object_.surfaces[first_surface_ + static_cast<std::size_t>(index)];
          if (opening.parent < 0) opening.parent = static_cast<std::int32_t>(wall);
        }
      ++wall;
    }
    dom::element list;
    if (semantics["values"].get(list) == simdjson::SUCCESS) values = list;
  }

  bool add_solid(dom::array shells, const std::optional<dom::element>& values, RawShape& shape) {
    Solid solid;
    ParallelValues shell_values(values);
    bool first = true;
    for (const dom::element shell : shells) {
      dom::array surfaces;
      if (shell.get(surfaces) != simdjson::SUCCESS) return false;
      const std::size_t before = shape.uses.size();
      if (!add_surfaces(surfaces, shell_values.next(), shape.uses)) return false;
      std::vector<std::uint32_t> indices;
      for (std::size_t i = before; i < shape.uses.size(); ++i)
        indices.push_back(static_cast<std::uint32_t>(i));
      if (std::exchange(first, false))
        solid.exterior = std::move(indices);
      else
        solid.interiors.push_back(std::move(indices));
    }
    shape.solids.push_back(std::move(solid));
    return true;
  }

  bool add_surfaces(dom::array surfaces, const std::optional<dom::element>& values,
                    std::vector<PolygonUse>& uses) {
    ParallelValues semantic_values(values);
    for (const dom::element surface : surfaces) {
      const auto semantic = semantic_values.next();
      dom::array rings;
      if (surface.get(rings) != simdjson::SUCCESS) return false;
      RawPolygon polygon{.first_ring = static_cast<std::uint32_t>(feature_.rings.size()),
                         .object = object_index_,
                         .srs = srs_};
      std::uint64_t index = 0;
      if (semantic && semantic->get(index) == simdjson::SUCCESS &&
          index < object_.surfaces.size() - first_surface_)
        polygon.surface = static_cast<std::int32_t>(first_surface_ + index);
      if (!add_rings(rings, polygon)) return false;
      if (too_large_) return true;
      if (polygon.usable)
        uses.push_back({static_cast<std::uint32_t>(feature_.polygons.size()), false});
      feature_.polygons.push_back(std::move(polygon));
    }
    return true;
  }

  bool add_rings(dom::array rings, RawPolygon& polygon) {
    const auto unusable = [&](int code, const std::string& what, double measured) {
      polygon.usable = false;
      report(code,
             "polygon " + std::to_string(feature_.polygons.size()) + " ring " +
                 std::to_string(polygon.ring_count) + ": " + what,
             measured);
    };
    for (const dom::element ring : rings) {
      dom::array indices;
      if (ring.get(indices) != simdjson::SUCCESS) return false;
      RawRing raw{static_cast<std::uint32_t>(feature_.points.size()), 0};
      for (const dom::element element : indices) {
        std::int64_t index = 0;
        if (element.get(index) != simdjson::SUCCESS) return false;
        if (!polygon.usable) continue;
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_.size()) {
          unusable(issue_code::kVertexIndexOutOfRange,
                   "vertex " + std::to_string(index) + " of " + std::to_string(vertices_.size()),
                   static_cast<double>(index));
          continue;
        }
        const Point3& point = vertices_[static_cast<std::size_t>(index)];
        const double largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
        if (!(largest <= kMaxCoordinate)) {
          unusable(issue_code::kCoordinateOutOfRange, "vertex " + std::to_string(index), largest);
          continue;
        }
        feature_.points.push_back(point);
        ++raw.count;
      }
      if (feature_.points.size() > max_points_) too_large_ = true;
      if (raw.count == 0 && polygon.usable)
        unusable(issue_code::kUnreadableRing, "no coordinates", 0);
      feature_.rings.push_back(raw);
      ++polygon.ring_count;
    }
    if (polygon.ring_count == 0) unusable(issue_code::kUnreadableRing, "no exterior ring", 0);
    return true;
  }

  Feature& feature_;
  RawObject& object_;
  std::int32_t object_index_;
  const std::vector<Point3>& vertices_;
  std::uint32_t srs_;
  std::uint64_t max_points_;
  const Feature* templates_ = nullptr;
  std::string_view srs_name_{};
  std::string place_{"object"};
  std::size_t number_ = 0;
  std::size_t first_surface_ = 0;
  bool too_large_ = false;
};

// Each template becomes an object without id; one that is not readable has no shape.
void read_templates(dom::element element, const DocumentOptions& options, Header& header) {
  dom::object root;
  dom::array templates, list;
  if (element.get(root) != simdjson::SUCCESS ||
      root["templates"].get(templates) != simdjson::SUCCESS ||
      root["vertices-templates"].get(list) != simdjson::SUCCESS)
    return;
  std::vector<Point3> vertices;
  for (const dom::element vertex : list) {
    dom::array triple;
    std::array<double, 3> values{};
    std::size_t i = 0;
    if (vertex.get(triple) == simdjson::SUCCESS && triple.size() == 3)
      for (const dom::element value : triple) values[i++] = finite_number(value).value_or(HUGE_VAL);
    if (i != 3) values.fill(HUGE_VAL);  // what uses it becomes an issue
    vertices.push_back({values[0], values[1], values[2]});
  }
  for (const dom::element geometry : templates) {
    header.templates.objects.emplace_back();
    dom::object object;
    if (geometry.get(object) != simdjson::SUCCESS) continue;
    GeometryBuilder builder(header.templates, header.templates.objects.size() - 1, vertices,
                            header.srs, options.limits.max_points_per_building);
    builder.add_one(object);
    if (builder.too_large()) return;
  }
}

// ---- the tree of city objects ------------------------------------------------------------------

enum class ObjectType : std::uint8_t { Building, Part, Installation, Extension, Other };

ObjectType kind_of(dom::object object) {
  const auto type = text_member(object, "type").value_or("");
  if (type == "Building") return ObjectType::Building;
  if (type == "BuildingPart") return ObjectType::Part;
  if (type == "BuildingInstallation") return ObjectType::Installation;
  if (!type.empty() && type.front() == '+') return ObjectType::Extension;
  return ObjectType::Other;
}

/// Ids, kinds and who is part of whom.
struct ObjectTree {
  struct Entry {
    std::string id{};
    ObjectType kind = ObjectType::Other;
    std::string extension{};  ///< type of an extension
    std::vector<std::uint32_t> children{};
    bool delivered = false;
  };
  std::vector<Entry> entries{};
  TextMap<std::uint32_t> by_id{};
  std::vector<std::pair<std::uint32_t, std::string>> parents{};   // child, id of its parent
  std::vector<std::pair<std::uint32_t, std::string>> children{};  // parent, id of its child

  void add(std::string id, std::optional<dom::object> object) {
    const auto index = static_cast<std::uint32_t>(entries.size());
    by_id.try_emplace(id, index);
    entries.push_back({.id = std::move(id)});
    if (!object) return;
    entries.back().kind = kind_of(*object);
    if (entries.back().kind == ObjectType::Extension)
      entries.back().extension = text_member(*object, "type").value_or("");
    if (entries.back().kind == ObjectType::Other) return;
    keep_ids(*object, "parents", index, parents);
    keep_ids(*object, "children", index, children);
  }

  /// Joins both directions: files often state only one. Children in their parents' order.
  void link() {
    for (const auto& [parent, id] : children) join(parent, id, false);
    for (const auto& [child, id] : parents) join(child, id, true);
    parents = {};
    children = {};
  }

 private:
  static void keep_ids(dom::object object, std::string_view key, std::uint32_t index,
                       std::vector<std::pair<std::uint32_t, std::string>>& pairs) {
    dom::array ids;
    if (object[key].get(ids) != simdjson::SUCCESS) return;
    for (const dom::element element : ids)
      if (element.is_string()) pairs.emplace_back(index, std::string_view(element));
  }
  void join(std::uint32_t from, const std::string& id, bool upwards) {
    const auto found = by_id.find(id);
    if (found == by_id.end()) return;
    const std::uint32_t parent = upwards ? found->second : from;
    const std::uint32_t child = upwards ? from : found->second;
    const ObjectType kind = entries[child].kind;
    if (kind != ObjectType::Part && kind != ObjectType::Installation) return;
    if (!linked_.insert({parent, child}).second) return;
    entries[parent].children.push_back(child);
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> linked_{};
};

/// Gives the JSON of an entry; what it returns lives until the next call.
using LoadObject = std::function<std::optional<dom::object>(std::uint32_t)>;

struct Delivery {
  const DocumentOptions& options;
  DocumentFacts& facts;
  const FeatureSink& sink;
  const Header& header;
  Feature feature{};
  std::uint64_t ordinal = 0;
  ByteRange bytes{};  ///< of the features that are delivered

  Result<void> deliver_all(ObjectTree& tree, const std::vector<Point3>& vertices,
                           const LoadObject& load) {
    for (const ObjectTree::Entry& entry : tree.entries)
      if (entry.kind == ObjectType::Extension) {
        ++facts.skipped_objects;
        facts.count_skipped(entry.extension);
      }
    for (const ObjectType kind : {ObjectType::Building, ObjectType::Part})
      for (std::uint32_t i = 0; i < tree.entries.size(); ++i) {
        if (tree.entries[i].kind != kind || tree.entries[i].delivered) continue;
        if (options.stop.stop_requested()) return stopped();
        if (auto taken = deliver(tree, i, vertices, load); !taken) return taken;
      }
    for (const ObjectTree::Entry& entry : tree.entries)
      if (entry.kind == ObjectType::Installation && !entry.delivered) {
        ++facts.skipped_objects;
        facts.count_skipped("BuildingInstallation without a building");
      }
    return {};
  }

 private:
  Result<void> deliver(ObjectTree& tree, std::uint32_t root, const std::vector<Point3>& vertices,
                       const LoadObject& load) {
    feature.clear();
    feature.srs = header.srs;
    feature.bytes = bytes;
    ++ordinal;
    bool too_large = false;
    struct Due {
      std::uint32_t entry;
      std::int32_t parent;
    };
    std::vector<Due> due{{root, -1}};
    while (!due.empty()) {
      const Due next = due.back();
      due.pop_back();
      ObjectTree::Entry& entry = tree.entries[next.entry];
      if (std::exchange(entry.delivered, true)) continue;  // a part belongs to its first parent
      const auto object = load(next.entry);
      const std::size_t index = feature.objects.size();
      RawObject& raw = feature.objects.emplace_back();
      raw.gml_id = entry.id;
      raw.parent = next.parent;
      if (raw.gml_id.empty())
        raw.gml_id = index == 0 ? numbered_id(options.stem, options.buildings_before + ordinal)
                                : numbered_id(feature.objects.front().gml_id, index);
      raw.kind = entry.kind == ObjectType::Building ? ObjectKind::Building
                 : entry.kind == ObjectType::Part   ? ObjectKind::BuildingPart
                                                    : ObjectKind::BuildingInstallation;
      for (auto child = entry.children.rbegin(); child != entry.children.rend(); ++child)
        due.push_back({*child, static_cast<std::int32_t>(index)});
      if (!object) {
        raw.issues.push_back({issue_code::kUnreadableGeometry, "the object is not readable JSON"});
        continue;
      }
      raw.attributes = attributes_of(*object);
      raw.addresses = addresses_of(*object);
      GeometryBuilder builder(feature, index, vertices, header.srs,
                              options.limits.max_points_per_building);
      builder.use_templates(header.templates, facts.srs_names[header.srs]);
      builder.add_all(*object);
      too_large = too_large || builder.too_large();
    }
    if (too_large) {
      for (RawObject& object : feature.objects) object.shapes.clear();
      feature.objects.front().issues.push_back(
          {issue_code::kReadLimitExceeded,
           "more than max_points_per_building = " +
               std::to_string(options.limits.max_points_per_building) + " points"});
    }
    return sink(feature);
  }
};

std::string json_error(simdjson::error_code code) { return simdjson::error_message(code); }

// The name between quotes, escapes resolved.
std::string unescaped(const std::string& raw, dom::parser& parser) {
  if (raw.find('\\') == std::string::npos) return raw;
  std::string_view text;
  if (parser.parse(simdjson::padded_string('"' + raw + '"')).get(text) != simdjson::SUCCESS)
    return raw;
  return std::string(text);
}

}  // namespace

Result<void> read_cityjson(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "CityJSON";
  const unsigned depth = options.limits.max_depth;
  const JsonText json(file, depth);
  dom::parser parser;
  if (parser.allocate(1u << 16, depth) != simdjson::SUCCESS)
    return fail(ErrorCode::ResourceExhausted, "no memory for a JSON parser");

  std::vector<JsonMember> members;
  if (auto split = json.members(json.all(), members); !split) {
    note_failure(facts, split.error().message);
    return {};
  }
  const auto slice_of = [&](std::string_view key) -> const JsonSlice* {
    for (const JsonMember& member : members)
      if (member.raw_key == key) return &member.value;
    return nullptr;
  };
  // Parses a slice; the element lives until the next call.
  simdjson::padded_string padded;
  const auto parse = [&](const JsonSlice& slice, const std::string& what) {
    std::optional<dom::element> parsed;
    auto text = json.text(slice, options.limits.max_building_bytes);
    if (!text) {
      note_failure(facts, text.error().message);
      return parsed;
    }
    padded = simdjson::padded_string(*text);
    dom::element element;
    if (const auto code = parser.parse(padded).get(element); code != simdjson::SUCCESS)
      note_failure(facts,
                   "line " + std::to_string(slice.line) + ": " + what + ": " + json_error(code));
    else
      parsed = element;
    return parsed;
  };
  const auto text_of = [&](std::string_view key) {
    std::optional<std::string> text;
    const JsonSlice* slice = slice_of(key);
    if (!slice) return text;
    const auto element = parse(*slice, "member '" + std::string(key) + "'");
    std::string_view view;
    if (element && element->get(view) == simdjson::SUCCESS) text = view;
    return text;
  };

  Header header;
  const auto type = text_of("type");
  const auto version = text_of("version");
  std::string wrong = read_type_and_version(type, version, false, facts);
  if (wrong.empty()) {
    std::optional<dom::element> transform;
    if (const JsonSlice* slice = slice_of("transform")) transform = parse(*slice, "'transform'");
    wrong = read_transform(transform, facts, header);
  }
  if (!wrong.empty()) {
    note_failure(facts, std::move(wrong));
    return {};
  }
  if (const JsonSlice* slice = slice_of("metadata"))
    if (const auto metadata = parse(*slice, "'metadata'")) read_metadata(*metadata, facts, header);

  if (const JsonSlice* slice = slice_of("geometry-templates"))
    if (const auto templates = parse(*slice, "'geometry-templates'"))
      read_templates(*templates, options, header);

  const JsonSlice* vertices_slice = slice_of("vertices");
  const JsonSlice* objects_slice = slice_of("CityObjects");
  if (!vertices_slice || !objects_slice) {
    note_failure(facts, std::string("member '") + (vertices_slice ? "CityObjects" : "vertices") +
                            "' is missing");
    return {};
  }
  std::vector<Point3> vertices;
  constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();
  if (auto read = json.triples(*vertices_slice, kMaxVertices, vertices); !read) {
    note_failure(facts, "member 'vertices': " + read.error().message);
    return {};
  }
  for (Point3& vertex : vertices) vertex = header.place(vertex.x, vertex.y, vertex.z);

  std::vector<JsonMember> objects;
  if (auto split = json.members(*objects_slice, objects); !split)
    note_failure(facts, "member 'CityObjects': " + split.error().message);
  const auto load = [&](std::uint32_t i) {
    std::optional<dom::object> object;
    const auto element = parse(objects[i].value, "city object '" + objects[i].raw_key + "'");
    dom::object found;
    if (element && element->get(found) == simdjson::SUCCESS)
      object = found;
    else if (element)
      note_failure(facts, "line " + std::to_string(objects[i].value.line) + ": city object '" +
                              objects[i].raw_key + "' is no JSON object");
    return object;
  };
  ObjectTree tree;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (options.stop.stop_requested()) return stopped();
    std::string id = unescaped(objects[i].raw_key, parser);
    tree.add(std::move(id), load(i));
  }
  tree.link();
  return Delivery{options, facts, sink, header}.deliver_all(tree, vertices, load);
}

namespace {

/// Lines of a stream; the last one may lack its end.
class Lines {
 public:
  Lines(ByteReader& bytes, std::uint64_t max_bytes) : bytes_(bytes), max_bytes_(max_bytes) {}

  /// false at the end. Errors: as ByteReader, ResourceExhausted for a line that is too long.
  Result<bool> next(std::string& line) {
    line.clear();
    ++number_;
    begin_ = end_;
    for (;;) {
      if (at_ == filled_) {
        buffer_.resize(1u << 16);
        const auto count = bytes_.read(buffer_.data(), buffer_.size());
        if (!count) return count.error();
        at_ = 0;
        filled_ = *count;
        if (filled_ == 0) return !line.empty();
      }
      const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(at_);
      const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(filled_);
      const auto found = std::find(begin, end, '\n');
      line.append(begin, found);
      if (line.size() > max_bytes_)
        return fail(ErrorCode::ResourceExhausted, "line " + std::to_string(number_) +
                                                      " has more than max_building_bytes = " +
                                                      std::to_string(max_bytes_) + " bytes");
      at_ += static_cast<std::size_t>(found - begin);
      end_ += static_cast<std::uint64_t>(found - begin);
      if (found == end) continue;
      ++at_;
      ++end_;
      return true;
    }
  }
  std::uint64_t number() const { return number_; }
  ByteRange bytes() const { return {begin_, end_}; }

 private:
  ByteReader& bytes_;
  std::uint64_t max_bytes_;
  std::vector<char> buffer_{};
  std::size_t at_ = 0, filled_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t begin_ = 0, end_ = 0;
};

bool blank(const std::string& line) {
  return line.find_first_not_of(" \t\r\n") == std::string::npos;
}

bool read_vertices(dom::object feature, const Header& header, std::vector<Point3>& vertices) {
  vertices.clear();
  dom::array list;
  if (feature["vertices"].get(list) != simdjson::SUCCESS) return false;
  for (const dom::element element : list) {
    dom::array triple;
    if (element.get(triple) != simdjson::SUCCESS) return false;
    std::array<double, 3> values{};
    std::size_t i = 0;
    for (const dom::element value : triple)
      if (i == 3 || value.get(values[i++]) != simdjson::SUCCESS) return false;
    if (i != 3) return false;
    vertices.push_back(header.place(values[0], values[1], values[2]));
  }
  return true;
}

}  // namespace

Result<void> read_cityjson_seq(ByteReader& bytes, const DocumentOptions& options,
                               DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "CityJSONSeq";
  dom::parser parser;
  if (parser.allocate(1u << 16, options.limits.max_depth) != simdjson::SUCCESS)
    return fail(ErrorCode::ResourceExhausted, "no memory for a JSON parser");
  Lines lines(bytes, options.limits.max_building_bytes);
  std::string line;
  simdjson::padded_string padded;
  const auto at_line = [&](const std::string& reason) {
    note_failure(facts, "line " + std::to_string(lines.number()) + ": " + reason);
  };

  Header header;
  Delivery delivery{options, facts, sink, header};
  std::vector<Point3> vertices;
  bool header_read = false;
  for (;;) {
    if (options.stop.stop_requested()) return stopped();
    const auto more = lines.next(line);
    if (!more) {
      note_failure(facts, more.error().message);
      return {};
    }
    if (!*more) break;
    if (!header_read && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);
    if (blank(line)) continue;
    padded = simdjson::padded_string(line);
    dom::object object;
    if (const auto code = parser.parse(padded).get(object); code != simdjson::SUCCESS) {
      at_line(json_error(code));
      if (!header_read) return {};
      continue;  // the lines are independent of each other
    }

    if (!header_read) {
      header_read = true;
      std::string wrong = read_type_and_version(text_member(object, "type"),
                                                text_member(object, "version"), true, facts);
      if (wrong.empty()) {
        std::optional<dom::element> transform;
        dom::element element;
        if (object["transform"].get(element) == simdjson::SUCCESS) transform = element;
        wrong = read_transform(transform, facts, header);
      }
      if (!wrong.empty()) {
        at_line(wrong);
        return {};
      }
      if (dom::element metadata; object["metadata"].get(metadata) == simdjson::SUCCESS)
        read_metadata(metadata, facts, header);
      if (dom::element templates; object["geometry-templates"].get(templates) == simdjson::SUCCESS)
        read_templates(templates, options, header);
      if (!options.piece) facts.envelopes.push_back({.before = line + "\n"});
      continue;
    }

    if (text_member(object, "type") != "CityJSONFeature") {
      at_line("member 'type' is not 'CityJSONFeature'");
      continue;
    }
    dom::object city_objects;
    if (object["CityObjects"].get(city_objects) != simdjson::SUCCESS) {
      at_line("member 'CityObjects' is missing or no JSON object");
      continue;
    }
    if (!read_vertices(object, header, vertices)) {
      at_line("member 'vertices' is no list of three numbers each");
      continue;
    }
    if (!options.piece) delivery.bytes = lines.bytes();
    ObjectTree tree;
    std::vector<std::optional<dom::object>> loaded;
    for (const auto& [key, value] : city_objects) {
      dom::object city_object;
      loaded.emplace_back();
      if (value.get(city_object) == simdjson::SUCCESS)
        loaded.back() = city_object;
      else
        at_line("city object '" + std::string(key) + "' is no JSON object");
      tree.add(std::string(key), loaded.back());
    }
    tree.link();
    if (auto taken =
            delivery.deliver_all(tree, vertices, [&](std::uint32_t i) { return loaded[i]; });
        !taken)
      return taken;
  }
  if (!header_read) note_failure(facts, "the file is empty, expected a CityJSON object in line 1");
  return {};
}

}  // namespace citymesh::source
