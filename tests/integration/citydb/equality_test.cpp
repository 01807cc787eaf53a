#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "services/citydb/citydb.h"
#include "tests/integration/citydb/reading.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/loader.h"

namespace citymesh {
namespace {

using citydb_support::LoadOptions;
namespace fs = std::filesystem;

struct Case {
  std::string name;  ///< of the test
  fs::path file;
};

/// Every CityGML and CityJSON file below a folder that holds buildings with a CRS.
void add_files(const fs::path& folder, const std::string& prefix, std::vector<Case>& cases) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    for (const auto* ending : {".gml", ".gml.gz", ".xml"})
      if (entry.is_regular_file() && name.ends_with(ending)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    auto name = prefix + fs::relative(file, folder).string();
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    cases.push_back({name, file});
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto* folder : {"berlin", "citygml1", "citygml2", "citygml3", "fzk-haus"})
    add_files(fs::path(CITYMESH_TEST_DATA) / folder, std::string(folder) + "_", all);
  if (const auto* extra = std::getenv("CITYMESH_EXTRA_DATA"))
    for (const auto* folder : {"citygml4j-samples", "helsinki-lod2", "ingolstadt-lod3", "nrw-lod2",
                               "lyon-opera-curved", "ogc-examples", "vienna-lod2"})
      if (const auto path = fs::path(extra) / folder; fs::is_directory(path))
        add_files(path, "extra_" + std::string(folder) + "_", all);
  return all;
}

void expect_same(const Model& expected, const Model& found, const std::string& where) {
  EXPECT_EQ(expected.size(), found.size()) << where;
  for (const auto& [id, text] : expected) {
    const auto same = found.find(id);
    if (same == found.end())
      ADD_FAILURE() << where << " has no building '" << id << "'";
    else
      EXPECT_EQ(text, same->second) << where;
    if (testing::Test::HasFailure()) return;  // one shows enough
  }
}

class StoredModel : public citydb_support::CityDbTest, public testing::WithParamInterface<Case> {};

TEST_P(StoredModel, IsTheModelOfTheFile) {
  const auto& file = GetParam().file;
  auto from_file = open_files({file}, {});
  ASSERT_TRUE(from_file);
  // The same box has the same frame everywhere.
  const auto whole = (*from_file)->select({}, {});
  ASSERT_TRUE(whole) << whole.error().message;
  const auto srid = citydb_support::srid_of(file);
  ASSERT_TRUE(srid) << srid.error().message;
  if (*srid == 0 || whole->buildings == 0) GTEST_SKIP() << "no CRS or no buildings: " << file;
  BuildingQuery query;
  query.crs = Crs{whole->crs.id.substr(0, whole->crs.id.find('+'))};
  constexpr double kReach_m = 100'000;
  query.bbox = RequestBox{whole->origin.x - kReach_m,
                          whole->origin.y - kReach_m,
                          whole->origin.x + kReach_m,
                          whole->origin.y + kReach_m,
                          {},
                          query.crs};
  const auto expected = read_model(**from_file, query);
  ASSERT_TRUE(expected) << expected.error().message;

  const bool old = (*whole).inputs.front().format.find("3.0") == std::string::npos;
  for (const auto& [major, minor] : {std::pair{4, 4}, std::pair{5, 0}, std::pair{5, 1}}) {
    if (major == 4 && !old) continue;  // version 4 cannot hold CityGML 3.0
    const LoadOptions options{.schema = {.major = major, .minor = minor, .srid = *srid}};
    const auto url = server().create_citydb(options.schema);
    ASSERT_TRUE(url) << url.error().message;
    const auto loaded = citydb_support::load(*url, options, file);
    ASSERT_TRUE(loaded) << loaded.error().message;
    const auto factory = open_citydb({.url = *url, .chunk = 7});
    ASSERT_TRUE(factory) << factory.error().message;
    const auto database = (*factory)();
    const auto found = read_model(**database, query);
    ASSERT_TRUE(found) << found.error().message;
    expect_same(*expected, *found, fmt::format("3DCityDB {}.{}", major, minor));
  }
}

class HouseByHand : public citydb_support::CityDbTest {};

/// Rows that were written by hand from the description of the schema, not by our loader.
TEST_F(HouseByHand, IsTheHouseOfTheFile) {
  auto from_file = open_files({CITYMESH_CITYDB_FIXTURE}, {});
  ASSERT_TRUE(from_file);
  BuildingQuery query;
  query.bbox = RequestBox{499'900, 5'699'900, 500'100, 5'700'100, {}, Crs{"EPSG:25832"}};
  query.crs = Crs{"EPSG:25832"};
  const auto expected = read_model(**from_file, query);
  ASSERT_TRUE(expected) << expected.error().message;
  ASSERT_EQ(expected->size(), 1u);
  for (const auto& [major, sql_file] :
       {std::pair{4, "fixture_v4.sql"}, std::pair{5, "fixture_v5.sql"}}) {
    const auto url = server().create_citydb({.major = major, .srid = 25832});
    ASSERT_TRUE(url) << url.error().message;
    auto database = citydb_support::Database::open(*url);
    const auto sql = citydb_support::citydb_file(sql_file);
    ASSERT_TRUE(database && sql);
    const auto stored = database->run(*sql);
    ASSERT_TRUE(stored) << stored.error().message;
    const auto factory = open_citydb({.url = *url});
    ASSERT_TRUE(factory) << factory.error().message;
    const auto source = (*factory)();
    const auto found = read_model(**source, query);
    ASSERT_TRUE(found) << found.error().message;
    expect_same(*expected, *found, sql_file);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, StoredModel, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace citymesh
