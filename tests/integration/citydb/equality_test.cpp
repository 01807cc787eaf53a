#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "services/citydb/citydb.h"
#include "tests/integration/citydb/reading.h"
#include "tests/support/citydb/citydb_test.h"
#include "tests/support/citydb/loader.h"
#include "tests/support/temp_folder.h"

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

/// Rows that were written by hand from the description of the schema, not by our loader.
class HouseByHand : public citydb_support::CityDbTest {
 protected:
  /// What was left out of the parts, by name.
  static std::map<std::string, std::uint32_t> left_out(CitySource& source,
                                                       const BuildingQuery& query) {
    std::map<std::string, std::uint32_t> names;
    const auto selection = source.select(query, {});
    if (!selection) return names;
    const auto read = source.read(query, *selection,
                                  [&](Building&& building) -> Result<void> {
                                    for (const auto& part : building.parts)
                                      for (const auto& [name, count] : part.skipped_ade_elements)
                                        names[name] += count;
                                    return {};
                                  },
                                  {});
    EXPECT_TRUE(read) << read.error().message;
    return names;
  }

  /// The house of a file is the one of the rows, when `changes` were made to those of each version.
  void expect_house_of(const fs::path& file, const std::map<int, std::string>& changes,
                       const std::map<std::string, std::uint32_t>& names_left_out = {}) {
    auto from_file = open_files({file}, {});
    ASSERT_TRUE(from_file);
    BuildingQuery query;
    query.bbox = RequestBox{499'900, 5'699'900, 500'100, 5'700'100, {}, Crs{"EPSG:25832"}};
    query.crs = Crs{"EPSG:25832"};
    const auto expected = read_model(**from_file, query);
    ASSERT_TRUE(expected) << expected.error().message;
    ASSERT_EQ(expected->size(), 1u);
    EXPECT_EQ(left_out(**from_file, query), names_left_out);
    for (const auto& [major, change] : changes) {
      const auto url = server().create_citydb({.major = major, .srid = 25832});
      ASSERT_TRUE(url) << url.error().message;
      auto database = citydb_support::Database::open(*url);
      const auto sql = citydb_support::citydb_file(fmt::format("fixture_v{}.sql", major));
      ASSERT_TRUE(database && sql);
      for (const auto& statements : {*sql, change}) {
        const auto stored = database->run(statements);
        ASSERT_TRUE(stored) << stored.error().message;
      }
      const auto factory = open_citydb({.url = *url});
      ASSERT_TRUE(factory) << factory.error().message;
      const auto source = (*factory)();
      const auto found = read_model(**source, query);
      ASSERT_TRUE(found) << found.error().message;
      expect_same(*expected, *found, fmt::format("3DCityDB {}", major));
      EXPECT_EQ(left_out(**source, query), names_left_out);
    }
  }
};

TEST_F(HouseByHand, IsTheHouseOfTheFile) {
  expect_house_of(CITYMESH_CITYDB_FIXTURE, {{4, ""}, {5, ""}});
}

TEST_F(HouseByHand, SurfacesOfExtensionsAreLeftOutAndCountedAsInTheFile) {
  std::ifstream in(CITYMESH_CITYDB_FIXTURE);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  // The front of the annex, which has a window.
  const std::string begin = "<bldg:WallSurface gml:id=\"annex_front\">",
                    end = "</bldg:WallSurface>";
  const auto at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  text.replace(text.find(end, at), end.size(), "</green:Facade>");
  text.replace(at, begin.size(), "<green:Facade xmlns:green=\"https://green.test/ade\">");
  const TempFolder folder;
  std::ofstream(folder / "house.gml") << text;
  expect_house_of(
      folder / "house.gml",
      {{4,
        "INSERT INTO citydb.objectclass (id, is_ade_class, classname, superclass_id, ade_id)"
        " VALUES (10034, 1, 'Facade', 34, 1);"
        "UPDATE citydb.cityobject SET objectclass_id = 10034 WHERE gmlid = 'annex_front';"
        "UPDATE citydb.thematic_surface SET objectclass_id = 10034 WHERE id = 7"},
       {5,
        "INSERT INTO citydb.objectclass (id, classname, superclass_id, ade_id)"
        " VALUES (10709, 'Facade', 709, 1);"
        "UPDATE citydb.feature SET objectclass_id = 10709 WHERE objectid = 'annex_front'"}},
      {{"Facade", 1}});
}

INSTANTIATE_TEST_SUITE_P(Files, StoredModel, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace citymesh
