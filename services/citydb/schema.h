#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/building.h"
#include "core/source/catalogue.h"
#include "services/citydb/feature_builder.h"
#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// What an object of the database is to us, by its class.
struct ObjectClass {
  std::string name{};
  std::optional<ObjectKind> kind{};  ///< none: a surface, or nothing that we read
  std::optional<SurfaceType> surface{};
};

/// A 3DCityDB as it was found.
struct Instance {
  std::string version{};   ///< "4.4.0", "5.1"; without the package only the first number
  int major = 0;           ///< 4 or 5
  std::string srs_name{};  ///< as the database names its CRS, else by its SRID
  int srid = 0;
  std::map<std::int64_t, ObjectClass> classes{};  ///< by id

  std::vector<std::int64_t> ids_of(ObjectKind kind) const;
};

/// Finds out what a database is. Errors: FailedPrecondition when it is no 3DCityDB that we can
/// read, those of the connection.
Result<Instance> look_at(postgres::Connection& connection, const std::string& schema,
                         const std::stop_token& stop);

/// A top-level building as the index of the database knows it.
struct Candidate {
  std::int64_t id = 0;
  std::string gml_id{};
  Box3 envelope{};  ///< empty: none stored
};

/// The answers about the buildings of a chunk, as they came.
struct Tables {
  std::vector<std::int64_t> ids{};
  std::vector<postgres::Rows> rows{};
  std::vector<postgres::Statement> sent{};  ///< what was asked, for who measures and explains it
};

/// Where the two versions keep the same things. Objects are values without state of their own: for
/// several threads.
class Schema {
 public:
  virtual ~Schema() = default;

  /// Present top-level buildings in the order of their ids (id, gml:id, least x, y, z and greatest
  /// x, y, z of the envelope): those whose envelope meets a box, or all.
  virtual postgres::Statement candidates(const Instance& instance,
                                         const std::optional<source::FlatBox>& box) const = 0;
  /// One row: the number of present top-level buildings and the extent of their envelopes (least
  /// x, y, z, greatest x, y, z).
  virtual postgres::Statement extent(const Instance& instance) const = 0;
  /// One row: the number of present top-level buildings without an envelope, which no box finds.
  /// None are counted, which is cheap, where the statistics of the database know of no object
  /// without one.
  virtual postgres::Statement without_envelope(const Instance& instance) const = 0;
  /// The SQL by which an operator has 3DCityDB compute the envelopes that are missing.
  virtual std::string sql_for_envelopes(const std::string& schema) const = 0;
  /// Those that have, or a part of which has, one of these gml:ids.
  virtual postgres::Statement candidates_by_id(const Instance& instance,
                                               std::span<const std::string> gml_ids) const = 0;
  /// (id of the building, gml:id) of parts and installations, in the order of both ids.
  virtual postgres::Statement members(const Instance& instance,
                                      std::span<const std::int64_t> ids) const = 0;

  /// All that is to be known of these buildings, by a constant number of statements.
  virtual Result<Tables> fetch(postgres::Connection& connection, const Instance& instance,
                               std::vector<std::int64_t> ids,
                               const std::stop_token& stop) const = 0;
  /// Hands over the buildings in the order of their ids.
  virtual Result<void> build(const Tables& tables, const Instance& instance,
                             FeatureBuilder& builder, const source::FeatureSink& sink) const = 0;
};

/// Schema::candidates(): `all` takes the classes of buildings, `in_box` also least x and y,
/// greatest x and y, and the SRID of the box.
postgres::Statement candidates_of(const char* all, const char* in_box, const Instance& instance,
                                  const std::optional<source::FlatBox>& box);

std::unique_ptr<const Schema> schema_v4();
std::unique_ptr<const Schema> schema_v5();
std::unique_ptr<const Schema> schema_of(const Instance& instance);

}  // namespace citymesh::citydb
