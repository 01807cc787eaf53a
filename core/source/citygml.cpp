#include "core/source/citygml.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/citygml_parser.h"
#include "core/source/positions.h"

namespace citymesh::source {

const ElementName& CityGmlParser::meaning(const XmlName& name) {
  const auto [entry, is_new] = names_.try_emplace(NameKey{name.local.data(), name.uri.data()});
  if (is_new) {
    const NsMeaning ns =
        namespaces_.try_emplace(name.uri.data(), namespace_of(name.uri)).first->second;
    entry->second = element_name(ns.ns, name.local);
  }
  return entry->second;
}

Frame& CityGmlParser::push(Ctx ctx, const ElementName& element) {
  if (ctx == Ctx::Model || ctx == Ctx::Member) ancestors_.emplace_back(xml_.start_tag());
  Frame frame = frames_.back();
  frame.ctx = ctx;
  frame.tag = element.tag;
  frame.complex = false;
  return frames_.emplace_back(frame);
}

void CityGmlParser::on_start(const XmlName& name, const XmlAttributes& attributes) {
  const ElementName& element = meaning(name);
  if (in_feature_) {
    check_size();
    if (too_large_) return skip();
  }
  Frame& top = frames_.back();
  switch (top.ctx) {
    case Ctx::Coordinates:  // the usual ones first
    case Ctx::Corner:
    case Ctx::GenericName:
    case Ctx::GenericValue:
    case Ctx::HeightValue:
    case Ctx::Matrix:
    case Ctx::ReferencePosition:
      return skip();
    case Ctx::Ring:
    case Ctx::RingInner:
    case Ctx::RingProperty:
      return start_in_ring(element, attributes);
    case Ctx::Geometry:
      return start_geometry_member(element, attributes);
    case Ctx::GeometryMember:
    case Ctx::GeometryProperty:
    case Ctx::RelativeProperty:
      if (!start_geometry(element, attributes)) skip();
      return;
    case Ctx::Surface:
      return start_in_surface(element, name.local, attributes);
    case Ctx::BoundaryProperty:
    case Ctx::OpeningProperty:
    case Ctx::FillingProperty:
      if (element.tag == Tag::BoundarySurface) return start_surface(element, attributes);
      return element.ns == Ns::Foreign ? skip_foreign(name.local) : skip();
    case Ctx::ImplicitProperty:
    case Ctx::Implicit:
    case Ctx::ReferencePoint:
      return start_in_implicit(element, attributes);
    case Ctx::AddressProperty:
    case Ctx::Address:
    case Ctx::Xal:
      return start_in_address(element, name.local);
    case Ctx::Object:
      return start_in_object(element, name.local, attributes);
    case Ctx::PartProperty:
      if (element.tag == Tag::BuildingPart || element.tag == Tag::Building)
        return start_object(element, top.object, ObjectKind::BuildingPart, attributes);
      return element.ns == Ns::Foreign ? skip_foreign(name.local) : skip();
    case Ctx::InstallationProperty:
      if (element.tag == Tag::Installation)
        return start_object(element, top.object, ObjectKind::BuildingInstallation, attributes);
      return element.ns == Ns::Foreign ? skip_foreign(name.local) : skip();
    case Ctx::Attribute:
      top.complex = true;
      return skip();
    case Ctx::GenericProperty:
    case Ctx::Generic:
    case Ctx::HeightProperty:
    case Ctx::Height:
      return start_in_generic(element, attributes);
    case Ctx::EnvelopeProperty:
      if (element.tag != Tag::Envelope) return skip();
      envelope_ = {};
      inherit(push(Ctx::Envelope, element), attributes);
      return;
    case Ctx::Envelope:
      return start_in_envelope(element);
    case Ctx::OtherFeature:
    case Ctx::Harvest:
      if (element.tag == Tag::Skipped || element.tag == Tag::UnusedGeometry ||
          element.ns == Ns::Foreign)
        return skip();
      if (start_geometry(element, attributes)) return;
      push(Ctx::Harvest, element);
      return;
    case Ctx::Member:
      return start_in_member(element, name.local, attributes);
    case Ctx::Model:
      return start_in_model(element);
    case Ctx::Document:
      if (element.tag == Tag::Building && element.ns == Ns::Building) {
        facts_.format = std::string("CityGML ") + namespace_of(name.uri).citygml_major + ".0";
        return start_object(element, -1, ObjectKind::Building, attributes);
      }
      return start_root(element, name);
  }
}

void CityGmlParser::start_root(const ElementName& element, const XmlName& name) {
  const char major = namespace_of(name.uri).citygml_major;
  const bool model = element.tag == Tag::CityModel && major >= '1' && major <= '3';
  if (!model && element.tag != Tag::FeatureCollection) {
    facts_.not_a_city_model = element.tag != Tag::CityModel;
    return xml_.fail_document(
        "the root element is '" + std::string(name.local) + "' of namespace '" +
        std::string(name.uri) +
        "', expected CityModel of CityGML 1.0, 2.0 or 3.0 or a feature collection");
  }
  facts_.format = model ? std::string("CityGML ") + major + ".0" : "GML feature collection";
  push(Ctx::Model, element);
}

void CityGmlParser::start_in_model(const ElementName& element) {
  if (element.tag == Tag::MemberProperty) {
    push(Ctx::Member, element);
  } else if (element.tag == Tag::EnvelopeProperty) {
    const std::size_t owner = frames_.size() - 1;
    push(Ctx::EnvelopeProperty, element).owner = owner;
  } else {
    skip();
  }
}

void CityGmlParser::start_in_member(const ElementName& element, std::string_view name,
                                    const XmlAttributes& attributes) {
  switch (element.tag) {
    case Tag::FeatureCollection:
    case Tag::CityModel:
      push(Ctx::Model, element);
      return;
    case Tag::Building:
    case Tag::BuildingPart:
      return start_object(
          element, -1,
          element.tag == Tag::Building ? ObjectKind::Building : ObjectKind::BuildingPart,
          attributes);
    default:
      if (!wanted_) {
        if (element.ns == Ns::Foreign) {
          ++facts_.skipped_objects;
          facts_.count_skipped(name);
        }
        return skip();
      }
      begin_feature();
      push(Ctx::OtherFeature, element).object = -1;
  }
}

void CityGmlParser::begin_feature() {
  feature_.clear();
  tree_.clear();
  in_feature_ = true;
  too_large_ = false;
  feature_begin_bytes_ = xml_.bytes_read();
  if (options_.piece) {
    frames_.back().srs = options_.piece->srs;
    frames_.back().dimension = options_.piece->dimension;
  } else if (in_pieces_) {
    const std::string_view tag = xml_.start_tag();
    const std::uint64_t place = xml_.position();
    in_pieces_ = xml_.can_be_read_in_pieces() && !tag.empty() && place >= tag.size();
    if (!in_pieces_) return;
    feature_.bytes.begin = place - tag.size();
    feature_.envelope = envelope(frames_.back());
  }
}

// The number of the envelope of features that stand where the parser is.
std::uint32_t CityGmlParser::envelope(const Frame& frame) {
  Envelope found{.srs = frame.srs, .dimension = frame.dimension};
  if (const std::string_view encoding = xml_.encoding(); !encoding.empty())
    found.before = "<?xml version=\"1.0\" encoding=\"" + std::string(encoding) + "\"?>";
  for (const std::string& tag : ancestors_) {
    found.before += tag + ">";
    found.after.insert(0, "</" + tag.substr(1, tag.find_first_of(" \t\r\n") - 1) + ">");
  }
  auto& all = facts_.envelopes;
  const auto known = std::find(all.begin(), all.end(), found);
  constexpr std::size_t kMaxEnvelopes = 1000;  // more: members with attributes of their own
  if (known == all.end() && all.size() == kMaxEnvelopes) {
    in_pieces_ = false;
    feature_.bytes = {};
    return 0;
  }
  const auto number = known - all.begin();
  if (known == all.end()) all.push_back(std::move(found));
  return static_cast<std::uint32_t>(number);
}

void CityGmlParser::start_object(const ElementName& element, std::int32_t parent, ObjectKind kind,
                                 const XmlAttributes& attributes) {
  if (parent < 0) begin_feature();
  object_ = static_cast<std::int32_t>(feature_.objects.size());
  RawObject& object = feature_.objects.emplace_back();
  object.gml_id = attributes.id;
  object.parent = parent;
  object.kind = kind;
  Frame& frame = push(Ctx::Object, element);
  frame.object = object_;
  frame.surface = -1;
  frame.surface_node = GeometryTree::kNone;
}

void CityGmlParser::start_in_object(const ElementName& element, std::string_view name,
                                    const XmlAttributes& attributes) {
  const std::size_t owner = frames_.size() - 1;
  switch (element.tag) {
    case Tag::BoundaryProperty:
      if (!attributes.href.empty())
        tree_.add_surface_reference(attributes.href, frames_.back().object, -1);
      push(Ctx::BoundaryProperty, element);
      return;
    case Tag::GeometryProperty:
      return start_geometry_property(element, attributes);
    case Tag::PartProperty:
      push(Ctx::PartProperty, element);
      return start_reference("building part", attributes.href);
    case Tag::InstallationProperty:
      push(Ctx::InstallationProperty, element);
      return start_reference("installation", attributes.href);
    case Tag::ImplicitProperty: {
      Frame& frame = push(Ctx::ImplicitProperty, element);
      frame.lod = element.lod;
      return;
    }
    case Tag::AddressProperty:
      push(Ctx::AddressProperty, element);
      if (!attributes.href.empty()) facts_.count_skipped(kSharedAddress);
      return;
    case Tag::EnvelopeProperty:
      push(Ctx::EnvelopeProperty, element).owner = owner;
      return;
    case Tag::Interior:
      push(Ctx::Harvest, element).object = -1;
      return;
    case Tag::GenericText:
    case Tag::GenericWhole:
    case Tag::GenericNumber:
    case Tag::GenericSet:
      return start_generic(element, attributes);
    case Tag::GenericProperty:
      push(Ctx::GenericProperty, element);
      return;
    case Tag::HeightProperty:
      push(Ctx::HeightProperty, element);
      return;
    case Tag::Other:
      break;
    default:
      return skip();
  }
  if (element.ns == Ns::Foreign || name.substr(0, 5) == "adeOf") return skip_foreign(name);
  if (element.ns == Ns::OtherModule || element.ns == Ns::None) return skip();
  push(Ctx::Attribute, element);
  name_ = name;
  xml_.capture();
}

void CityGmlParser::start_in_surface(const ElementName& element, std::string_view name,
                                     const XmlAttributes& attributes) {
  switch (element.tag) {
    case Tag::GeometryProperty:
      return start_geometry_property(element, attributes);
    case Tag::ImplicitProperty: {
      Frame& frame = push(Ctx::ImplicitProperty, element);
      frame.lod = element.lod;
      return;
    }
    case Tag::OpeningProperty:
      if (!attributes.href.empty())
        tree_.add_surface_reference(attributes.href, frames_.back().object, frames_.back().surface);
      push(Ctx::OpeningProperty, element);
      return;
    case Tag::FillingProperty:
      push(Ctx::FillingProperty, element).in_shell = false;
      return;
    case Tag::GenericText:
    case Tag::GenericProperty:
      return start_generic(element, attributes);
    case Tag::BoundaryProperty:  // of the volume of a window
      push(Ctx::BoundaryProperty, element);
      return;
    default:
      return element.ns == Ns::Foreign ? skip_foreign(name) : skip();
  }
}

// A part or an installation that stands elsewhere.
void CityGmlParser::start_reference(std::string_view what, std::string_view href) {
  if (href.empty()) return;
  report(issue_code::kUnreadableGeometry,
         std::string(what) + " by xlink:href '" + std::string(href) +
             "' is not joined to the building, it stays the feature that it is");
}

void CityGmlParser::skip_foreign(std::string_view name) {
  if (object_ >= 0)
    count_name(feature_.objects[static_cast<std::size_t>(object_)].skipped_ade_elements, name);
  skip();
}

void CityGmlParser::start_surface(const ElementName& element, const XmlAttributes& attributes) {
  RawObject& object = feature_.objects[static_cast<std::size_t>(frames_.back().object)];
  const std::int32_t outer = frames_.back().surface;
  object.surfaces.push_back({element.surface, std::string(attributes.id), outer});
  const GeometryTree::NodeId node =
      tree_.add_boundary_surface(element.surface, frames_.back().surface_node, attributes.id);
  Frame& frame = push(Ctx::Surface, element);
  frame.surface_node = node;
  frame.surface = static_cast<std::int32_t>(object.surfaces.size() - 1);
}

void CityGmlParser::on_end() {
  const Frame frame = frames_.back();
  frames_.pop_back();
  switch (frame.ctx) {
    case Ctx::Coordinates:
      return end_coordinates(frame);
    case Ctx::Ring:
      return end_ring(frame);
    case Ctx::Geometry:
      if (frame.tag == Tag::Polygon) end_polygon();
      return;
    case Ctx::Attribute:
      return end_attribute(frame);
    case Ctx::GenericName:
      name_ = trimmed(xml_.end_capture());
      if (frames_.back().tag == Tag::GenericSet && !generic_sets_.empty())
        generic_sets_.back() = name_;
      return;
    case Ctx::GenericValue:
      generic_value_ = trimmed(xml_.end_capture());
      return;
    case Ctx::Generic:
      return end_generic(frame);
    case Ctx::HeightValue:
      return end_height(frame);
    case Ctx::Matrix: {
      const auto matrix = matrix_from(xml_.end_capture());
      implicit_.has_matrix = matrix.has_value();
      if (matrix) implicit_.placement.matrix = *matrix;
      return;
    }
    case Ctx::ReferencePosition: {
      std::vector<Point3> point;
      const auto read = append_positions(xml_.end_capture(), 3, point);
      implicit_.has_reference = read.state == PositionsState::Ok && point.size() == 1;
      if (!implicit_.has_reference) return;
      implicit_.placement.reference = point[0];
      implicit_.placement.srs = frame.srs;
      return;
    }
    case Ctx::Implicit:
      return end_implicit(frame);
    case Ctx::Xal:
      return end_xal(frame);
    case Ctx::Address:
      if (frame.object >= 0 && !(address_ == Address{}))
        feature_.objects[static_cast<std::size_t>(frame.object)].addresses.push_back(address_);
      return;
    case Ctx::Corner:
      return end_corner(frame);
    case Ctx::Envelope:
      return end_envelope(frame);
    case Ctx::Object:
      return end_object(frame);
    case Ctx::OtherFeature:
      return end_feature(frame);
    case Ctx::Model:
    case Ctx::Member:
      ancestors_.pop_back();
      return;
    default:
      return;
  }
}

void CityGmlParser::end_object(const Frame& frame) {
  RawObject& object = feature_.objects[static_cast<std::size_t>(frame.object)];
  if (object.kind == ObjectKind::BuildingInstallation) {
    // CityGML 3.0 has one property for installations outside and inside.
    const auto relation = std::find_if(
        object.attributes.begin(), object.attributes.end(),
        [](const auto& attribute) { return attribute.first == "relationToConstruction"; });
    object.inside = relation != object.attributes.end() &&
                    relation->second == AttributeValue(std::string("inside"));
  }
  object_ = object.parent;
  if (object_ < 0) end_feature(frame);
}

void CityGmlParser::end_feature(const Frame& frame) {
  in_feature_ = false;
  object_ = -1;
  if (feature_.bytes.begin > 0) feature_.bytes.end = xml_.position();
  if (options_.stop.stop_requested())
    return xml_.stop_with(fail(ErrorCode::Cancelled, "reading was stopped"));
  if (wanted_) return tree_.collect(feature_, options_, *wanted_, facts_, *shared_);

  feature_.srs = frame.srs;
  ++ordinal_;
  RawObject& building = feature_.objects.front();
  if (building.gml_id.empty())
    building.gml_id = numbered_id(options_.stem, options_.buildings_before + ordinal_);
  for (std::size_t part = 1; part < feature_.objects.size(); ++part)
    if (feature_.objects[part].gml_id.empty())
      feature_.objects[part].gml_id = numbered_id(building.gml_id, part);

  if (too_large_) {
    building.issues.push_back({issue_code::kReadLimitExceeded,
                               "the building has more than max_building_bytes = " +
                                   std::to_string(options_.limits.max_building_bytes) +
                                   " bytes or max_points_per_building = " +
                                   std::to_string(options_.limits.max_points_per_building) +
                                   " points"});
  } else {
    tree_.resolve(feature_, options_, facts_);
  }
  if (auto taken = (*sink_)(feature_); !taken) xml_.stop_with(taken.error());
}

void CityGmlParser::check_size() {
  if (xml_.bytes_read() - feature_begin_bytes_ > options_.limits.max_building_bytes ||
      feature_.points.size() > options_.limits.max_points_per_building)
    too_large_ = true;
}

void CityGmlParser::report(int code, std::string where, double measured) {
  if (object_ < 0) return;
  feature_.objects[static_cast<std::size_t>(object_)].issues.push_back(
      {code, std::move(where), measured});
}

Result<void> read_citygml(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                          const FeatureSink& sink) {
  return CityGmlParser(bytes, options, facts, &sink, nullptr, nullptr).parse();
}

Result<void> collect_shared_geometry(ByteReader& bytes, const DocumentOptions& options,
                                     const std::set<std::string, std::less<>>& wanted,
                                     DocumentFacts& facts, SharedGeometry& shared) {
  return CityGmlParser(bytes, options, facts, nullptr, &wanted, &shared).parse();
}

}  // namespace citymesh::source
