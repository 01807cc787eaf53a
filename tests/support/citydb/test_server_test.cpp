#include "tests/support/citydb/test_server.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/citydb/citydb_test.h"

namespace citymesh::citydb_support {
namespace {

class TestServers : public CityDbTest {
 protected:
  std::string value_of(const std::string& url, const std::string& sql) {
    auto database = Database::open(url);
    if (!database) return database.error().message;
    auto value = database->value(sql);
    return value ? *value : value.error().message;
  }
  std::string new_citydb(const Schema& schema) {
    auto url = server().create_citydb(schema);
    EXPECT_TRUE(url) << url.error().message;
    return url ? *url : "";
  }
};

TEST_F(TestServers, MakesEmptyDatabasesOfEveryVersion) {
  constexpr const char* kVersion = "SELECT version FROM citydb_pkg.citydb_version()";
  constexpr const char* kJson =
      "SELECT data_type FROM information_schema.columns WHERE column_name = 'geometry_properties'";
  const std::string v4 = new_citydb({.major = 4, .srid = 25833});
  EXPECT_EQ(value_of(v4, kVersion), "4.4.2");
  EXPECT_EQ(value_of(v4, "SELECT schema_srid FROM citydb_pkg.db_metadata('citydb')"), "25833");
  EXPECT_EQ(value_of(v4, "SELECT Find_SRID('citydb', 'surface_geometry', 'geometry')"), "25833");
  EXPECT_EQ(value_of(v4, "SELECT Find_SRID('citydb', 'surface_geometry', 'implicit_geometry')"),
            "0");
  const std::string v50 = new_citydb({.major = 5, .minor = 0});
  EXPECT_EQ(value_of(v50, kVersion), "5.0.0");
  EXPECT_EQ(value_of(v50, kJson), "json");
  const std::string v51 = new_citydb({.major = 5, .minor = 1});
  EXPECT_EQ(value_of(v51, kVersion), "5.1.3");
  EXPECT_EQ(value_of(v51, kJson), "jsonb");
  EXPECT_EQ(value_of(v51, "SELECT srs_name FROM citydb_pkg.db_metadata()"),
            "urn:ogc:def:crs:EPSG::25832");
}

TEST_F(TestServers, SearchesTheSchemaThatItWasToldOf) {
  const std::string url = new_citydb({.name = "my_city"});
  EXPECT_EQ(value_of(url, "SELECT count(*) FROM feature"), "0");
  EXPECT_EQ(value_of(url, "SELECT to_regclass('my_city.geometry_data')"), "geometry_data");
}

TEST_F(TestServers, DatabasesOfOneSchemaAreSeparate) {
  const std::string one = new_citydb({}), other = new_citydb({});
  ASSERT_TRUE(Database::open(one)->run("INSERT INTO feature (id, objectclass_id) VALUES (1, 901)"));
  EXPECT_EQ(value_of(other, "SELECT count(*) FROM feature"), "0");
  const auto copy = server().copy_database(one);
  ASSERT_TRUE(copy) << copy.error().message;
  EXPECT_EQ(value_of(*copy, "SELECT objectclass_id FROM feature"), "901");
}

TEST_F(TestServers, DataOutlivesARestartAndACrash) {
  Cluster* const cluster = server().cluster();
  if (!cluster) GTEST_SKIP() << "the server of CITYMESH_TEST_CITYDB is not ours to stop";
  const auto url = server().create_database();
  ASSERT_TRUE(url) << url.error().message;
  auto database = Database::open(*url);
  ASSERT_TRUE(database && database->run("CREATE TABLE t AS SELECT 7 AS x"));
  ASSERT_TRUE(cluster->restart());
  EXPECT_FALSE(database->run("SELECT 1"));
  EXPECT_EQ(value_of(*url, "SELECT x FROM t"), "7");
  ASSERT_TRUE(cluster->kill());
  EXPECT_FALSE(Database::open(*url));
  ASSERT_TRUE(cluster->start_again());
  EXPECT_EQ(value_of(*url, "SELECT x FROM t"), "7");
}

TEST_F(TestServers, AClusterEndsWithTheProcessThatHasIt) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto cluster = Cluster::start();
    const std::string url = cluster ? (*cluster)->url("x") : "";
    const auto sent = ::write(pipe[1], url.data(), url.size());
    ::kill(::getpid(), sent > 0 ? SIGKILL : SIGTERM);
  }
  ::close(pipe[1]);
  std::string url(500, '\0');
  const ssize_t count = ::read(pipe[0], url.data(), url.size());
  ::close(pipe[0]);
  ASSERT_GT(count, 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const std::size_t begin = url.find("host=") + 5;
  const std::filesystem::path folder = url.substr(begin, url.find('&') - begin);
  for (int i = 0; i < 300 && std::filesystem::exists(folder); ++i) ::usleep(100'000);
  EXPECT_FALSE(std::filesystem::exists(folder)) << folder;
}

TEST(SqlVariables, AreReplacedAsPsqlDoes) {
  const std::map<std::string, std::string, std::less<>> variables{{"srid", "25832"},
                                                                  {"name", "it's"}};
  EXPECT_EQ(with_variables("a(:srid) :'name' :\"name\" b::text :'srid'::text :other ':", variables),
            "a(25832) 'it''s' \"it's\" b::text '25832'::text :other ':");
}

}  // namespace
}  // namespace citymesh::citydb_support
