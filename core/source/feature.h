#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/building.h"
#include "core/source/source.h"

/// What the format readers hand over: one top-level building with its parts as the file states it,
/// in the file's coordinates and axis order.
namespace citymesh::source {

/// A run of Feature::points.
struct RawRing {
  std::uint32_t first = 0, count = 0;
};

struct RawPolygon {
  std::string gml_id{};
  std::uint32_t first_ring = 0, ring_count = 0;  ///< run of Feature::rings, exterior first
  std::int32_t object = -1;                      ///< index into Feature::objects that has `surface`
  std::int32_t surface = -1;                     ///< index into RawObject::surfaces
  std::uint32_t srs = 0;                         ///< index into DocumentFacts::srs_names
  bool usable = true;                            ///< false: an issue says why
};

struct PolygonUse {
  std::uint32_t polygon = 0;
  bool reversed = false;
  std::int32_t surface = -1;  ///< where it is another one than the polygon's own
};

struct RawShape {
  GeometryType type = GeometryType::MultiSurface;
  Lod lod{};
  bool assembled = false;
  bool footprint = false;
  bool closed_rings = false;  ///< as in Geometry
  std::vector<PolygonUse> uses{};
  std::vector<Solid> solids{};  ///< indices into `uses`
};

struct RawObject {
  ObjectKind kind = ObjectKind::Building;
  std::string gml_id{};
  std::int32_t parent = -1;  ///< index into Feature::objects
  std::vector<Surface> surfaces{};
  std::vector<RawShape> shapes{};
  Attributes attributes{};
  std::vector<Address> addresses{};
  std::vector<Issue> issues{};
  std::map<std::string, std::uint32_t> skipped_ade_elements{};
  bool inside = false;  ///< an installation in the building's interior: not delivered
};

/// Where in the unpacked text of a document something stands.
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
  bool known() const { return end > begin; }
  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// What must stand around a piece of a document so that it can be read by itself: the start tags
/// around the features of an XML document, the first line of a CityJSONSeq.
struct Envelope {
  std::string before{}, after{};
  std::uint32_t srs = 0;       ///< what features inherit from what is left out
  std::uint8_t dimension = 3;  ///< likewise
  friend bool operator==(const Envelope&, const Envelope&) = default;
};

struct Feature {
  std::vector<Point3> points{};
  std::vector<RawRing> rings{};
  std::vector<RawPolygon> polygons{};
  std::vector<RawObject> objects{};  ///< the first is the top-level building, parents before what
                                     ///< belongs to them
  std::uint32_t srs = 0;             ///< what polygons without own srsName inherit
  ByteRange bytes{};                 ///< unknown where the document cannot be read in pieces
  std::uint32_t envelope = 0;        ///< index into DocumentFacts::envelopes
  std::set<std::string> borrowed{};  ///< gml:id of geometry that other features have

  void clear() {
    points.clear();
    rings.clear();
    polygons.clear();
    objects.clear();
    srs = 0;
    bytes = {};
    envelope = 0;
    borrowed.clear();
  }
};

/// Text hashed without making a string of it.
struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>{}(text);
  }
};
template <class Value>
using TextMap = std::unordered_map<std::string, Value, TextHash, std::equal_to<>>;

/// Where geometry that several features use is to be found.
struct SharedPlace {
  ByteRange bytes{};  ///< of the feature that has it; unknown where there are no pieces
  std::uint32_t envelope = 0;
};

struct SharedGeometry;  // citygml_shapes.h

/// Counted among DocumentFacts::skipped_types.
inline constexpr std::string_view kSharedAddress = "address by xlink:href";

/// What is known of a document besides its buildings.
struct DocumentFacts {
  std::string format{};                    ///< "CityGML 2.0"
  std::string failure{};                   ///< why reading ended early, with the line; else empty
  bool not_a_city_model = false;           ///< failed because it is something else
  std::vector<std::string> srs_names{""};  ///< as spelt; the first stands for none
  Box3 declared_extent{};                  ///< empty: none
  std::uint32_t declared_srs = 0;
  std::set<std::string, std::less<>>
      unresolved{};                   ///< ids that features refer to and that they do not contain
  std::vector<Envelope> envelopes{};  ///< of pieces of the document, usually one
  std::uint64_t skipped_objects = 0;  ///< city objects of extension types
  std::map<std::string, std::uint64_t> skipped_types{};  ///< the same and others, by name

  std::uint32_t intern_srs(std::string_view name);
  void count_skipped(std::string_view type);  ///< in `skipped_types`
};

struct DocumentOptions {
  ReadLimits limits{};
  std::string stem{};  ///< for ids of features that have none
  std::stop_token stop{};
  const SharedGeometry* shared = nullptr;  ///< resolves what a feature does not contain
  const Envelope* piece = nullptr;         ///< set: the document is a piece in this envelope
  std::uint64_t buildings_before = 0;      ///< in the document, of a piece
};

/// Counts a name as long as the names are few: a document may invent any number.
template <class Count>
void count_name(std::map<std::string, Count>& counts, std::string_view name) {
  constexpr std::size_t kMaxNames = 200, kMaxBytes = 100;
  const std::string key(name.substr(0, kMaxBytes));
  if (counts.size() < kMaxNames || counts.contains(key)) ++counts[key];
}

/// Takes a feature; it may be emptied, its memory is used again.
using FeatureSink = std::function<Result<void>(Feature&)>;

/// "<stem>_<n>", n counting top-level buildings from 1.
std::string numbered_id(std::string_view stem, std::uint64_t n);

}  // namespace citymesh::source
