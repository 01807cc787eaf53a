#include "services/citydb/write_back.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/pipeline/pipeline.h"
#include "core/write/write.h"
#include "services/citydb/citydb.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/database.h"
#include "tests/support/citydb/loader.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using citydb_support::Database;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::filesystem::path kTile = CITYMESH_TEST_DATA "/berlin/3910_5817.gml";
constexpr const char* kInputs =
    R"({"formats":["obj"],"write_back":true,"bbox":{"bbox":[13.405,52.497,13.408,52.499]}})";
constexpr const char* kSameBox =
    R"({"formats":["obj"],"bbox":{"bbox":[13.405,52.497,13.408,52.499]}})";

/// A tile of Berlin in schema `citydb` of a database, and an empty schema `healed`.
class WriteBackTest : public citydb_support::CityDbTest,
                      public testing::WithParamInterface<citydb_support::Schema> {
 protected:
  void SetUp() override {
    CityDbTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    citydb_support::LoadOptions options{.schema = GetParam()};
    auto url = server().create_citydb(options.schema);
    ASSERT_TRUE(url) << url.error().message;
    url_ = *url;
    const auto loaded = citydb_support::load(url_, options, kTile);
    ASSERT_TRUE(loaded) << loaded.error().message;
    auto healed = options.schema;
    healed.name = "healed";
    const auto made = citydb_support::create_schema(url_, healed);
    ASSERT_TRUE(made) << made.error().message;
    search_first("citydb");
  }

  /// Where names without a schema are looked for.
  void search_first(const std::string& schema) {
    execute("ALTER DATABASE " + citydb_support::identifier(value("SELECT current_database()")) +
            " SET search_path TO " + schema + ", citydb_pkg, public");
  }

  bool is_v5() const { return GetParam().major == 5; }
  /// The table of objects.
  std::string objects() const { return is_v5() ? "healed.feature" : "healed.cityobject"; }
  std::string id_column() const { return is_v5() ? "objectid" : "gmlid"; }

  std::string value(const std::string& sql) {
    auto database = Database::open(url_);
    const auto found = database->value(sql);
    EXPECT_TRUE(found) << sql << ": " << found.error().message;
    return found ? *found : "";
  }
  void execute(const std::string& sql) {
    auto database = Database::open(url_);
    const auto done = database->run(sql);
    ASSERT_TRUE(done) << sql << ": " << done.error().message;
  }
  std::string rows() { return value("SELECT count(*) FROM " + objects()); }
  std::string current_of(const std::string& lineage) {
    return value("SELECT count(*) FROM " + objects() + " WHERE termination_date IS NULL" +
                 " AND lineage = '" + lineage + "'");
  }

  std::string url_of(const std::string& user) const {
    return url_ + (url_.find('?') == std::string::npos ? "?" : "&") + "user=" + user +
           "&password=x";
  }

  std::unique_ptr<WriteBackStore> store(const std::string& url = {}) {
    auto opened = open_write_back(
        {.url = url.empty() ? url_ : url, .schema = "healed", .source_schema = "citydb"});
    EXPECT_TRUE(opened) << opened.error().message;
    return opened ? *std::move(opened) : nullptr;
  }

  Result<RunOutcome> run_from(const std::string& schema, const std::string& inputs,
                              const std::filesystem::path& folder, BodySink* sink) {
    auto factory = open_citydb({.url = url_, .schema = schema});
    if (!factory) return factory.error();
    auto source = (*factory)();
    if (!source) return source.error();
    return run("export-for-simulation", inputs, **source, folder, {}, sink);
  }
  /// A job that heals the box and writes it back.
  Result<void> work(WriteBackStore& store, const std::string& job_id, bool commit = true) {
    const TempFolder folder;
    const auto attempt = store.begin(job_id, "export-for-simulation", {});
    auto outcome = run_from("citydb", kInputs, folder.path(), attempt.get());
    if (!outcome) return outcome.error();
    return commit ? attempt->commit() : Result<void>{};
  }

  std::string url_;
};

/// The vertices and faces of an OBJ file.
std::string bodies(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string text, line;
  while (std::getline(in, line))
    if (!line.starts_with('#')) text += line + '\n';
  return text;
}

TEST_P(WriteBackTest, WhatWasWrittenIsReadAsTheBodiesThatWereDelivered) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  const TempFolder first, second;
  const auto attempt = store->begin("job-1", "export-for-simulation", {});
  const auto healed = run_from("citydb", kInputs, first.path(), attempt.get());
  ASSERT_TRUE(healed) << healed.error().message;
  ASSERT_TRUE(attempt->commit());

  // All gates apply to the second run as to the first.
  const auto again = run_from("healed", kSameBox, second.path(), nullptr);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_GE(again->report.counts.delivered, 4u);
  EXPECT_EQ(again->report.counts.delivered, healed->report.counts.delivered);
  EXPECT_EQ(again->report.counts.dropped, 0u);
  EXPECT_EQ(bodies(first.path() / "model.obj"), bodies(second.path() / "model.obj"));
  EXPECT_EQ(value("SELECT string_agg(DISTINCT lineage, ',') FROM " + objects()), "job-1");
  EXPECT_EQ(value("SELECT count(*) FROM " + objects() + " WHERE envelope IS NULL"), "0");
  EXPECT_THAT(value("SELECT min(reason_for_update) FROM " + objects()),
              HasSubstr("export-for-simulation: "));
}

TEST_P(WriteBackTest, NothingIsSeenBeforeTheCommitAndNothingIsLeftWithoutOne) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  const TempFolder folder;
  {
    const auto attempt = store->begin("job-1", "heal", {});
    ASSERT_TRUE(run_from("citydb", kInputs, folder.path(), attempt.get()));
    EXPECT_EQ(rows(), "0");
  }
  EXPECT_EQ(rows(), "0");
}

TEST_P(WriteBackTest, ALaterAttemptOfAJobLeavesTheSameRows) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  ASSERT_TRUE(work(*store, "job-1"));
  const auto ids = "SELECT string_agg(" + id_column() + ", ',' ORDER BY " + id_column() +
                   ") FROM " + objects() + " WHERE " + id_column() + " NOT LIKE 'cm.%'";
  const auto before = rows(), named = value(ids);
  ASSERT_TRUE(work(*store, "job-1"));
  EXPECT_EQ(rows(), before);
  EXPECT_EQ(value(ids), named);
  EXPECT_EQ(current_of("job-1"), before);
}

TEST_P(WriteBackTest, EarlierVersionsAreHistoryAndComeBackWhenAJobIsWithdrawn) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  ASSERT_TRUE(work(*store, "job-1"));
  const auto all = rows();
  ASSERT_TRUE(work(*store, "job-2"));
  EXPECT_EQ(current_of("job-1"), "0");
  EXPECT_EQ(current_of("job-2"), all);
  // A later attempt of the second does not touch the first.
  ASSERT_TRUE(work(*store, "job-2"));
  EXPECT_EQ(current_of("job-1"), "0");
  EXPECT_EQ(current_of("job-2"), all);

  ASSERT_TRUE(store->withdraw("job-2"));
  EXPECT_EQ(current_of("job-1"), all);
  EXPECT_EQ(rows(), all);
  ASSERT_TRUE(store->withdraw("job-2"));
  EXPECT_EQ(rows(), all);
}

TEST_P(WriteBackTest, WithdrawingAJobThatWasReplacedLeavesTheNewerOne) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  ASSERT_TRUE(work(*store, "job-1"));
  const auto all = rows();
  ASSERT_TRUE(work(*store, "job-2"));
  ASSERT_TRUE(work(*store, "job-3"));
  ASSERT_TRUE(store->withdraw("job-2"));
  EXPECT_EQ(current_of("job-1"), "0");
  EXPECT_EQ(current_of("job-3"), all);
}

TEST_P(WriteBackTest, TheSchemaThatIsReadIsNeverWrittenTo) {
  const auto same = open_write_back({.url = url_, .schema = "citydb", .source_schema = "citydb"});
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().code, ErrorCode::InvalidArgument);
  EXPECT_THAT(same.error().message, HasSubstr("the schema that is read"));
  const auto missing =
      open_write_back({.url = url_, .schema = "nowhere", .source_schema = "citydb"});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("--write_back_schema"));

  // A table that is missing is not looked for in the next schema of the search path.
  execute("DROP TABLE healed." + std::string(is_v5() ? "property" : "thematic_surface"));
  const auto incomplete =
      open_write_back({.url = url_, .schema = "healed", .source_schema = "citydb"});
  ASSERT_FALSE(incomplete);
  EXPECT_THAT(incomplete.error().message, HasSubstr("lacks tables"));
}

TEST_P(WriteBackTest, AMissingRightIsSaidWithWhatToGrant) {
  execute("DROP ROLE IF EXISTS only_reads; CREATE ROLE only_reads LOGIN PASSWORD 'x'");
  execute("GRANT USAGE ON SCHEMA healed TO only_reads");
  execute("GRANT SELECT ON ALL TABLES IN SCHEMA healed TO only_reads");
  const auto refused =
      open_write_back({.url = url_of("only_reads"), .schema = "healed", .source_schema = "citydb"});
  execute("DROP OWNED BY only_reads; DROP ROLE only_reads");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::PermissionDenied);
  EXPECT_THAT(refused.error().message, HasSubstr("GRANT USAGE on the schema and SELECT, INSERT"));
  EXPECT_THAT(refused.error().message, HasSubstr("--write_back_url"));
}

/// The block of SQL in the documentation that makes the role `citymesh_writer`, for another role
/// with the password x.
std::string documented_grants(const std::string& role) {
  std::ifstream in(CITYMESH_OPERATIONS);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto begin = text.find("CREATE ROLE citymesh_writer");
  if (begin == std::string::npos) return "no such role in " CITYMESH_OPERATIONS;
  auto sql = text.substr(begin, text.find("```", begin) - begin);
  const std::string name = "citymesh_writer", password = "'…'";
  for (auto at = sql.find(name); at != std::string::npos; at = sql.find(name, at))
    sql.replace(at, name.size(), role);
  return sql.replace(sql.find(password), password.size(), "'x'");
}

TEST_P(WriteBackTest, TheDocumentedGrantsAreEnoughToWriteAndWithdrawAndNothingElse) {
  execute("DROP ROLE IF EXISTS as_documented");
  execute(documented_grants("as_documented"));
  {
    const auto store = this->store(url_of("as_documented"));
    ASSERT_TRUE(store);
    for (const auto* job : {"job-1", "job-1", "job-2"}) {
      const auto done = work(*store, job);
      EXPECT_TRUE(done) << done.error().message;
    }
    EXPECT_NE(current_of("job-2"), "0");
    const auto withdrawn = store->withdraw("job-2");
    EXPECT_TRUE(withdrawn) << withdrawn.error().message;
    EXPECT_NE(current_of("job-1"), "0");
    auto database = Database::open(url_of("as_documented"));
    const auto table = is_v5() ? "citydb.feature" : "citydb.cityobject";
    const auto wiped = database->run(std::string("DELETE FROM ") + table);
    EXPECT_FALSE(wiped);
    EXPECT_THAT(wiped ? "" : wiped.error().message, HasSubstr("permission denied"));
  }
  execute("DROP OWNED BY as_documented; DROP ROLE as_documented");
}

TEST_P(WriteBackTest, RowsOfOthersKeepTheirIds) {
  const citydb_support::Schema healed{.major = GetParam().major,
                                      .minor = GetParam().minor,
                                      .srid = GetParam().srid,
                                      .name = "healed"};
  ASSERT_TRUE(citydb_support::load(url_, {.schema = healed}, kTile));
  const auto loaded = std::stoi(rows());
  const auto store = this->store();
  ASSERT_TRUE(store);
  const auto done = work(*store, "job-1");
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_GT(std::stoi(rows()), loaded);
  EXPECT_EQ(value("SELECT count(*) FROM " + objects() + " WHERE lineage IS NULL"),
            std::to_string(loaded));
}

TEST_P(WriteBackTest, AnotherCrsThanThatOfTheDatabaseIsRefused) {
  const auto store = this->store();
  ASSERT_TRUE(store);
  const TempFolder folder;
  const auto attempt = store->begin("job-1", "heal", {});
  const auto outcome =
      run_from("citydb", R"({"write_back":true,"crs":"EPSG:25832"})", folder.path(), attempt.get());
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, ErrorCode::InvalidArgument);
  EXPECT_THAT(outcome.error().message, HasSubstr("leave `crs` out"));
}

TEST_P(WriteBackTest, ADatabaseThatIsKilledMeanwhileHasNothing) {
  auto* cluster = server().cluster();
  if (cluster == nullptr) GTEST_SKIP() << "the server of CITYMESH_TEST_CITYDB is not ours to stop";
  const auto store = this->store();
  ASSERT_TRUE(store);
  const TempFolder folder;
  const auto attempt = store->begin("job-1", "heal", {});
  ASSERT_TRUE(run_from("citydb", kInputs, folder.path(), attempt.get()));
  execute("CHECKPOINT");  // the tests' cluster does not wait for its disk
  ASSERT_TRUE(cluster->kill());
  const auto late = attempt->commit();
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::Unavailable);
  ASSERT_TRUE(cluster->start_again());
  EXPECT_EQ(rows(), "0");
  ASSERT_TRUE(work(*store, "job-1"));
  EXPECT_NE(rows(), "0");
}

INSTANTIATE_TEST_SUITE_P(
    Versions, WriteBackTest,
    testing::Values(citydb_support::Schema{.major = 4, .srid = 25833},
                    citydb_support::Schema{.major = 5, .minor = 0, .srid = 25833},
                    citydb_support::Schema{.major = 5, .minor = 1, .srid = 25833}),
    [](const auto& schema) {
      return fmt::format("V{}_{}", schema.param.major, schema.param.minor);
    });

}  // namespace
}  // namespace citymesh
