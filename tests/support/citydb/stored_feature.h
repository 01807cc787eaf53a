#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/source/feature.h"
#include "tests/support/citydb/ewkb.h"
#include "tests/support/citydb/loader.h"

namespace citymesh::citydb_support {

/// A building as both stores see it: at its place, with an id for everything.
class StoredFeature {
 public:
  struct Place {
    std::vector<bool> swap_axes{};  ///< by index of DocumentFacts::srs_names
    double dx = 0, dy = 0;
    std::string suffix{};  ///< of ids
    bool citygml3 = false;
  };
  /// The geometry of a boundary surface or an opening at one LoD.
  struct SurfaceGeometry {
    std::size_t surface = 0;
    int lod = 0;
    std::vector<source::PolygonUse> uses{};
  };

  StoredFeature(const source::Feature& feature, const Place& place, LoadReport& report)
      : feature_(feature), place_(place), report_(report) {}

  const source::Feature& feature() const { return feature_; }
  const std::vector<source::RawObject>& objects() const { return feature_.objects; }
  bool citygml3() const { return place_.citygml3; }

  /// None when nothing of the polygon can be stored. The box grows by what is.
  std::optional<Rings> rings(const source::PolygonUse& use, Box3& box) const;
  std::string id(const std::string& gml_id, const std::string& otherwise_unique) const;
  std::string polygon_id(std::uint32_t polygon) const;
  bool is_borrowed(std::uint32_t polygon) const;
  /// Does a surface of the building have the polygon too?
  bool is_shared(std::uint32_t polygon) const { return feature_.polygons[polygon].surface >= 0; }

  /// In the order of LoDs, then of surfaces.
  std::vector<SurfaceGeometry> surface_geometries(std::size_t object) const;

 private:
  void add_inner_surfaces(std::size_t object, std::vector<SurfaceGeometry>& all) const;

  const source::Feature& feature_;
  const Place& place_;
  LoadReport& report_;
};

/// "ID_<uuid>", the same for the same text.
std::string generated_id(const std::string& unique);

/// "2008-10-15" with what a timestamp needs besides; none when the text is no date.
std::optional<std::string> timestamp_from(const std::string& text);
/// The first of January of a year; none when it is no year.
std::optional<std::string> new_year_of(const AttributeValue& value);
std::string text_of(const AttributeValue& value);
/// "set" and "name" of "set.name"; no set otherwise.
std::pair<std::string, std::string> split_set(const std::string& name);
std::vector<std::string> split_values(const std::string& text);

}  // namespace citymesh::citydb_support
