#pragma once

#include <cstdint>
#include <functional>
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
};

struct RawShape {
  GeometryType type = GeometryType::MultiSurface;
  Lod lod{};
  bool assembled = false;
  bool footprint = false;
  std::vector<PolygonUse> uses{};
  std::vector<Solid> solids{};  ///< indices into `uses`
};

struct RawObject {
  std::string gml_id{};
  std::int32_t parent = -1;  ///< index into Feature::objects
  std::vector<Surface> surfaces{};
  std::vector<RawShape> shapes{};
  Attributes attributes{};
  std::vector<Issue> issues{};
  std::uint32_t skipped_installations = 0;
  std::uint32_t skipped_ade_elements = 0;
};

struct Feature {
  std::vector<Point3> points{};
  std::vector<RawRing> rings{};
  std::vector<RawPolygon> polygons{};
  std::vector<RawObject> objects{};  ///< the first is the top-level building, parents before parts
  std::uint32_t srs = 0;             ///< what polygons without own srsName inherit

  void clear() {
    points.clear();
    rings.clear();
    polygons.clear();
    objects.clear();
    srs = 0;
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

/// Geometry that features of a document borrow from other features, by gml:id.
struct SharedGeometry {
  Feature pool{};
  TextMap<std::vector<PolygonUse>> by_id{};
};

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
  std::uint64_t skipped_objects = 0;  ///< city objects of extension types

  std::uint32_t intern_srs(std::string_view name);
};

struct DocumentOptions {
  ReadLimits limits{};
  std::string stem{};  ///< for ids of features that have none
  std::stop_token stop{};
  const SharedGeometry* shared = nullptr;  ///< resolves what a feature does not contain
};

/// Takes a feature; it may be emptied, its memory is used again.
using FeatureSink = std::function<Result<void>(Feature&)>;

/// "<stem>_<n>", n counting top-level buildings from 1.
std::string numbered_id(std::string_view stem, std::uint64_t n);

}  // namespace citymesh::source
