#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "tests/support/citydb/cluster.h"
#include "tests/support/citydb/database.h"

namespace citymesh::citydb_support {

/// Which 3DCityDB an empty database becomes: 4 is 4.4, 5 with minor 0 has json, with 1 jsonb.
struct Schema {
  int major = 5;
  int minor = 1;
  int srid = 25832;
  std::string name = "citydb";
  friend bool operator==(const Schema&, const Schema&) = default;
};

/// The database server of a test program: the one that CITYMESH_TEST_CITYDB names by URL, whose
/// user may create databases, else a private cluster. Started at the first use, gone at the end of
/// the program with all databases that it made.
class TestServer {
 public:
  /// Errors: Unimplemented when there is none because packages are missing.
  static Result<TestServer*> get();
  ~TestServer();
  TestServer(const TestServer&) = delete;
  TestServer& operator=(const TestServer&) = delete;

  /// A new empty 3DCityDB; its URL.
  Result<std::string> create_citydb(const Schema& schema);
  /// A new database without anything; its URL.
  Result<std::string> create_database();
  /// A database as a copy of one that has no connections; the URL of the copy.
  Result<std::string> copy_database(const std::string& url);

  /// The private cluster, to stop and to kill; null where the server is somebody else's.
  Cluster* cluster() { return cluster_.get(); }

 private:
  TestServer() = default;
  static Result<std::unique_ptr<TestServer>> start();
  Result<std::string> create(const std::string& options);

  std::unique_ptr<Cluster> cluster_{};
  std::string url_{};  ///< of the database where others are made
  std::vector<std::string> databases_{};
  std::map<std::string, std::string> templates_{};  ///< by schema: URL of an empty one
};

/// Makes an empty database a 3DCityDB.
Result<void> create_schema(const std::string& url, const Schema& schema);

/// Replaces psql's :name, :'name' and :"name" by the variables.
std::string with_variables(std::string_view sql,
                           const std::map<std::string, std::string, std::less<>>& variables);

/// A file of this folder.
Result<std::string> citydb_file(const std::string& name);

}  // namespace citymesh::citydb_support
