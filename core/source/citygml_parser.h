#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/source/citygml_names.h"
#include "core/source/citygml_shapes.h"
#include "core/source/xml_reader.h"

namespace citymesh::source {

/// What the element that is open means; each decides what its children are.
enum class Ctx : std::uint8_t {
  Document,
  Model,
  Member,
  OtherFeature,
  Object,
  PartProperty,
  InstallationProperty,
  BoundaryProperty,
  Surface,
  OpeningProperty,
  FillingProperty,
  ImplicitProperty,
  Implicit,
  Matrix,
  RelativeProperty,
  ReferencePoint,
  ReferencePosition,
  AddressProperty,
  Address,
  Xal,
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
  bool in_shell = true;            ///< false in the volumes of windows and doors, inherited
  bool complex = false;            ///< an attribute with children: not kept
  std::uint32_t srs = 0;           ///< inherited
  std::int32_t object = -1;        ///< whose geometry this is, inherited
  std::int32_t surface = -1;       ///< inherited
  std::int32_t node = -1;          ///< of the geometry tree
  std::int32_t surface_node = -1;  ///< of `surface`, inherited
  std::size_t owner = 0;           ///< Envelope: the frame that it describes
};

/// Reads CityGML: features in citygml.cpp, their geometry in citygml_geometry.cpp, attributes in
/// citygml_attributes.cpp, addresses
/// in citygml_addresses.cpp. With `wanted` ids it only collects the geometry below them.
class CityGmlParser final : private XmlHandler {
 public:
  CityGmlParser(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                const FeatureSink* sink, const std::set<std::string, std::less<>>* wanted,
                SharedGeometry* shared)
      : xml_(bytes, options, facts, *this),
        options_(options),
        facts_(facts),
        sink_(sink),
        wanted_(wanted),
        shared_(shared) {
    frames_.push_back({});
  }

  Result<void> parse() { return xml_.parse(); }

 private:
  void on_start(const XmlName& name, const XmlAttributes& attributes) override;
  void on_end() override;

  const ElementName& meaning(const XmlName& name);
  Frame& push(Ctx ctx, const ElementName& element);
  void skip() { xml_.skip(); }
  void skip_foreign(std::string_view name);

  void start_root(const ElementName& element, const XmlName& name);
  void start_in_model(const ElementName& element);
  void start_in_member(const ElementName& element, std::string_view name,
                       const XmlAttributes& attributes);
  void start_in_object(const ElementName& element, std::string_view name,
                       const XmlAttributes& attributes);
  void start_in_surface(const ElementName& element, std::string_view name,
                        const XmlAttributes& attributes);
  void start_in_boundary(const ElementName& element, std::string_view name,
                         const XmlAttributes& attributes);
  void start_in_implicit(const ElementName& element, const XmlAttributes& attributes);
  void start_in_address(const ElementName& element, std::string_view name);
  void start_surface(const ElementName& element, const XmlAttributes& attributes);
  bool start_geometry(const ElementName& element, const XmlAttributes& attributes);
  void start_geometry_member(const ElementName& element, const XmlAttributes& attributes);
  void start_geometry_property(const ElementName& element, const XmlAttributes& attributes);
  void start_in_ring(const ElementName& element, const XmlAttributes& attributes);
  void start_in_envelope(const ElementName& element);
  void start_generic(const ElementName& element, const XmlAttributes& attributes);
  void start_in_generic(const ElementName& element, const XmlAttributes& attributes);
  void start_object(const ElementName& element, std::int32_t parent, ObjectKind kind,
                    const XmlAttributes& attributes);
  void start_reference(std::string_view what, std::string_view href);
  void begin_feature();
  std::uint32_t envelope(const Frame& frame);
  void inherit(Frame& frame, const XmlAttributes& attributes);

  struct Separators;
  static bool is_usual(const Separators& separators);
  static std::string with_usual_separators(std::string_view text, const Separators& separators);
  unsigned dimension_of(std::string_view text, const Frame& frame) const;
  void end_coordinates(const Frame& frame);
  void end_ring(const Frame& frame);
  void end_polygon();
  void end_corner(const Frame& frame);
  void end_envelope(const Frame& frame);
  void end_implicit(const Frame& frame);
  void end_xal(const Frame& frame);
  std::string generic_name() const;
  void end_attribute(const Frame& frame);
  void end_generic(const Frame& frame);
  void end_height(const Frame& frame);
  void end_object(const Frame& frame);
  void end_feature(const Frame& frame);
  void add_attribute(std::int32_t object, std::string_view key, AttributeValue value);
  void report(int code, std::string where, double measured = 0);
  std::string polygon_place() const;
  void check_size();

  XmlReader xml_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  const FeatureSink* sink_;
  const std::set<std::string, std::less<>>* wanted_;
  SharedGeometry* shared_;

  // Names are interned: their addresses tell them apart.
  struct NameKey {
    const char* name;
    const char* uri;
    bool operator==(const NameKey&) const = default;
  };
  struct NameHash {
    std::size_t operator()(const NameKey& key) const {
      return (reinterpret_cast<std::uintptr_t>(key.name) >> 3) * 0x9E3779B97F4A7C15ull ^
             (reinterpret_cast<std::uintptr_t>(key.uri) >> 3);
    }
  };
  std::unordered_map<NameKey, ElementName, NameHash> names_{};
  std::unordered_map<const char*, NsMeaning> namespaces_{};

  std::vector<Frame> frames_{};
  std::vector<std::string> ancestors_{};  ///< start tags of the open elements above the features
  bool in_pieces_ = true;                 ///< features can be found again by their place
  std::string name_{};                    ///< of the attribute that is read
  std::string generic_value_{};
  std::vector<std::string> generic_sets_{};  ///< names of the open sets
  std::vector<std::string> xal_{};           ///< names of the open elements of an address
  Address address_{};

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
  /// How a gml:coordinates separates decimals, coordinates and tuples.
  struct Separators {
    char decimal = '.', coordinate = ',', tuple = ' ';
  };
  Separators separators_{};
  std::uint64_t position_count_ = 0;  ///< as a gml:posList states it, else 0
  /// An implicit geometry that is read.
  struct ImplicitParts {
    Placement placement{};
    GeometryTree::NodeId node = GeometryTree::kNone;
    bool has_matrix = true, has_reference = false;
  };
  ImplicitParts implicit_{};
  Box3 envelope_{};
};

}  // namespace citymesh::source
