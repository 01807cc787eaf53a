#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/geometry/point.h"

namespace citymesh {

/// A coordinate reference system by its canonical id: "EPSG:25833", compound "EPSG:25833+5783",
/// "OGC:CRS84", "LOCAL" for an engineering CRS, "" when none is stated.
struct Crs {
  std::string id{};
  bool known() const { return !id.empty() && id != "LOCAL"; }
  friend bool operator==(const Crs&, const Crs&) = default;
};

/// Reads every spelling of srsName that CityGML and CityJSON files use (urn, compound urn, http
/// URI, gml/srs, EPSG:n, AdV names by table). Errors: InvalidArgument naming the text.
Result<Crs> parse_crs(std::string_view srs_name);

/// What PROJ says of a CRS.
struct CrsFacts {
  std::string name{};
  bool geographic = false;         ///< horizontal part in degrees
  bool north_first = false;        ///< registry order is north or latitude before east or longitude
  double horizontal_unit_m = 1.0;  ///< metres in a unit of the projected axes
  std::string vertical_name{};     ///< of the heights: "DHHN2016 height"; "" where none is stated
  double vertical_unit_m = 1.0;    ///< metres in a unit of the heights: as the vertical CRS says,
                                   ///< else as the projected axes have it
  Box3 area_of_use_deg{};          ///< x longitude, y latitude; empty when unknown
};

/// Errors: InvalidArgument when PROJ does not know the CRS.
Result<CrsFacts> describe_crs(const Crs& crs);

/// The projected CRS in metres to work in: `crs` itself, or for one in degrees or feet the UTM zone
/// of the same datum at `centre`, a place in `crs` (x east or longitude). JGD2011: EPSG:6688–6692,
/// ETRS89: 25828–25838, WGS84: 326xx/327xx. The CRS of the heights stays part of the id
/// ("EPSG:6691+6695"); heights in feet become those of its twin in metres, or unnamed without one.
Result<Crs> working_crs(const Crs& crs, const Point3& centre);

/// `crs` with the vertical CRS of `heights` where it has none itself.
Crs with_vertical(const Crs& crs, const Crs& heights);

/// Moves coordinates between two CRSs. Axes are always x east/longitude, y north/latitude on both
/// sides. Heights are brought to the unit of the target, feet to metres; the vertical datum is kept
/// and named, never shifted. Not thread-safe: one per thread.
class Transformer {
 public:
  static Result<Transformer> create(const Crs& from, const Crs& to);
  /// To longitude and latitude of the CRS's own datum: much cheaper to make than one between
  /// datums.
  static Result<Transformer> to_degrees(const Crs& from);
  Transformer(Transformer&&) noexcept;
  Transformer& operator=(Transformer&&) noexcept;
  ~Transformer();

  bool is_identity() const;
  /// Errors: InvalidArgument naming the first coordinate that cannot be transformed.
  Result<void> apply(std::span<Point3> points) const;

 private:
  struct Impl;
  explicit Transformer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace citymesh
