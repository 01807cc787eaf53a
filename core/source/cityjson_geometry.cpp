#include "core/source/cityjson_geometry.h"

#include <simdjson.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/citymodel/issue.h"
#include "core/source/json_features.h"
#include "core/source/placement.h"
#include "core/source/positions.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

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
        if (const auto rung = text_member(semantic, "citymesh_rung")) surface.made_by = *rung;
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

}  // namespace

bool add_geometries(const dom::object& city_object, const CityJsonHeader& header,
                    std::string_view srs_name, const std::vector<Point3>& vertices,
                    std::uint64_t max_points, std::size_t object, Feature& feature) {
  GeometryBuilder builder(feature, object, vertices, header.srs, max_points);
  builder.use_templates(header.templates, srs_name);
  builder.add_all(city_object);
  return !builder.too_large();
}

// Each template becomes an object without id; one that is not readable has no shape.
void read_templates(const dom::element& element, const DocumentOptions& options,
                    CityJsonHeader& header) {
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

}  // namespace citymesh::source
