#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh::citydb_support {

/// Closed rings of a polygon, the exterior first.
using Rings = std::vector<std::vector<Point3>>;

/// Geometry with heights as PostGIS reads it from text: hexadecimal EWKB.
class Ewkb {
 public:
  enum class Type : std::uint32_t {
    Polygon = 3,
    MultiPolygon = 6,
    GeometryCollection = 7,
    PolyhedralSurface = 15,
  };

  explicit Ewkb(int srid) : srid_(srid) {}
  /// What `count` geometries make that are added next.
  Ewkb& collection(Type type, std::size_t count);
  Ewkb& polygon(const Rings& rings);
  std::string take() { return std::move(hex_); }

 private:
  void head(Type type);
  void whole(std::uint32_t value);
  void number(double value);
  void bytes(const void* from, std::size_t count);

  int srid_;  ///< stands at the outermost geometry only
  std::string hex_{};
};

/// A tilted rectangle from the lower to the upper corner, as both importers store envelopes.
std::string envelope_ewkb(const Box3& box, int srid);

}  // namespace citymesh::citydb_support
