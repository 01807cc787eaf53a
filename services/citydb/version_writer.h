#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/write/city_objects.h"
#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// What all rows of a job say of where they come from.
struct Stamp {
  std::string lineage{};  ///< id of the job
  std::string created{};  ///< the beginning of its transaction, as PostgreSQL writes it
  std::string reason{};   ///< before the rung
  Point3 origin{};        ///< of the meshes, in the CRS of the schema
  int srid = 0;
};

/// Ids of what a schema has names for: "class Building", "type GeometryProperty", "space core".
using NamedIds = std::map<std::string, std::int64_t, std::less<>>;

/// The rows of buildings, as one version of 3DCityDB has them. Memory is bounded by what flush()
/// sends.
class VersionWriter {
 public:
  virtual ~VersionWriter() = default;

  virtual Result<void> add(const BuildingBodies& building, const std::stop_token& stop) = 0;
  virtual std::size_t bytes() const = 0;  ///< of rows not sent yet
  virtual Result<void> flush(const std::stop_token& stop) = 0;

  /// Ids of the rows of top-level buildings, all that were added.
  const std::vector<std::int64_t>& buildings() const { return buildings_; }
  /// Interior shells, for which there is no place.
  std::uint64_t left_out_cavities() const { return cavities_; }

 protected:
  std::vector<std::int64_t> buildings_{};
  std::uint64_t cavities_ = 0;
};

/// The statements that one version needs besides. Versions end in the order of the transactions
/// that end them; rows of the transaction itself are known by their creation_date, now().
struct VersionSql {
  const char* names;     ///< (name, id) for NamedIds
  const char* lock;      ///< keeps the tables in place until the end of the transaction
  const char* in_place;  ///< whether the names without a schema are those of schema $1
  /// With $1 for the lineage: what earlier transactions with it ended is current again, what they
  /// wrote is gone.
  std::vector<const char*> withdraw;
  /// Ends the versions that the buildings $1, bigint[], take the place of.
  const char* supersede;
};

const VersionSql& sql_v4();
const VersionSql& sql_v5();

/// The connection must outlive the writer.
std::unique_ptr<VersionWriter> writer_v4(postgres::Connection& connection, NamedIds names,
                                         Stamp stamp);
std::unique_ptr<VersionWriter> writer_v5(postgres::Connection& connection, NamedIds names,
                                         Stamp stamp);

/// The gml:id of an object as it came, or one made of its name.
std::string stored_id(const CityObject& object);

}  // namespace citymesh::citydb
