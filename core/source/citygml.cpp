#include "core/source/citygml.h"

#include <libxml/parser.h>
#include <libxml/parserInternals.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/citygml_names.h"
#include "core/source/citygml_shapes.h"
#include "core/source/positions.h"

namespace citymesh::source {
namespace {

std::string_view view(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view{};
}

bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// The values of the few attributes that matter; views live until the callback returns.
struct XmlAttributes {
  std::string_view id{}, href{}, srs_name{}, srs_dimension{}, orientation{}, name{};

  XmlAttributes(int count, const xmlChar** attributes) {
    for (int i = 0; i < count; ++i, attributes += 5) {
      const std::string_view key = view(attributes[0]);
      const auto* begin = reinterpret_cast<const char*>(attributes[3]);
      const std::string_view value(
          begin, static_cast<std::size_t>(reinterpret_cast<const char*>(attributes[4]) - begin));
      if (key == "id")
        id = value;
      else if (key == "srsDimension")
        srs_dimension = value;
      else if (key == "href")
        href = trimmed(value);
      else if (key == "srsName")
        srs_name = trimmed(value);
      else if (key == "orientation")
        orientation = value;
      else if (key == "name")
        name = value;
    }
  }
};

/// What the element that is open means; each decides what its children are.
enum class Ctx : std::uint8_t {
  Document,
  Model,
  Member,
  OtherFeature,
  Object,
  PartProperty,
  BoundaryProperty,
  Surface,
  OpeningProperty,
  EnvelopeProperty,
  Envelope,
  Corner,
  GeometryProperty,
  Geometry,
  GeometryMember,
  RingProperty,
  Ring,
  RingInner,
  Coordinates,
  Attribute,
  GenericProperty,
  Generic,
  GenericName,
  GenericValue,
  HeightProperty,
  Height,
  HeightValue,
  Harvest,  ///< of no use itself, but its geometry may be referred to
};

struct Frame {
  Ctx ctx = Ctx::Document;
  Tag tag = Tag::Other;
  GeometryTree::Role role = GeometryTree::Role::Member;
  std::uint8_t dimension = 3;  ///< of coordinates, inherited
  std::int8_t lod = -1;
  bool footprint = false;
  bool complex = false;       ///< an attribute with children: not kept
  std::uint32_t srs = 0;      ///< inherited
  std::int32_t object = -1;   ///< whose geometry this is, inherited
  std::int32_t surface = -1;  ///< inherited
  std::int32_t node = -1;     ///< of the geometry tree
  std::size_t owner = 0;      ///< Envelope: the frame that it describes
};

class CityGmlParser {
 public:
  CityGmlParser(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                const FeatureSink* sink, const std::set<std::string, std::less<>>* wanted,
                SharedGeometry* shared)
      : bytes_(bytes),
        options_(options),
        facts_(facts),
        sink_(sink),
        wanted_(wanted),
        shared_(shared) {
    frames_.push_back({});
  }

  Result<void> parse();

 private:
  // libxml2's view of this parser. Nothing may be thrown through it.
  template <class Action>
  void guarded(Action&& action) noexcept {
    if (stopped_) return;
    try {
      action();
    } catch (const std::exception& exception) {
      stop_with(fail(ErrorCode::ResourceExhausted,
                     std::string("reading the file failed: ") + exception.what()));
    }
  }
  static CityGmlParser& self(void* context) { return *static_cast<CityGmlParser*>(context); }
  static int read_bytes(void* context, char* buffer, int size);
  static void start_element(void* context, const xmlChar* name, const xmlChar* prefix,
                            const xmlChar* uri, int, const xmlChar**, int attribute_count, int,
                            const xmlChar** attributes);
  static void end_element(void* context, const xmlChar*, const xmlChar*, const xmlChar*);
  static void characters(void* context, const xmlChar* text, int size);
  static void doctype(void* context, const xmlChar* name, const xmlChar*, const xmlChar*);
  static void ignore_error(void*, xmlErrorPtr) {}

  void stop_with(Error error) {
    if (!error_) error_ = std::move(error);
    halt();
  }
  void fail_document(const std::string& reason) {
    if (facts_.failure.empty()) facts_.failure = "line " + std::to_string(line()) + ": " + reason;
    halt();
  }
  /// From here on events are ignored and reading fails, so the parser ends by itself at the end of
  /// its buffer. xmlStopParser from inside a callback leaves libxml2 2.9 without an input and
  /// crashes it.
  void halt() { stopped_ = true; }
  int line() const { return context_ && context_->input ? context_->input->line : 0; }

  const ElementName& meaning(const xmlChar* name, const xmlChar* uri);
  void on_start(const ElementName& element, std::string_view name, std::string_view uri,
                const XmlAttributes& attributes);
  void on_end();

  Frame& push(Ctx ctx, const ElementName& element);
  void skip() { skipped_ = 1; }
  void skip_foreign() {
    if (object_ >= 0) ++feature_.objects[static_cast<std::size_t>(object_)].skipped_ade_elements;
    skip();
  }
  void capture() {
    text_.clear();
    capturing_ = true;
  }

  void start_root(const ElementName& element, std::string_view name, std::string_view uri);
  void start_in_member(const ElementName& element, const XmlAttributes& attributes);
  void start_in_object(const ElementName& element, std::string_view name,
                       const XmlAttributes& attributes);
  void start_surface(const ElementName& element, const XmlAttributes& attributes);
  bool start_geometry(const ElementName& element, const XmlAttributes& attributes);
  void start_geometry_member(const ElementName& element, const XmlAttributes& attributes);
  void start_geometry_property(const ElementName& element, const XmlAttributes& attributes);
  void start_generic(const ElementName& element, const XmlAttributes& attributes);
  void start_object(const ElementName& element, std::int32_t parent,
                    const XmlAttributes& attributes);
  void inherit(Frame& frame, const XmlAttributes& attributes);

  void end_coordinates(const Frame& frame);
  void end_polygon();
  void end_envelope(const Frame& frame);
  void end_object(const Frame& frame);
  void end_feature(const Frame& frame);
  void add_attribute(std::int32_t object, std::string_view key, AttributeValue value);
  void report(int code, std::string where, double measured = 0);
  std::string polygon_place() const;
  void check_size();
  void begin_feature();
  bool can_be_read_in_pieces() const;
  std::string_view start_tag() const;
  std::uint64_t position() const;
  std::uint32_t envelope(const Frame& frame);

  ByteReader& bytes_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  const FeatureSink* sink_;
  const std::set<std::string, std::less<>>* wanted_;
  SharedGeometry* shared_;

  xmlParserCtxtPtr context_ = nullptr;
  bool stopped_ = false;
  std::optional<Error> error_{};

  // Interned by libxml2: pointers tell names apart.
  struct NameKey {
    const xmlChar* name;
    const xmlChar* uri;
    bool operator==(const NameKey&) const = default;
  };
  struct NameHash {
    std::size_t operator()(const NameKey& key) const {
      return (reinterpret_cast<std::uintptr_t>(key.name) >> 3) * 0x9E3779B97F4A7C15ull ^
             (reinterpret_cast<std::uintptr_t>(key.uri) >> 3);
    }
  };
  std::unordered_map<NameKey, ElementName, NameHash> names_{};
  std::unordered_map<const xmlChar*, NsMeaning> namespaces_{};

  std::vector<Frame> frames_{};
  std::vector<std::string> ancestors_{};  ///< start tags of the open elements above the features
  bool in_pieces_ = true;                 ///< features can be found again by their place
  unsigned depth_ = 0;
  unsigned skipped_ = 0;  ///< open elements of a skipped subtree
  bool capturing_ = false;
  std::string text_{};
  std::string name_{};  ///< of the attribute that is read
  std::string generic_value_{};
  std::uint64_t event_bytes_ = 0;

  Feature feature_{};
  GeometryTree tree_{};
  bool in_feature_ = false;
  bool too_large_ = false;
  std::int32_t object_ = -1;  ///< innermost building or part
  std::uint64_t feature_begin_bytes_ = 0;
  std::uint64_t ordinal_ = 0;
  std::uint32_t polygon_ = 0;
  std::uint32_t ring_first_point_ = 0;
  bool exterior_seen_ = false;
  Box3 envelope_{};
};

// ---- libxml2 -----------------------------------------------------------------------------------

int CityGmlParser::read_bytes(void* context, char* buffer, int size) {
  CityGmlParser& parser = self(context);
  int count = -1;
  parser.guarded([&] {
    if (parser.options_.stop.stop_requested()) {
      parser.stop_with(fail(ErrorCode::Cancelled, "reading was stopped"));
      return;
    }
    // A comment, a name or an attribute that does not end would be held in memory as a whole.
    if (parser.bytes_.bytes_read() >
        parser.event_bytes_ + parser.options_.limits.max_building_bytes) {
      parser.fail_document("a single piece of markup has more than max_building_bytes = " +
                           std::to_string(parser.options_.limits.max_building_bytes) + " bytes");
      return;
    }
    const auto got = parser.bytes_.read(buffer, static_cast<std::size_t>(size));
    if (!got) {
      parser.fail_document(got.error().message);
      return;
    }
    count = static_cast<int>(*got);
  });
  return count;
}

void CityGmlParser::start_element(void* context, const xmlChar* name, const xmlChar*,
                                  const xmlChar* uri, int, const xmlChar**, int attribute_count,
                                  int, const xmlChar** attributes) {
  CityGmlParser& parser = self(context);
  parser.event_bytes_ = parser.bytes_.bytes_read();
  if (++parser.depth_ > parser.options_.limits.max_depth) {
    parser.guarded([&] {
      parser.fail_document("elements are nested deeper than max_depth = " +
                           std::to_string(parser.options_.limits.max_depth));
    });
    return;
  }
  if (parser.skipped_ > 0) {
    ++parser.skipped_;
    return;
  }
  parser.guarded([&] {
    parser.on_start(parser.meaning(name, uri), view(name), view(uri),
                    XmlAttributes(attribute_count, attributes));
  });
}

void CityGmlParser::end_element(void* context, const xmlChar*, const xmlChar*, const xmlChar*) {
  CityGmlParser& parser = self(context);
  parser.event_bytes_ = parser.bytes_.bytes_read();
  --parser.depth_;
  if (parser.skipped_ > 0) {
    --parser.skipped_;
    return;
  }
  parser.guarded([&] { parser.on_end(); });
}

void CityGmlParser::characters(void* context, const xmlChar* text, int size) {
  CityGmlParser& parser = self(context);
  parser.event_bytes_ = parser.bytes_.bytes_read();
  if (!parser.capturing_ || parser.skipped_ > 0) return;
  parser.guarded([&] {
    parser.text_.append(reinterpret_cast<const char*>(text), static_cast<std::size_t>(size));
    if (parser.text_.size() > parser.options_.limits.max_building_bytes)
      parser.fail_document("a text has more than max_building_bytes = " +
                           std::to_string(parser.options_.limits.max_building_bytes) + " bytes");
  });
}

void CityGmlParser::doctype(void* context, const xmlChar* name, const xmlChar*, const xmlChar*) {
  CityGmlParser& parser = self(context);
  parser.guarded([&] {
    parser.fail_document("a document type declaration (<!DOCTYPE " + std::string(view(name)) +
                         ">) is refused: CityGML needs none, and entities are not expanded");
  });
}

Result<void> CityGmlParser::parse() {
  xmlSAXHandler handler{};
  handler.initialized = XML_SAX2_MAGIC;
  handler.startElementNs = &start_element;
  handler.endElementNs = &end_element;
  handler.characters = &characters;
  handler.ignorableWhitespace = &characters;
  handler.cdataBlock = &characters;
  handler.internalSubset = &doctype;
  handler.serror = &ignore_error;

  xmlInitParser();
  context_ =
      xmlCreateIOParserCtxt(&handler, this, &read_bytes, nullptr, this, XML_CHAR_ENCODING_NONE);
  if (!context_) {
    if (error_) return *error_;
    if (facts_.failure.empty()) facts_.failure = "the file cannot be read as XML";
    return {};
  }
  // Depth, size and text length are our own counters: libxml2's would refuse real city models.
  xmlCtxtUseOptions(context_, XML_PARSE_NONET | XML_PARSE_HUGE);
  xmlParseDocument(context_);

  if (!error_ && facts_.failure.empty() && !context_->wellFormed) {
    const xmlError* problem = xmlCtxtGetLastError(context_);
    facts_.failure =
        "line " + std::to_string(problem ? problem->line : line()) + ": " +
        (problem && problem->message ? std::string(trimmed(problem->message)) : "not well-formed");
  }
  if (context_->myDoc) xmlFreeDoc(context_->myDoc);
  xmlFreeParserCtxt(context_);
  context_ = nullptr;
  if (error_) return *error_;
  return {};
}

const ElementName& CityGmlParser::meaning(const xmlChar* name, const xmlChar* uri) {
  const auto [entry, is_new] = names_.try_emplace(NameKey{name, uri});
  if (is_new) {
    const NsMeaning ns = namespaces_.try_emplace(uri, namespace_of(view(uri))).first->second;
    entry->second = element_name(ns.ns, view(name));
  }
  return entry->second;
}

// ---- elements ----------------------------------------------------------------------------------

Frame& CityGmlParser::push(Ctx ctx, const ElementName& element) {
  if (ctx == Ctx::Model || ctx == Ctx::Member) ancestors_.emplace_back(start_tag());
  Frame frame = frames_.back();
  frame.ctx = ctx;
  frame.tag = element.tag;
  frame.complex = false;
  return frames_.emplace_back(frame);
}

void CityGmlParser::inherit(Frame& frame, const XmlAttributes& attributes) {
  if (!attributes.srs_name.empty()) frame.srs = facts_.intern_srs(attributes.srs_name);
  if (attributes.srs_dimension == "2") frame.dimension = 2;
  if (attributes.srs_dimension == "3") frame.dimension = 3;
}

void CityGmlParser::on_start(const ElementName& element, std::string_view name,
                             std::string_view uri, const XmlAttributes& attributes) {
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
      return skip();
    case Ctx::Ring:
    case Ctx::RingInner:
      if (element.tag == Tag::Coordinates) {
        inherit(push(Ctx::Coordinates, element), attributes);
        return capture();
      }
      if (element.ns != Ns::Gml) return skip();
      inherit(push(Ctx::RingInner, element), attributes);
      return;
    case Ctx::RingProperty:
      if (element.tag != Tag::Ring) return skip();
      ring_first_point_ = static_cast<std::uint32_t>(feature_.points.size());
      inherit(push(Ctx::Ring, element), attributes);
      return;
    case Ctx::Geometry:
      return start_geometry_member(element, attributes);
    case Ctx::GeometryMember:
    case Ctx::GeometryProperty:
      if (!start_geometry(element, attributes)) skip();
      return;
    case Ctx::Surface:
      if (element.tag == Tag::GeometryProperty) return start_geometry_property(element, attributes);
      if (element.tag == Tag::OpeningProperty) {
        push(Ctx::OpeningProperty, element);
        return;
      }
      return element.ns == Ns::Foreign ? skip_foreign() : skip();
    case Ctx::BoundaryProperty:
    case Ctx::OpeningProperty:
      if (element.tag == Tag::BoundarySurface) return start_surface(element, attributes);
      return element.ns == Ns::Foreign ? skip_foreign() : skip();
    case Ctx::Object:
      return start_in_object(element, name, attributes);
    case Ctx::PartProperty:
      if (element.tag == Tag::BuildingPart || element.tag == Tag::Building)
        return start_object(element, top.object, attributes);
      return skip();
    case Ctx::Attribute:
      top.complex = true;
      return skip();
    case Ctx::GenericProperty:
      return start_generic(element, attributes);
    case Ctx::Generic:
      if (top.tag == Tag::GenericSet) return start_generic(element, attributes);
      if (element.tag == Tag::Value || element.tag == Tag::Name) {
        push(element.tag == Tag::Value ? Ctx::GenericValue : Ctx::GenericName, element);
        return capture();
      }
      return skip();
    case Ctx::HeightProperty:
      if (element.tag != Tag::Height) return skip();
      push(Ctx::Height, element);
      return;
    case Ctx::Height:
      if (element.tag != Tag::Value) return skip();
      push(Ctx::HeightValue, element);
      return capture();
    case Ctx::EnvelopeProperty:
      if (element.tag != Tag::Envelope) return skip();
      envelope_ = {};
      inherit(push(Ctx::Envelope, element), attributes);
      return;
    case Ctx::Envelope:
      if (element.tag != Tag::LowerCorner && element.tag != Tag::UpperCorner &&
          element.tag != Tag::Coordinates)
        return skip();
      push(Ctx::Corner, element);
      return capture();
    case Ctx::OtherFeature:
    case Ctx::Harvest:
      if (element.tag == Tag::Skipped || element.tag == Tag::UnusedGeometry ||
          element.ns == Ns::Foreign)
        return skip();
      if (start_geometry(element, attributes)) return;
      push(Ctx::Harvest, element);
      return;
    case Ctx::Member:
      return start_in_member(element, attributes);
    case Ctx::Model:
      if (element.tag == Tag::MemberProperty) {
        push(Ctx::Member, element);
      } else if (element.tag == Tag::EnvelopeProperty) {
        const std::size_t owner = frames_.size() - 1;
        push(Ctx::EnvelopeProperty, element).owner = owner;
      } else {
        skip();
      }
      return;
    case Ctx::Document:
      return start_root(element, name, uri);
  }
}

void CityGmlParser::start_root(const ElementName& element, std::string_view name,
                               std::string_view uri) {
  const char major = namespace_of(uri).citygml_major;
  const bool model = element.tag == Tag::CityModel && major >= '1' && major <= '3';
  if (!model && element.tag != Tag::FeatureCollection) {
    facts_.not_a_city_model = element.tag != Tag::CityModel;
    return fail_document(
        "the root element is '" + std::string(name) + "' of namespace '" + std::string(uri) +
        "', expected CityModel of CityGML 1.0, 2.0 or 3.0 or a feature collection");
  }
  facts_.format = model ? std::string("CityGML ") + major + ".0" : "GML feature collection";
  push(Ctx::Model, element);
}

void CityGmlParser::start_in_member(const ElementName& element, const XmlAttributes& attributes) {
  switch (element.tag) {
    case Tag::FeatureCollection:
    case Tag::CityModel:
      push(Ctx::Model, element);
      return;
    case Tag::Building:
    case Tag::BuildingPart:
      return start_object(element, -1, attributes);
    default:
      if (!wanted_) return skip();
      begin_feature();
      push(Ctx::OtherFeature, element).object = -1;
  }
}

// The tag whose start is being reported. Markup holds no '<', so it is what follows the last one;
// the parser keeps a tag together in its buffer.
std::string_view CityGmlParser::start_tag() const {
  const xmlParserInput* input = context_ ? context_->input : nullptr;
  if (!input || !input->cur || !input->base) return {};
  const auto* end = reinterpret_cast<const char*>(input->cur);
  const auto* begin = end;
  while (begin > reinterpret_cast<const char*>(input->base) && *begin != '<') --begin;
  if (*begin != '<') return {};
  return {begin, static_cast<std::size_t>(end - begin)};
}

// Bytes of the document before the parser's place; not what it has read ahead.
std::uint64_t CityGmlParser::position() const {
  const long place = context_ ? xmlByteConsumed(context_) : -1;
  return place < 0 ? 0 : static_cast<std::uint64_t>(place);
}

void CityGmlParser::begin_feature() {
  feature_.clear();
  tree_.clear();
  in_feature_ = true;
  too_large_ = false;
  feature_begin_bytes_ = bytes_.bytes_read();
  if (options_.piece) {
    frames_.back().srs = options_.piece->srs;
    frames_.back().dimension = options_.piece->dimension;
  } else if (in_pieces_) {
    const std::string_view tag = start_tag();
    const std::uint64_t place = position();
    in_pieces_ = can_be_read_in_pieces() && !tag.empty() && place >= tag.size();
    if (!in_pieces_) return;
    feature_.bytes.begin = place - tag.size();
    feature_.envelope = envelope(frames_.back());
  }
}

// Where characters have more than a byte each, a piece cannot stand behind an envelope of ours;
// where they are transcoded, the length of a start tag is that of the file only in ASCII.
bool CityGmlParser::can_be_read_in_pieces() const {
  if (!context_->input->buf || !context_->input->buf->encoder) return true;
  const std::string_view encoding = view(context_->encoding);
  const std::string_view tag = start_tag();
  return !encoding.empty() && encoding.substr(0, 3) != "UTF" && encoding.substr(0, 3) != "UCS" &&
         encoding.substr(0, 9) != "ISO-10646" &&
         std::all_of(tag.begin(), tag.end(), [](char c) { return c > 0; });
}

// The number of the envelope of features that stand where the parser is.
std::uint32_t CityGmlParser::envelope(const Frame& frame) {
  Envelope found{.srs = frame.srs, .dimension = frame.dimension};
  const auto* encoding = context_->encoding;
  if (encoding)
    found.before = "<?xml version=\"1.0\" encoding=\"" + std::string(view(encoding)) + "\"?>";
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

void CityGmlParser::start_object(const ElementName& element, std::int32_t parent,
                                 const XmlAttributes& attributes) {
  if (parent < 0) begin_feature();
  object_ = static_cast<std::int32_t>(feature_.objects.size());
  RawObject& object = feature_.objects.emplace_back();
  object.gml_id = attributes.id;
  object.parent = parent;
  Frame& frame = push(Ctx::Object, element);
  frame.object = object_;
  frame.surface = -1;
}

void CityGmlParser::start_in_object(const ElementName& element, std::string_view name,
                                    const XmlAttributes& attributes) {
  const std::size_t owner = frames_.size() - 1;
  switch (element.tag) {
    case Tag::BoundaryProperty:
      push(Ctx::BoundaryProperty, element);
      if (!attributes.href.empty())
        report(issue_code::kUnreadableGeometry,
               "boundary surface by xlink:href '" + std::string(attributes.href) + "' is not read");
      return;
    case Tag::GeometryProperty:
      return start_geometry_property(element, attributes);
    case Tag::PartProperty:
      push(Ctx::PartProperty, element);
      if (!attributes.href.empty())
        report(issue_code::kUnreadableGeometry,
               "building part by xlink:href '" + std::string(attributes.href) + "' is not read");
      return;
    case Tag::EnvelopeProperty:
      push(Ctx::EnvelopeProperty, element).owner = owner;
      return;
    case Tag::Installation:
      ++feature_.objects[static_cast<std::size_t>(object_)].skipped_installations;
      [[fallthrough]];
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
  if (element.ns == Ns::Foreign || name.substr(0, 5) == "adeOf") return skip_foreign();
  if (element.ns == Ns::OtherModule || element.ns == Ns::None) return skip();
  push(Ctx::Attribute, element);
  name_ = name;
  capture();
}

void CityGmlParser::start_surface(const ElementName& element, const XmlAttributes& attributes) {
  RawObject& object = feature_.objects[static_cast<std::size_t>(frames_.back().object)];
  const std::int32_t outer = frames_.back().surface;
  object.surfaces.push_back({element.surface, std::string(attributes.id), outer});
  Frame& frame = push(Ctx::Surface, element);
  frame.surface = static_cast<std::int32_t>(object.surfaces.size() - 1);
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

void CityGmlParser::start_generic(const ElementName& element, const XmlAttributes& attributes) {
  switch (element.tag) {
    case Tag::GenericText:
    case Tag::GenericWhole:
    case Tag::GenericNumber:
      name_ = attributes.name;
      generic_value_.clear();
      [[fallthrough]];
    case Tag::GenericSet:
      push(Ctx::Generic, element);
      return;
    case Tag::GenericProperty:
      push(Ctx::GenericProperty, element);
      return;
    default:
      return skip();
  }
}

// ---- ends --------------------------------------------------------------------------------------

void CityGmlParser::on_end() {
  const Frame frame = frames_.back();
  frames_.pop_back();
  switch (frame.ctx) {
    case Ctx::Coordinates:
      return end_coordinates(frame);
    case Ctx::Ring: {
      const auto count = static_cast<std::uint32_t>(feature_.points.size()) - ring_first_point_;
      RawPolygon& polygon = feature_.polygons[polygon_];
      if (count == 0 && polygon.usable) {
        report(issue_code::kUnreadableRing, polygon_place() + ": no coordinates");
        polygon.usable = false;
      }
      feature_.rings.push_back({ring_first_point_, count});
      ++polygon.ring_count;
      if (frame.role == GeometryTree::Role::Exterior && !exterior_seen_) {
        exterior_seen_ = true;
        // The exterior leads, wherever the file puts it.
        const auto rings = feature_.rings.begin() + polygon.first_ring;
        std::rotate(rings, feature_.rings.end() - 1, feature_.rings.end());
      }
      return;
    }
    case Ctx::Geometry:
      if (frame.tag == Tag::Polygon) end_polygon();
      return;
    case Ctx::Attribute:
      capturing_ = false;
      if (!frame.complex) {
        const std::string_view value = trimmed(text_);
        if (value.empty()) return;
        if (name_ == "measuredHeight") {
          if (const auto height = number_from<double>(value))
            return add_attribute(frame.object, name_, *height);
        } else if (name_ == "storeysAboveGround" || name_ == "storeysBelowGround" ||
                   name_ == "yearOfConstruction" || name_ == "yearOfDemolition") {
          if (const auto whole = number_from<std::int64_t>(value))
            return add_attribute(frame.object, name_, *whole);
        }
        add_attribute(frame.object, name_, std::string(value));
      }
      return;
    case Ctx::GenericName:
      capturing_ = false;
      name_ = trimmed(text_);
      return;
    case Ctx::GenericValue:
      capturing_ = false;
      generic_value_ = trimmed(text_);
      return;
    case Ctx::Generic: {
      if (frame.tag == Tag::GenericSet || name_.empty()) return;
      if (frame.tag == Tag::GenericWhole) {
        if (const auto whole = number_from<std::int64_t>(generic_value_))
          return add_attribute(frame.object, name_, *whole);
      } else if (frame.tag == Tag::GenericNumber) {
        if (const auto value = number_from<double>(generic_value_))
          return add_attribute(frame.object, name_, *value);
      }
      return add_attribute(frame.object, name_, generic_value_);
    }
    case Ctx::HeightValue:
      capturing_ = false;
      if (const auto height = number_from<double>(trimmed(text_)))
        if (!number_attribute(feature_.objects[static_cast<std::size_t>(frame.object)].attributes,
                              "measuredHeight"))
          add_attribute(frame.object, "measuredHeight", *height);
      return;
    case Ctx::Corner: {
      capturing_ = false;
      std::vector<Point3> corner;
      const auto dimension = static_cast<unsigned>(
          std::count_if(text_.begin(), text_.end(), is_gap) >= 2 ? 3 : frame.dimension);
      if (append_positions(text_, dimension, corner).state == PositionsState::Ok)
        for (const Point3& point : corner) envelope_.add(point);
      return;
    }
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

void CityGmlParser::end_coordinates(const Frame& frame) {
  capturing_ = false;
  RawPolygon& polygon = feature_.polygons[polygon_];
  const std::size_t before = feature_.points.size();
  const PositionsResult read = append_positions(text_, frame.dimension, feature_.points);
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

void CityGmlParser::end_object(const Frame& frame) {
  RawObject& object = feature_.objects[static_cast<std::size_t>(frame.object)];
  object_ = object.parent;
  if (object_ < 0) end_feature(frame);
}

void CityGmlParser::end_feature(const Frame& frame) {
  in_feature_ = false;
  object_ = -1;
  if (feature_.bytes.begin > 0) feature_.bytes.end = position();
  if (options_.stop.stop_requested())
    return stop_with(fail(ErrorCode::Cancelled, "reading was stopped"));
  if (wanted_) return tree_.collect(feature_, options_, *wanted_, *shared_);

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
    tree_.resolve(feature_, options_, facts_.unresolved);
  }
  if (auto taken = (*sink_)(feature_); !taken) stop_with(taken.error());
}

void CityGmlParser::check_size() {
  if (bytes_.bytes_read() - feature_begin_bytes_ > options_.limits.max_building_bytes ||
      feature_.points.size() > options_.limits.max_points_per_building)
    too_large_ = true;
}

void CityGmlParser::add_attribute(std::int32_t object, std::string_view key, AttributeValue value) {
  if (object < 0) return;
  Attributes& attributes = feature_.objects[static_cast<std::size_t>(object)].attributes;
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (found == attributes.end()) {
    attributes.emplace_back(key, std::move(value));
    return;
  }
  // Names may repeat (function, usage): their texts are joined.
  auto* text = std::get_if<std::string>(&found->second);
  const auto* more = std::get_if<std::string>(&value);
  if (text && more) *text += ";" + *more;
}

void CityGmlParser::report(int code, std::string where, double measured) {
  if (object_ < 0) return;
  feature_.objects[static_cast<std::size_t>(object_)].issues.push_back(
      {code, std::move(where), measured});
}

std::string CityGmlParser::polygon_place() const {
  const RawPolygon& polygon = feature_.polygons[polygon_];
  return "polygon '" + polygon.gml_id + "' ring " + std::to_string(polygon.ring_count) + " line " +
         std::to_string(line());
}

}  // namespace

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
