#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/source/feature.h"
#include "core/source/json_text.h"

namespace simdjson::dom {
class array;
class element;
class object;
}  // namespace simdjson::dom

/// What the readers of JSON documents with a list of features share.
namespace citymesh::source {

/// A JSON document in which `features` stand, parsed one at a time.
class JsonFeatures {
 public:
  JsonFeatures(const RandomReader& file, const DocumentOptions& options, DocumentFacts& facts);
  ~JsonFeatures();
  JsonFeatures(const JsonFeatures&) = delete;
  JsonFeatures& operator=(const JsonFeatures&) = delete;

  /// Finds the features, or takes the document itself as the only one when its `type` is
  /// `lone_type`. false: `facts.failure` says why not.
  bool open(std::string_view lone_type);

  /// A member of the document as an object with nothing else in it; nullptr when there is none or
  /// it cannot be parsed. Lives until the next call.
  const simdjson::dom::object* head(std::string_view member);

  std::size_t size() const { return features_.size(); }
  /// nullptr for what cannot be parsed, which `facts.failure` names. Lives until the next call.
  const simdjson::dom::object* feature(std::size_t i);

 private:
  struct Parser;
  const simdjson::dom::object* parse(const std::string& text, std::uint64_t line,
                                     const std::string& what);

  DocumentFacts& facts_;
  std::uint64_t max_bytes_;
  JsonText json_;
  std::vector<JsonMember> members_{};
  std::vector<JsonSlice> features_{};
  std::unique_ptr<Parser> parser_;
};

/// Texts, numbers and truth values as they are, lists and objects as JSON text; null is left out.
Attributes attributes_from(const simdjson::dom::object& members);

/// Empties the feature and makes it the building of a JSON feature: its `id` (else numbered) and
/// its `properties`, without geometry.
void begin_feature(const simdjson::dom::object& object, std::size_t number,
                   const DocumentOptions& options, Feature& feature);

/// What a corner of a ring turned out to be.
enum class CornerState { Ok, Malformed, OutOfRange };
/// Reads a corner; `stated` is what to name it by in an issue.
using ReadCorner =
    std::function<CornerState(const simdjson::dom::element&, Point3&, double& stated)>;

/// Appends geometries to the first object of a feature.
class JsonShapes {
 public:
  /// `closed_rings`: as in Geometry.
  JsonShapes(Feature& feature, std::uint64_t max_points, bool closed_rings)
      : feature_(feature), max_points_(max_points), closed_rings_(closed_rings) {}

  /// Lists of rings, nested as the type requires. `srs` is that of the coordinates.
  void add(GeometryType type, const simdjson::dom::array& boundaries, const ReadCorner& corner,
           std::uint32_t srs);
  void unreadable(const std::string& what);
  /// Afterwards a feature with more points than allowed has no geometry but an issue.
  void finish();

 private:
  bool too_large() const { return feature_.points.size() > max_points_; }
  void report(int code, const std::string& what, double measured = 0);
  bool add_solid(const simdjson::dom::array& shells, RawShape& shape);
  bool add_surfaces(const simdjson::dom::array& surfaces, RawShape& shape);
  bool add_ring(const simdjson::dom::array& corners, RawPolygon& polygon);

  Feature& feature_;
  std::uint64_t max_points_;
  bool closed_rings_;
  const ReadCorner* corner_ = nullptr;
  std::uint32_t srs_ = 0;
};

/// The types of solids and surfaces as CityJSON and tu3djson call them.
std::optional<GeometryType> geometry_type_from(std::string_view name);

}  // namespace citymesh::source
