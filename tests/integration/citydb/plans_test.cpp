#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/citydb/citydb.h"
#include "services/citydb/schema.h"
#include "services/citydb/terrain.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/database.h"
#include "tests/support/citydb/loader.h"

namespace citymesh {
namespace {

using citydb_support::Database;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint32_t kCopies = 61;  // of 166 buildings: 10,126

/// A city of ten thousand buildings.
class PlansOfStatements : public citydb_support::CityDbTest,
                          public testing::WithParamInterface<int> {};

TEST_P(PlansOfStatements, NoTableOfObjectsOrGeometryIsReadThrough) {
  citydb_support::LoadOptions options;
  options.schema.major = GetParam();
  options.schema.srid = 25833;
  options.copies = kCopies;
  const auto url = server().create_citydb(options.schema);
  ASSERT_TRUE(url) << url.error().message;
  const auto loaded =
      citydb_support::load(*url, options, CITYMESH_TEST_DATA "/berlin/3910_5817.gml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_GE(loaded->buildings, 10'000u);
  auto database = Database::open(*url);
  ASSERT_TRUE(database);
  // One copy has no envelopes.
  ASSERT_TRUE(database->run(
      GetParam() == 4 ? "UPDATE citydb.cityobject SET envelope = NULL"
                        " WHERE objectclass_id = 26 AND gmlid LIKE '%#_c7' ESCAPE '#'"
                      : "UPDATE citydb.feature SET envelope = NULL"
                        " WHERE objectclass_id = 901 AND objectid LIKE '%#_c7' ESCAPE '#'"));
  ASSERT_TRUE(database->run("ANALYZE"));
  ASSERT_TRUE(database->run("SET search_path TO citydb, public"));

  auto connection = postgres::Connection::open({.url = *url});
  ASSERT_TRUE(connection) << connection.error().message;
  const std::vector<postgres::Statement> path{{"SET search_path TO citydb, public"}};
  ASSERT_TRUE(connection->run(path, {}));
  const auto instance = citydb::look_at(*connection, "citydb", {});
  ASSERT_TRUE(instance) << instance.error().message;
  const bool old = GetParam() == 4;
  const auto schema = citydb::schema_of(*instance);

  // A box around one copy: less than one building in a hundred.
  const auto extent = database->rows(
      "SELECT ST_XMin(e), ST_YMin(e), ST_XMin(e) + 60, ST_YMin(e) + 60 FROM (SELECT"
      " ST_Extent(envelope) AS e FROM " +
      std::string(old ? "cityobject WHERE objectclass_id = 26 AND gmlid"
                      : "feature WHERE objectclass_id = 901 AND objectid") +
      " NOT LIKE '%#_c%' ESCAPE '#') x");
  ASSERT_TRUE(extent) << extent.error().message;
  const auto number = [&](std::size_t c) { return std::stod(*extent->front()[c]); };
  const source::FlatBox box{{number(0), number(1)}, {number(2), number(3)}};
  const auto found = connection->run(schema->candidates(*instance, box), {});
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_GT(found->size(), 0);
  ASSERT_LE(found->size(), 101);

  std::vector<std::int64_t> ids;
  for (int row = 0; row < found->size(); ++row) ids.push_back(found->integer(row, 0));
  const std::vector<std::string> gml_ids{std::string(found->text(0, 1))};
  const auto tables = schema->fetch(*connection, *instance, ids, {});
  ASSERT_TRUE(tables) << tables.error().message;
  const auto unfindable = connection->run(schema->without_envelope(*instance), {});
  ASSERT_TRUE(unfindable) << unfindable.error().message;
  EXPECT_EQ(unfindable->integer(0, 0), 166);
  auto statements = tables->sent;
  statements.push_back(schema->without_envelope(*instance));
  statements.push_back(schema->candidates(*instance, box));
  statements.push_back(schema->candidates_by_id(*instance, gml_ids));
  statements.push_back(schema->members(*instance, ids));
  EXPECT_LE(statements.size(), 11u) << "a constant number, none per building";
  const auto geometry = database->value(old ? "SELECT max(root_id) FROM surface_geometry"
                                            : "SELECT max(id) FROM geometry_data");
  ASSERT_TRUE(geometry) << geometry.error().message;
  const std::vector<std::int64_t> geometries{std::stoll(*geometry)};
  statements.push_back(citydb::terrain_components(*instance, box, 1000));
  statements.push_back(citydb::terrain_faces(*instance, geometries, box, 1000));
  for (const auto& statement : statements) {
    const auto plan = database->rows(
        "EXPLAIN " + citydb_support::with_literals(statement.sql, statement.parameters));
    ASSERT_TRUE(plan) << statement.sql << ": " << plan.error().message;
    std::string text;
    for (const auto& row : *plan) text += *row.front() + '\n';
    for (const auto* table : {"cityobject", "surface_geometry", "thematic_surface", "building",
                              "feature", "property", "geometry_data"})
      EXPECT_THAT(text, Not(HasSubstr(fmt::format("Seq Scan on {} ", table)))) << statement.sql;
  }
}

INSTANTIATE_TEST_SUITE_P(Versions, PlansOfStatements, testing::Values(4, 5));

}  // namespace
}  // namespace citymesh
