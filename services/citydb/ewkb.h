#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/source/feature.h"

namespace citymesh::citydb {

/// A polygon read from the database, without the closing repetition taken away.
struct RingRun {
  std::uint32_t first = 0, count = 0;
};
struct StoredPolygon {
  std::uint32_t first_ring = 0, ring_count = 0;
};

/// Polygons of geometries, one after another; emptied and used again.
struct StoredPolygons {
  std::vector<Point3> points{};
  std::vector<RingRun> rings{};
  std::vector<StoredPolygon> polygons{};

  void clear();
};

/// Adds the polygons of a geometry in PostGIS's extended well-known binary: Polygon, Triangle,
/// MultiPolygon, PolyhedralSurface, TIN and collections of them, with three coordinates. Others
/// (points, lines) add nothing. `members`: how many polygons each direct member of a collection
/// added (one entry for what is no collection). Errors: DataLoss for bytes that are none of that.
Result<void> add_ewkb(std::string_view bytes, StoredPolygons& to,
                      std::vector<std::uint32_t>* members = nullptr);

/// The point of a Point. Errors: DataLoss.
Result<Point3> point_of_ewkb(std::string_view bytes);

}  // namespace citymesh::citydb
