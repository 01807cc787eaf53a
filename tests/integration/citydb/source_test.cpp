#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <stop_token>
#include <thread>

#include "services/citydb/citydb.h"
#include "tests/integration/citydb/reading.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/database.h"
#include "tests/support/citydb/loader.h"

namespace citymesh {
namespace {

using citydb_support::Database;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kTile = CITYMESH_TEST_DATA "/berlin/3910_5817.gml";

/// A tile of Berlin in a database.
class CityDbSource : public citydb_support::CityDbTest {
 protected:
  void SetUp() override {
    CityDbTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    citydb_support::LoadOptions options;
    options.schema.major = 4;
    options.schema.srid = 25833;
    auto url = server().create_citydb(options.schema);
    ASSERT_TRUE(url) << url.error().message;
    url_ = *url;
    const auto loaded = citydb_support::load(url_, options, kTile);
    ASSERT_TRUE(loaded) << loaded.error().message;
    run("ANALYZE");
    open({.url = url_});
  }

  void open(CityDbOptions options) {
    auto factory = open_citydb(options);
    ASSERT_TRUE(factory) << factory.error().message;
    auto source = (*factory)();
    ASSERT_TRUE(source);
    source_ = *std::move(source);
  }

  void run(const std::string& sql) {
    auto database = Database::open(url_);
    ASSERT_TRUE(database) << database.error().message;
    const auto done = database->run(sql);
    ASSERT_TRUE(done) << sql << ": " << done.error().message;
  }
  std::string value(const std::string& sql) {
    auto database = Database::open(url_);
    const auto found = database->value(sql);
    EXPECT_TRUE(found) << sql << ": " << found.error().message;
    return found ? *found : "";
  }

  static BuildingQuery box(double min_x, double min_y, double max_x, double max_y) {
    BuildingQuery query;
    query.bbox = RequestBox{min_x, min_y, max_x, max_y, {}, Crs{"OGC:CRS84"}};
    query.crs = Crs{"EPSG:25833"};
    return query;
  }

  std::string url_;
  std::unique_ptr<CitySource> source_;
};

TEST_F(CityDbSource, ABoxChoosesWhatItChoosesInTheFile) {
  auto file = open_files({kTile}, {});
  ASSERT_TRUE(file);
  std::set<std::size_t> sizes;
  for (const auto rule : {BboxRule::Intersects, BboxRule::Centre, BboxRule::Within})
    for (auto query : {box(13.38, 52.48, 13.42, 52.51), box(13.405, 52.497, 13.408, 52.499),
                       box(13.406, 52.4987, 13.4062, 52.4988), box(10, 50, 10.1, 50.1)}) {
      query.bbox_rule = rule;
      const auto expected = read_model(**file, query);
      const auto found = read_model(*source_, query);
      ASSERT_TRUE(expected && found) << (found ? expected : found).error().message;
      EXPECT_EQ(*expected, *found);
      sizes.insert(found->size());
    }
  EXPECT_THAT(sizes, testing::IsSupersetOf({0u, 1u, 4u, 9u, 10u}));
}

TEST_F(CityDbSource, BuildingsThatNoBoxFindsAreTold) {
  const auto query = box(13.38, 52.48, 13.42, 52.51);
  const auto all = source_->select(query, {});
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_THAT(all->warnings, testing::IsEmpty());
  run("UPDATE citydb.cityobject SET envelope = NULL WHERE id IN (SELECT id FROM citydb.cityobject"
      " WHERE objectclass_id = 26 ORDER BY id LIMIT 2)");
  run("ANALYZE");
  const auto found = source_->select(query, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->buildings + 2, all->buildings);
  EXPECT_THAT(
      found->warnings,
      ElementsAre("buildings of the database without an envelope, which no box finds: 2; have "
                  "3DCityDB compute what is missing (SELECT "
                  "citydb.get_envelope_cityobjects(0, 1, 1))"));
  const auto everything = source_->select({}, {});
  ASSERT_TRUE(everything) << everything.error().message;
  EXPECT_THAT(everything->warnings, testing::IsEmpty());
}

TEST_F(CityDbSource, IdsOfBuildingsAndPartsChooseAndMissingOnesAreTold) {
  const auto part = value(
      "SELECT c.gmlid FROM citydb.building b JOIN citydb.cityobject c ON c.id = b.id"
      " WHERE b.building_parent_id IS NOT NULL ORDER BY 1 LIMIT 1");
  const auto whole = value(
      "SELECT r.gmlid FROM citydb.building b JOIN citydb.cityobject c ON c.id = b.id"
      " JOIN citydb.cityobject r ON r.id = b.building_root_id WHERE c.gmlid = '" +
      part + "'");
  BuildingQuery query;
  query.object_ids = {part, "nobody's \"id\", {}"};
  const auto selection = source_->select(query, {});
  ASSERT_TRUE(selection) << selection.error().message;
  EXPECT_EQ(selection->buildings, 1u);
  EXPECT_EQ(selection->object_ids.front(), whole);
  EXPECT_THAT(selection->missing_ids, ElementsAre("nobody's \"id\", {}"));
}

TEST_F(CityDbSource, NamesItselfWithoutSecrets) {
  const auto selection = source_->select({}, {});
  ASSERT_TRUE(selection) << selection.error().message;
  ASSERT_EQ(selection->inputs.size(), 1u);
  const auto& input = selection->inputs.front();
  EXPECT_THAT(input.file, HasSubstr("postgresql://"));
  EXPECT_EQ(input.format, "3DCityDB 4.4.2");
  EXPECT_EQ(input.buildings, 166u);
  EXPECT_EQ(selection->buildings, 166u);
  const auto shown = shown_citydb_url("postgresql://anna:secret@db.test:5433/city?password=secret");
  ASSERT_TRUE(shown);
  EXPECT_EQ(*shown, "postgresql://db.test:5433/city");
}

TEST_F(CityDbSource, EndedVersionsAreLeftOut) {
  const auto before = source_->select({}, {});
  ASSERT_TRUE(before);
  run("UPDATE citydb.cityobject SET termination_date = now() WHERE gmlid = '" +
      before->object_ids.front() + "'");
  const auto after = source_->select({}, {});
  ASSERT_TRUE(after);
  EXPECT_EQ(after->buildings + 1, before->buildings);
  EXPECT_THAT(after->object_ids, Not(testing::Contains(before->object_ids.front())));
}

TEST_F(CityDbSource, SelectionAndReadingSeeTheSameSnapshot) {
  const auto query = box(13.38, 52.48, 13.42, 52.51);
  const auto selection = source_->select(query, {});
  ASSERT_TRUE(selection);
  run("DELETE FROM citydb.surface_geometry");
  std::uint64_t polygons = 0, buildings = 0;
  const auto done = source_->read(query, *selection,
                                  [&](Building&& building) -> Result<void> {
                                    ++buildings;
                                    for (const auto& geometry : building.geometries)
                                      polygons += geometry.polygons.size();
                                    return {};
                                  },
                                  {});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(buildings, selection->buildings);
  EXPECT_GT(polygons, 1000u);
  const auto again =
      source_->read(query, *selection, [](Building&&) { return Result<void>{}; }, {});
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("select the buildings again"));
}

TEST_F(CityDbSource, ADatabaseThatGoesAwayIsToldAndUsedAgainWhenItIsBack) {
  auto* cluster = server().cluster();
  if (cluster == nullptr) GTEST_SKIP() << "the server of CITYMESH_TEST_CITYDB is not ours to stop";
  open({.url = url_, .chunk = 10});
  const auto query = box(13.38, 52.48, 13.42, 52.51);
  const auto selection = source_->select(query, {});
  ASSERT_TRUE(selection);
  std::uint64_t read = 0;
  const auto broken = source_->read(
      query, *selection,
      [&](Building&&) -> Result<void> { return ++read == 5 ? cluster->kill() : Result<void>{}; },
      {});
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(broken.error().message, HasSubstr("submit the job again"));
  EXPECT_LT(read, selection->buildings);
  const auto away = source_->select(query, {});
  ASSERT_FALSE(away);
  EXPECT_EQ(away.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(away.error().message, HasSubstr("cannot connect to postgresql://"));

  ASSERT_TRUE(cluster->start_again());
  const auto back = read_model(*source_, query);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->size(), selection->buildings);
  // A restart that nobody noticed costs nothing.
  ASSERT_TRUE(cluster->restart());
  EXPECT_TRUE(source_->select(query, {}));
}

TEST_F(CityDbSource, AStopEndsAStatementThatWaits) {
  std::stop_source stop;
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  // Whoever wants to read a table that is locked for good waits.
  auto locked = Database::open(url_);
  ASSERT_TRUE(locked);
  ASSERT_TRUE(locked->rows("BEGIN"));
  ASSERT_TRUE(locked->rows("LOCK TABLE citydb.cityobject IN ACCESS EXCLUSIVE MODE"));
  RunContext context;
  context.stop = stop.get_token();
  const auto stopped = source_->select({}, context);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
  ASSERT_TRUE(locked->rows("ROLLBACK"));
  EXPECT_TRUE(source_->select({}, {}));
}

TEST_F(CityDbSource, WhatAnOperatorMustDoIsSaid) {
  const auto refused = [](const CityDbOptions& options) {
    const auto factory = open_citydb(options);
    EXPECT_FALSE(factory);
    return factory ? Error{} : factory.error();
  };
  EXPECT_THAT(refused({.url = url_, .schema = "nowhere"}).message,
              HasSubstr("'nowhere' of the database has neither table surface_geometry nor"));
  EXPECT_THAT(refused({.url = "postgresql://127.0.0.1:1/city"}).message,
              HasSubstr("cannot connect to postgresql://127.0.0.1:1/city"));
  const auto bad = refused({.url = "postgresql://a:se cret@[::1/x"});
  EXPECT_EQ(bad.code, ErrorCode::InvalidArgument);
  EXPECT_THAT(bad.message, Not(HasSubstr("cret")));
  const auto empty = server().create_database();
  ASSERT_TRUE(empty);
  EXPECT_THAT(refused({.url = *empty}).message, HasSubstr("no PostGIS in reach"));

  run("DROP TABLE citydb.opening CASCADE");
  const auto selection = source_->select({}, {});
  ASSERT_TRUE(selection) << selection.error().message;
  const auto missing = source_->read({}, *selection, [](Building&&) { return Result<void>{}; }, {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(missing.error().message, HasSubstr("no complete 3DCityDB"));

  run("DELETE FROM citydb.database_srs");
  EXPECT_THAT(refused({.url = url_}).message, HasSubstr("states no CRS in database_srs"));
  run("INSERT INTO citydb.database_srs VALUES (999999, 'none')");
  EXPECT_THAT(refused({.url = url_}).message, HasSubstr("has SRID 999999"));
}

TEST_F(CityDbSource, MoreSourcesThanConnectionsWaitForEachOther) {
  auto factory = open_citydb({.url = url_, .max_connections = 1});
  ASSERT_TRUE(factory);
  const auto query = box(13.405, 52.497, 13.408, 52.499);
  std::vector<std::jthread> readers;
  std::atomic<int> done = 0;
  for (int i = 0; i < 4; ++i)
    readers.emplace_back([&] {
      const auto source = (*factory)();
      if (source && read_model(**source, query)) ++done;
    });
  readers.clear();
  EXPECT_EQ(done, 4);
}

}  // namespace
}  // namespace citymesh
