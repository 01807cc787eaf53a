#pragma once

#include <cstdint>
#include <span>
#include <stop_token>

#include "core/base/result.h"
#include "core/citymodel/terrain.h"
#include "core/source/catalogue.h"
#include "core/source/source.h"
#include "services/citydb/postgres.h"
#include "services/citydb/schema.h"

namespace citymesh::citydb {

struct TerrainQuery {
  RequestBox bbox{};  ///< a box or a region, in any CRS
  int max_lod = 4;
  std::uint32_t max_triangles = 1'000'000;  ///< while they are read, about 400 bytes each
};

/// The triangles of the TIN relief (CityGML's TINRelief) that touch the box, at the finest level up
/// to `max_lod` of which there are any. A component that has another face than triangles in the box
/// is left out as a whole, as are mass points, break lines and rasters, and components without an
/// envelope are not found. Present are components of a present ReliefFeature, or of none. One
/// statement finds them, one more for each level tried reads them; the snapshot is that of the
/// connection's transaction. No process reads terrain yet. Errors: ResourceExhausted for more
/// triangles than allowed, InvalidArgument for a box that cannot be moved to the CRS of the
/// database, those of Connection::run().
Result<Terrain> read_terrain(postgres::Connection& connection, const Instance& instance,
                             const TerrainQuery& query, const std::stop_token& stop);

/// What read_terrain() asks, for who explains it: components (id, gml:id, class, LoD, id of the
/// geometry), and faces of geometries (id of the geometry, number, EWKB or NULL for more corners
/// than a triangle has) that meet a box in the CRS of the database. At most `limit` rows.
postgres::Statement terrain_components(const Instance& instance, const source::FlatBox& box,
                                       std::uint64_t limit);
postgres::Statement terrain_faces(const Instance& instance,
                                  std::span<const std::int64_t> geometries,
                                  const source::FlatBox& box, std::uint64_t limit);

}  // namespace citymesh::citydb
