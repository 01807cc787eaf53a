#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/citymodel/mesh.h"

namespace citymesh::citydb {

/// Faces of a mesh as PostGIS reads geometry from text: hexadecimal EWKB. Coordinates are those of
/// the CRS, each the double nearest to its place on the grid.
class GeometryText {
 public:
  enum class Type : std::uint32_t {
    Polygon = 3,
    MultiPolygon = 6,
    GeometryCollection = 7,
    PolyhedralSurface = 15,
  };

  GeometryText(const TriangleMesh& mesh, const Point3& origin, int srid)
      : mesh_(mesh), origin_(origin), srid_(srid) {}

  /// What `count` geometries make that are added next.
  void collection(Type type, std::size_t count);
  void polygon(std::size_t face);
  std::string take();

  /// Adds the corners of a face to a box.
  void extend(Box3& box, std::size_t face) const;

 private:
  void head(Type type);
  void whole(std::uint32_t value);
  Point3 place_of(std::uint32_t corner) const;
  void point(const Point3& place);
  void bytes(const void* from, std::size_t count);

  const TriangleMesh& mesh_;
  const Point3 origin_;
  const int srid_;  ///< stands at the outermost geometry only
  std::string hex_{};

  friend std::string envelope_text(const Box3& box, int srid);
};

/// A tilted rectangle from the lower to the upper corner, as the importers store envelopes.
std::string envelope_text(const Box3& box, int srid);

}  // namespace citymesh::citydb
