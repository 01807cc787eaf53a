#include <algorithm>
#include <utility>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/citygml_parser.h"
#include "core/source/positions.h"

namespace citymesh::source {

namespace {

bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool is_number_gap(char c) { return is_gap(c) || c == ','; }

std::size_t count_values(std::string_view text) {
  std::size_t count = 0;
  bool inside = false;
  for (const char c : text) {
    const bool gap = is_number_gap(c);
    if (!gap && !inside) ++count;
    inside = !gap;
  }
  return count;
}

}  // namespace

bool CityGmlParser::is_usual(const Separators& separators) {
  return separators.decimal == '.' &&
         (separators.coordinate == ',' || is_gap(separators.coordinate)) &&
         (separators.tuple == ',' || is_gap(separators.tuple));
}

// A gml:coordinates with blanks between tuples, commas between coordinates and decimal points.
std::string CityGmlParser::with_usual_separators(std::string_view text,
                                                 const Separators& separators) {
  std::string usual(text);
  for (char& c : usual) {
    if (c == separators.tuple)
      c = ' ';
    else if (c == separators.coordinate)
      c = ',';
    else if (c == separators.decimal)
      c = '.';
  }
  return usual;
}

// A gml:pos and the first tuple of a gml:coordinates tell by themselves how many coordinates a
// position has, a gml:posList where it counts them; else what is inherited holds. Footprints in two
// dimensions occur in models of three.
unsigned CityGmlParser::dimension_of(std::string_view text, const Frame& frame) const {
  const auto fits = [](std::size_t count) { return count == 2 || count == 3; };
  if (frame.tag == Tag::Tuples) {
    const std::string_view tuples = trimmed(text);
    const std::size_t end = tuples.find_first_of(" \t\r\n");
    if (tuples.substr(0, end).find(',') != std::string_view::npos)
      if (const std::size_t count = count_values(tuples.substr(0, end)); fits(count))
        return static_cast<unsigned>(count);
    return frame.dimension;
  }
  if (frame.tag == Tag::Position) {
    const std::size_t count = count_values(text);
    return fits(count) ? static_cast<unsigned>(count) : frame.dimension;
  }
  if (position_count_ == 0 && !frame.footprint) return frame.dimension;
  const std::size_t values = count_values(text);
  for (const unsigned dimension : {2u, 3u})
    if (position_count_ > 0 && values == dimension * position_count_) return dimension;
  if (frame.footprint && values % 3 != 0 && values % 2 == 0) return 2;
  return frame.dimension;
}

void CityGmlParser::inherit(Frame& frame, const XmlAttributes& attributes) {
  if (!attributes.srs_name.empty()) frame.srs = facts_.intern_srs(attributes.srs_name);
  if (attributes.srs_dimension == "2") frame.dimension = 2;
  if (attributes.srs_dimension == "3") frame.dimension = 3;
}

void CityGmlParser::start_geometry_property(const ElementName& element,
                                            const XmlAttributes& attributes) {
  Frame& frame = push(Ctx::GeometryProperty, element);
  frame.node = GeometryTree::kNone;
  frame.lod = element.lod;
  frame.footprint = element.footprint;
  if (attributes.href.empty()) return;
  const GeometryTree::NodeId node =
      tree_.add_reference(attributes.href, frame.surface_node, GeometryTree::Role::Member);
  tree_.set_lod(node, element.lod);
  tree_.add_root({.node = node,
                  .object = frame.object,
                  .surface = frame.surface,
                  .lod = {element.lod},
                  .footprint = element.footprint,
                  .in_shell = frame.in_shell});
}

bool CityGmlParser::start_geometry(const ElementName& element, const XmlAttributes& attributes) {
  using Kind = GeometryTree::Kind;
  Kind kind = Kind::Surfaces;
  switch (element.tag) {
    case Tag::Polygon:
      kind = Kind::Polygon;
      break;
    case Tag::Solid:
      kind = Kind::Solid;
      break;
    case Tag::CompositeSolid:
      kind = Kind::CompositeSolid;
      break;
    case Tag::MultiSolid:
      kind = Kind::MultiSolid;
      break;
    case Tag::CompositeSurface:
      kind = Kind::CompositeSurface;
      break;
    case Tag::OrientableSurface:
      kind = Kind::Orientable;
      break;
    case Tag::MultiSurface:
      break;
    default:
      return false;
  }

  const Ctx outer = frames_.back().ctx;
  Frame& frame = push(Ctx::Geometry, element);
  inherit(frame, attributes);
  const auto parent = outer == Ctx::GeometryMember     ? frame.node
                      : outer == Ctx::GeometryProperty ? frame.surface_node
                                                       : GeometryTree::kNone;
  frame.node = tree_.add(kind, parent,
                         outer == Ctx::GeometryMember ? frame.role : GeometryTree::Role::Member,
                         attributes.id);
  if (attributes.orientation == "-") tree_.set_reversed(frame.node);
  if (outer == Ctx::GeometryProperty) {
    tree_.set_lod(frame.node, frame.lod);
    tree_.add_root({.node = frame.node,
                    .object = frame.object,
                    .surface = frame.surface,
                    .lod = {frame.lod},
                    .footprint = frame.footprint,
                    .in_shell = frame.in_shell});
  } else if (outer == Ctx::RelativeProperty) {
    implicit_.node = frame.node;
  }
  if (kind == Kind::Polygon) {
    polygon_ = static_cast<std::uint32_t>(feature_.polygons.size());
    exterior_seen_ = false;
    tree_.set_polygon(frame.node, polygon_);
    feature_.polygons.push_back({.gml_id = std::string(attributes.id),
                                 .first_ring = static_cast<std::uint32_t>(feature_.rings.size()),
                                 .object = frame.surface >= 0 ? frame.object : -1,
                                 .surface = frame.surface,
                                 .srs = frame.srs});
  }
  return true;
}

void CityGmlParser::start_geometry_member(const ElementName& element,
                                          const XmlAttributes& attributes) {
  using Role = GeometryTree::Role;
  const bool polygon = frames_.back().tag == Tag::Polygon;
  Role role = Role::Member;
  switch (element.tag) {
    case Tag::Exterior:
      role = Role::Exterior;
      break;
    case Tag::InteriorBoundary:
      role = Role::Interior;
      break;
    case Tag::GeometryMember:
      if (!polygon) break;
      [[fallthrough]];
    default:
      return skip();
  }
  Frame& frame = push(polygon ? Ctx::RingProperty : Ctx::GeometryMember, element);
  frame.role = role;
  if (!polygon && !attributes.href.empty()) tree_.add_reference(attributes.href, frame.node, role);
}

void CityGmlParser::start_in_ring(const ElementName& element, const XmlAttributes& attributes) {
  if (frames_.back().ctx == Ctx::RingProperty) {
    if (element.tag != Tag::Ring) return skip();
    ring_first_point_ = static_cast<std::uint32_t>(feature_.points.size());
    inherit(push(Ctx::Ring, element), attributes);
    return;
  }
  if (element.tag == Tag::Coordinates || element.tag == Tag::Position ||
      element.tag == Tag::Tuples) {
    inherit(push(Ctx::Coordinates, element), attributes);
    const auto first = [](std::string_view text, char usual) {
      return text.empty() ? usual : text.front();
    };
    separators_ = {first(attributes.decimal, '.'), first(attributes.coordinate_separator, ','),
                   first(attributes.tuple_separator, ' ')};
    position_count_ = number_from<std::uint64_t>(attributes.count).value_or(0);
    return xml_.capture();
  }
  if (element.ns != Ns::Gml) return skip();
  inherit(push(Ctx::RingInner, element), attributes);
}

void CityGmlParser::start_in_envelope(const ElementName& element) {
  if (element.tag != Tag::LowerCorner && element.tag != Tag::UpperCorner &&
      element.tag != Tag::Coordinates && element.tag != Tag::Position && element.tag != Tag::Tuples)
    return skip();
  push(Ctx::Corner, element);
  xml_.capture();
}

void CityGmlParser::start_in_implicit(const ElementName& element, const XmlAttributes& attributes) {
  switch (frames_.back().ctx) {
    case Ctx::ImplicitProperty:
      if (element.tag != Tag::Implicit) return skip();
      implicit_ = {};
      push(Ctx::Implicit, element);
      return;
    case Ctx::Implicit:
      if (element.tag == Tag::Matrix) {
        push(Ctx::Matrix, element);
        return xml_.capture();
      }
      if (element.tag == Tag::RelativeGeometry) {
        push(Ctx::RelativeProperty, element).node = GeometryTree::kNone;
        if (!attributes.href.empty())
          implicit_.node =
              tree_.add_reference(attributes.href, GeometryTree::kNone, GeometryTree::Role::Member);
        return;
      }
      if (element.tag != Tag::ReferencePoint) return skip();
      push(Ctx::ReferencePoint, element);
      return;
    default:
      if (element.tag == Tag::Position || element.tag == Tag::Tuples) {
        inherit(push(Ctx::ReferencePosition, element), attributes);
        return xml_.capture();
      }
      if (element.ns != Ns::Gml) return skip();
      inherit(push(Ctx::ReferencePoint, element), attributes);  // gml:Point
  }
}

void CityGmlParser::end_implicit(const Frame& frame) {
  const auto unreadable = [&](const std::string& what) {
    report(issue_code::kUnreadableGeometry, "implicit geometry of LoD " +
                                                std::to_string(frame.lod) + " line " +
                                                std::to_string(xml_.line()) + ": " + what);
  };
  if (implicit_.node == GeometryTree::kNone)
    return unreadable("no relative geometry; library objects are not read");
  if (!implicit_.has_matrix)
    return unreadable("the transformation matrix has no 16 numbers with the last not 0");
  if (!implicit_.has_reference) return unreadable("no reference point of three coordinates");
  tree_.add_root({.node = implicit_.node,
                  .object = frame.object,
                  .surface = frame.surface,
                  .lod = {frame.lod},
                  .footprint = frame.lod == 0,
                  .in_shell = frame.in_shell,
                  .placement = tree_.add_placement(implicit_.placement)});
}

void CityGmlParser::end_ring(const Frame& frame) {
  const auto count = static_cast<std::uint32_t>(feature_.points.size()) - ring_first_point_;
  RawPolygon& polygon = feature_.polygons[polygon_];
  if (count == 0 && polygon.usable) {
    report(issue_code::kUnreadableRing, polygon_place() + ": no coordinates");
    polygon.usable = false;
  }
  feature_.rings.push_back({ring_first_point_, count});
  ++polygon.ring_count;
  if (frame.role != GeometryTree::Role::Exterior || exterior_seen_) return;
  exterior_seen_ = true;
  // The exterior leads, wherever the file puts it.
  std::rotate(feature_.rings.begin() + polygon.first_ring, feature_.rings.end() - 1,
              feature_.rings.end());
}

void CityGmlParser::end_corner(const Frame& frame) {
  const std::string_view text = xml_.end_capture();
  std::vector<Point3> corner;
  const auto dimension = static_cast<unsigned>(
      std::count_if(text.begin(), text.end(), is_gap) >= 2 ? 3 : frame.dimension);
  if (append_positions(text, dimension, corner).state == PositionsState::Ok)
    for (const Point3& point : corner) envelope_.add(point);
}

void CityGmlParser::end_coordinates(const Frame& frame) {
  std::string_view text = xml_.end_capture();
  std::string respelt;
  if (frame.tag == Tag::Tuples && !is_usual(separators_)) {
    respelt = with_usual_separators(text, separators_);
    text = respelt;
  }
  const unsigned dimension = dimension_of(text, frame);
  RawPolygon& polygon = feature_.polygons[polygon_];
  const std::size_t before = feature_.points.size();
  const PositionsResult read = append_positions(text, dimension, feature_.points);
  if (read.state == PositionsState::Ok) {
    // Curve members of a gml:Ring repeat the point at which they meet.
    if (feature_.points.size() > before + 1 && before > ring_first_point_ &&
        feature_.points[before] == feature_.points[before - 1])
      feature_.points.erase(feature_.points.begin() + static_cast<std::ptrdiff_t>(before));
    polygon.srs = frame.srs;
    return;
  }
  polygon.usable = false;
  const std::string token(read.token.substr(0, 60));
  switch (read.state) {
    case PositionsState::NonFinite:
      return report(issue_code::kNonFiniteCoordinate, polygon_place() + ": '" + token + "'");
    case PositionsState::OutOfRange:
      return report(issue_code::kCoordinateOutOfRange, polygon_place() + ": '" + token + "'",
                    read.value);
    case PositionsState::WrongCount:
      return report(issue_code::kUnreadableRing,
                    polygon_place() + ": number of coordinates is no multiple of " +
                        std::to_string(dimension),
                    read.value);
    default:
      return report(issue_code::kUnreadableRing,
                    polygon_place() + ": '" + token + "' is no number");
  }
}

void CityGmlParser::end_polygon() {
  RawPolygon& polygon = feature_.polygons[polygon_];
  if (exterior_seen_ || !polygon.usable) return;
  polygon.usable = false;
  report(issue_code::kUnreadableRing, polygon_place() + ": no exterior ring");
}

void CityGmlParser::end_envelope(const Frame& frame) {
  Frame& owner = frames_[frame.owner];
  owner.srs = frame.srs;
  owner.dimension = frame.dimension;
  if (owner.ctx == Ctx::Model && !envelope_.is_empty() && facts_.declared_extent.is_empty()) {
    facts_.declared_extent = envelope_;
    facts_.declared_srs = frame.srs;
  }
}

std::string CityGmlParser::polygon_place() const {
  const RawPolygon& polygon = feature_.polygons[polygon_];
  return "polygon '" + polygon.gml_id + "' ring " + std::to_string(polygon.ring_count) + " line " +
         std::to_string(xml_.line());
}

}  // namespace citymesh::source
