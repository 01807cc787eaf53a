#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <stop_token>
#include <string>

#include "services/citydb/schema.h"
#include "services/citydb/terrain.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/database.h"

namespace citymesh::citydb {
namespace {

using citydb_support::CityDbTest;
using citydb_support::Database;
using postgres::Connection;
using postgres::Statement;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

struct Version {
  int major = 5, minor = 1;
};

std::string name_of(const testing::TestParamInfo<Version>& info) {
  return fmt::format("V{}_{}", info.param.major, info.param.minor);
}

/// The tables of relief_v4.sql and relief_v5.sql.
class TerrainOfCityDb : public CityDbTest, public testing::WithParamInterface<Version> {
 protected:
  void SetUp() override {
    CityDbTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    const auto url = server().create_citydb({.major = GetParam().major, .minor = GetParam().minor});
    ASSERT_TRUE(url) << url.error().message;
    url_ = *url;
    const auto sql = citydb_support::citydb_file(is_v5() ? "relief_v5.sql" : "relief_v4.sql");
    ASSERT_TRUE(sql) << sql.error().message;
    run(*sql);
  }

  static bool is_v5() { return GetParam().major == 5; }

  void run(const std::string& sql) {
    auto database = Database::open(url_);
    ASSERT_TRUE(database) << database.error().message;
    const auto done = database->run("SET search_path TO citydb, public; " + sql);
    ASSERT_TRUE(done) << sql << ": " << done.error().message;
  }

  /// Between places that are given from the lower corner of the hill.
  static TerrainQuery box(double min_x, double min_y, double max_x, double max_y) {
    constexpr double kX = 500000, kY = 5700000;
    TerrainQuery query;
    query.bbox = {kX + min_x, kY + min_y, kX + max_x, kY + max_y, {}, Crs{"EPSG:25832"}};
    return query;
  }

  Result<Terrain> read(const TerrainQuery& query, const std::string& more_of_url = {},
                       const std::stop_token& stop = {}) {
    const char* glue = url_.find('?') == std::string::npos ? "?" : "&";
    auto connection =
        Connection::open({.url = more_of_url.empty() ? url_ : url_ + glue + more_of_url});
    if (!connection) return connection.error();
    if (auto chosen = connection->set_schema("citydb", {}); !chosen) return chosen.error();
    const auto instance = look_at(*connection, "citydb", {});
    if (!instance) return instance.error();
    return read_terrain(*connection, *instance, query, stop);
  }

  Terrain terrain(const TerrainQuery& query) {
    auto terrain = read(query);
    EXPECT_TRUE(terrain) << terrain.error().message;
    return terrain ? *std::move(terrain) : Terrain{};
  }

  std::string url_{};
};

/// A line for each component, with its triangles from the lower corner of the hill.
std::string shown(const Terrain& terrain) {
  std::string text;
  for (const auto& component : terrain.components) {
    text += fmt::format("{} {}:", component.gml_id, to_string(component.lod));
    for (std::uint32_t t = 0; t < component.triangle_count; ++t) {
      for (const auto corner : terrain.triangles[component.first_triangle + t]) {
        const auto& p = terrain.points[corner];
        text += fmt::format(" {},{},{}", p.x - 500000, p.y - 5700000, p.z);
      }
      text += ';';
    }
    text += '\n';
  }
  return text;
}

TEST_P(TerrainOfCityDb, IsWhatItsRowsSay) {
  const auto all = terrain(box(-50, -50, 59, 50));
  EXPECT_EQ(all.crs.id, "EPSG:25832");
  EXPECT_EQ(shown(all),
            "hill 2: 0,0,100 20,0,100 10,10,105; 20,0,100 20,20,100 10,10,105;"
            " 20,20,100 0,20,100 10,10,105; 0,20,100 0,0,100 10,10,105;\n"
            "field 2: 20,0,100 40,0,100 40,20,100; 20,0,100 40,20,100 20,20,100;\n"
            "alone 2: 40,0,100 60,0,100 40,20,100;\n");
  EXPECT_EQ(all.points.size(), 8u) << "one for each place";
  EXPECT_EQ(all.degenerate, 2u);
  EXPECT_THAT(all.left_out, ElementsAre(Pair("has no geometry", ElementsAre("hollow")),
                                        Pair("is a BreaklineRelief", ElementsAre("ditch")),
                                        Pair("is a MassPointRelief", ElementsAre("survey")),
                                        Pair("is a RasterRelief", ElementsAre("scan")),
                                        Pair("is of LoD 1", ElementsAre("country"))));
}

TEST_P(TerrainOfCityDb, OnlyTrianglesThatTouchTheBoxAreRead) {
  constexpr auto kEast = "hill 2: 20,0,100 20,20,100 10,10,105;\n";
  EXPECT_EQ(shown(terrain(box(15, 9, 16, 11))), kEast);
  // The box in degrees, and a region that is not as large as the box around it.
  auto degrees = box(15, 9, 16, 11);
  const auto transformer = Transformer::create(degrees.bbox.crs, Crs{"OGC:CRS84"});
  ASSERT_TRUE(transformer) << transformer.error().message;
  std::array<Point3, 2> corners{
      {{degrees.bbox.min_x, degrees.bbox.min_y, 0}, {degrees.bbox.max_x, degrees.bbox.max_y, 0}}};
  ASSERT_TRUE(transformer->apply(corners));
  degrees.bbox = {corners[0].x, corners[0].y, corners[1].x, corners[1].y, {}, Crs{"OGC:CRS84"}};
  EXPECT_EQ(shown(terrain(degrees)), kEast);
  auto region = box(15, -9, 25, 11);
  region.bbox.rings = {{{500015, 5700011}, {500025, 5699991}, {500016, 5700011}}};
  EXPECT_EQ(
      shown(terrain(region)),
      std::string(kEast) + "field 2: 20,0,100 40,0,100 40,20,100; 20,0,100 40,20,100 20,20,100;\n");
  EXPECT_THAT(terrain(box(1000, 1000, 1001, 1001)).components, IsEmpty());
}

TEST_P(TerrainOfCityDb, TheFinestLevelThatHasTrianglesIsTaken) {
  auto coarse = box(15, 9, 16, 11);
  coarse.max_lod = 1;
  EXPECT_THAT(shown(terrain(coarse)), HasSubstr("country 1:"));
  EXPECT_THAT(terrain(coarse).left_out,
              testing::Contains(Pair("is of LoD 2", ElementsAre("hill"))));
  coarse.max_lod = 0;
  EXPECT_THAT(terrain(coarse).triangles, IsEmpty());
  // In the envelope of a fine triangle, but beside it.
  EXPECT_THAT(shown(terrain(box(58, 18, 59, 19))), HasSubstr("country 1:"));
}

TEST_P(TerrainOfCityDb, AComponentWithOtherFacesIsLeftOutWithTheReason) {
  const auto refused = terrain(box(70, 1, 71, 19));
  EXPECT_THAT(refused.left_out,
              ElementsAre(Pair("has faces that are no triangles", ElementsAre("quads"))));
  EXPECT_THAT(shown(refused), testing::StartsWith("country 1:")) << "the next level";

  run(is_v5() ? "UPDATE geometry_data SET geometry = ST_Translate(geometry, 0, 0, 'NaN')"
                " WHERE id = 300"
              : "UPDATE surface_geometry SET geometry = ST_Translate(geometry, 0, 0, 'NaN')"
                " WHERE id = 302");
  const auto damaged = terrain(box(0, 1, 40, 19));
  EXPECT_THAT(damaged.left_out,
              testing::Contains(Pair("has coordinates that are no numbers", ElementsAre("field"))));
  EXPECT_THAT(shown(damaged), testing::StartsWith("hill 2:"));
}

/// Those that keep all faces of a geometry in one value.
class TerrainOfCityDb5 : public TerrainOfCityDb {};

TEST_P(TerrainOfCityDb5, FacesMayBeStoredAsAnyKindOfSurface) {
  const auto expected = shown(terrain(box(25, 1, 39, 19)));
  EXPECT_THAT(expected, testing::StartsWith("field 2:"));
  const std::string faces =
      " Z (((500020 5700000 100, 500040 5700000 100, 500040 5700020 100, 500020 5700000 100)),"
      " ((500020 5700000 100, 500040 5700020 100, 500020 5700020 100, 500020 5700000 100)))";
  for (const std::string kind : {"TIN", "POLYHEDRALSURFACE"}) {
    run("UPDATE geometry_data SET geometry = 'SRID=25832;" + kind + faces + "' WHERE id = 300");
    EXPECT_EQ(shown(terrain(box(25, 1, 39, 19))), expected) << kind;
  }
  run("UPDATE geometry_data SET geometry = 'SRID=25832;LINESTRING Z (500020 5700000 100,"
      " 500040 5700020 100, 500020 5700020 100, 500020 5700000 100)' WHERE id = 300");
  EXPECT_THAT(terrain(box(25, 1, 39, 19)).left_out,
              testing::Contains(Pair("has faces that are no triangles", ElementsAre("field"))));
}

TEST_P(TerrainOfCityDb, MoreTrianglesThanAllowedAreAnError) {
  auto query = box(-50, -50, 59, 50);
  query.max_triangles = 9;  // with those that have no area
  EXPECT_EQ(terrain(query).triangles.size(), 7u);
  query.max_triangles = 8;
  const auto refused = read(query);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(refused.error().message, HasSubstr("more than 8 triangles in the box"));
}

TEST_P(TerrainOfCityDb, WhatAnOperatorMustChangeIsSaid) {
  run("DROP ROLE IF EXISTS no_relief; CREATE ROLE no_relief LOGIN PASSWORD 'x';"
      " GRANT USAGE ON SCHEMA citydb TO no_relief;"
      " GRANT SELECT ON database_srs, objectclass TO no_relief");
  const auto refused = read(box(0, 0, 1, 1), "user=no_relief&password=x");
  run("DROP OWNED BY no_relief; DROP ROLE no_relief");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::PermissionDenied);
  EXPECT_THAT(refused.error().message, HasSubstr("GRANT USAGE on the schema and SELECT"));

  run(std::string("DROP TABLE ") + (is_v5() ? "geometry_data" : "tin_relief"));
  if (is_v5())
    run("CREATE VIEW geometry_data AS SELECT 1 AS id");  // still a 3DCityDB at first sight
  const auto incomplete = read(box(0, 0, 1, 1));
  ASSERT_FALSE(incomplete);
  EXPECT_EQ(incomplete.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(incomplete.error().message, HasSubstr("check --source_schema"));
}

TEST_P(TerrainOfCityDb, AStopEndsTheReading) {
  std::stop_source stop;
  stop.request_stop();
  auto locked = Database::open(url_);
  ASSERT_TRUE(locked);
  ASSERT_TRUE(locked->rows("BEGIN"));
  ASSERT_TRUE(locked->rows(std::string("LOCK TABLE citydb.") +
                           (is_v5() ? "feature" : "cityobject") + " IN ACCESS EXCLUSIVE MODE"));
  const auto stopped = read(box(0, 0, 1, 1), {}, stop.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
}

INSTANTIATE_TEST_SUITE_P(Versions, TerrainOfCityDb,
                         testing::Values(Version{4, 4}, Version{5, 0}, Version{5, 1}), name_of);
INSTANTIATE_TEST_SUITE_P(Versions, TerrainOfCityDb5, testing::Values(Version{5, 0}, Version{5, 1}),
                         name_of);

}  // namespace
}  // namespace citymesh::citydb
