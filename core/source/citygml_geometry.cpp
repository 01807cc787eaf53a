#include <algorithm>
#include <utility>

#include "core/citymodel/issue.h"
#include "core/source/citygml_parser.h"
#include "core/source/positions.h"

namespace citymesh::source {

namespace {

bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

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
  tree_.add_root({.node = tree_.add_root_reference(attributes.href),
                  .object = frame.object,
                  .surface = frame.surface,
                  .lod = {element.lod},
                  .footprint = element.footprint});
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
  const auto parent = outer == Ctx::GeometryMember ? frame.node : GeometryTree::kNone;
  frame.node = tree_.add(kind, parent,
                         outer == Ctx::GeometryMember ? frame.role : GeometryTree::Role::Member,
                         attributes.id);
  if (attributes.orientation == "-") tree_.set_reversed(frame.node);
  if (outer == Ctx::GeometryProperty)
    tree_.add_root({.node = frame.node,
                    .object = frame.object,
                    .surface = frame.surface,
                    .lod = {frame.lod},
                    .footprint = frame.footprint});
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
  if (element.tag == Tag::Coordinates) {
    inherit(push(Ctx::Coordinates, element), attributes);
    return xml_.capture();
  }
  if (element.ns != Ns::Gml) return skip();
  inherit(push(Ctx::RingInner, element), attributes);
}

void CityGmlParser::start_in_envelope(const ElementName& element) {
  if (element.tag != Tag::LowerCorner && element.tag != Tag::UpperCorner &&
      element.tag != Tag::Coordinates)
    return skip();
  push(Ctx::Corner, element);
  xml_.capture();
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
  const std::string_view text = xml_.end_capture();
  RawPolygon& polygon = feature_.polygons[polygon_];
  const std::size_t before = feature_.points.size();
  const PositionsResult read = append_positions(text, frame.dimension, feature_.points);
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
                        std::to_string(frame.dimension),
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
