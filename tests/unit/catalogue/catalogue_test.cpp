#include "services/catalogue/catalogue.h"

#include <map>

#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kUtm33 = "EPSG:25833";

std::string tile(const std::vector<std::string>& buildings) {
  std::string content = envelope(kUtm33, "390000 5820000 30", "391000 5821000 90");
  for (const std::string& building : buildings) content += building;
  return city_model(content);
}

BuildingQuery box(double min_x, double min_y, double max_x, double max_y) {
  BuildingQuery query;
  query.bbox = RequestBox{min_x, min_y, max_x, max_y, {}, Crs{kUtm33}};
  return query;
}

/// A folder of documents and its catalogue, both gone at the end.
class Indexed : public ::testing::Test {
 protected:
  CatalogueReport update() {
    auto report = update_catalogue(options(), {});
    EXPECT_TRUE(report) << report.error().message;
    return report ? *report : CatalogueReport{};
  }
  std::unique_ptr<CitySource> open() {
    auto source = open_catalogued(options());
    EXPECT_TRUE(source);
    return source ? std::move(*source) : nullptr;
  }
  Reading read(const BuildingQuery& query = {}) { return read_from(*open(), query); }
  CatalogueOptions options() const {
    return {.data = documents_.folder(), .state = state_.path() / "catalogue"};
  }

  Documents documents_;
  TempFolder state_;
};

TEST_F(Indexed, EverythingIsReadAsFromTheFilesThemselves) {
  documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010),
                                simple_building("a2", 390500, 5820500)}));
  documents_.add("b.gml.gz", tile({simple_building("b1", 390020, 5820010)}));
  documents_.add(
      "c.city.jsonl",
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],)"
      R"("translate":[390000,5820000,30]},"metadata":{"referenceSystem":)"
      R"("https://www.opengis.net/def/crs/EPSG/0/25833"},"CityObjects":{},"vertices":[]})"
      "\n"
      R"({"type":"CityJSONFeature","id":"c1","CityObjects":{"c1":{"type":"Building",)"
      R"("geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}},)"
      R"("vertices":[[30,10,0],[40,10,0],[40,20,0]]})"
      "\n");
  const Reading catalogued = read();
  const Reading direct = documents_.read();
  ASSERT_FALSE(catalogued.error);
  EXPECT_THAT(catalogued.ids(), ElementsAre("a1", "a2", "b1", "c1"));
  EXPECT_EQ(catalogued.ids(), direct.ids());
  EXPECT_EQ(catalogued.selection.origin, direct.selection.origin);
  for (std::size_t i = 0; i < direct.buildings.size(); ++i) {
    ASSERT_EQ(catalogued.buildings[i].geometries.size(), 1u);
    EXPECT_EQ(catalogued.buildings[i].geometries[0].points,
              direct.buildings[i].geometries[0].points);
  }
}

TEST_F(Indexed, ABoxIsTestedInDoublesNotInTheFloatsOfTheTree) {
  // 5820010.25 and 5820010.3 are one float32.
  documents_.add("a.gml", tile({simple_building("south", 390010, 5820000.25),
                                simple_building("north", 390010, 5820020.3)}));
  EXPECT_THAT(read(box(390000, 5820010.3, 391000, 5820020.25)).ids(), IsEmpty());
  EXPECT_THAT(read(box(390000, 5820010.25, 391000, 5820020.25)).ids(), ElementsAre("south"));
  EXPECT_THAT(read(box(390000, 5820010.3, 391000, 5820020.3)).ids(), ElementsAre("north"));
}

TEST_F(Indexed, IdsOfBuildingsAndPartsAreFound) {
  documents_.add(
      "a.gml",
      tile({simple_building("a1", 390010, 5820010),
            building("a2", "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"a2_part\">" +
                               multi_surface(member(polygon("p", square(390100, 5820100)))) +
                               "</bldg:BuildingPart></bldg:consistsOfBuildingPart>")}));
  BuildingQuery query;
  query.object_ids = {"a2_part", "nobody"};
  const Reading reading = read(query);
  EXPECT_THAT(reading.ids(), ElementsAre("a2"));
  EXPECT_THAT(reading.selection.missing_ids, ElementsAre("nobody"));
}

TEST_F(Indexed, GeometryThatBuildingsShareIsFoundAgain) {
  const std::string wall = polygon("wall", square(390010, 5820010));
  documents_.add(
      "a.gml",
      tile({building("owner", multi_surface(member(wall))),
            simple_building("between", 390500, 5820500),
            building("borrower", multi_surface(member_by("#wall") +
                                               member(polygon("own", square(390020, 5820010)))))}));
  BuildingQuery query;
  query.object_ids = {"borrower"};
  const Reading reading = read(query);
  ASSERT_THAT(reading.ids(), ElementsAre("borrower"));
  EXPECT_THAT(reading.buildings[0].source_issues, IsEmpty());
  EXPECT_EQ(reading.buildings[0].geometries.at(0).polygons.size(), 2u);
}

TEST_F(Indexed, OnlyWhatIsNewOrChangedIsReadAgain) {
  documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010)}));
  const auto b = documents_.add("b.gml", tile({simple_building("b1", 390020, 5820010)}));
  EXPECT_EQ(update().indexed, 2u);
  EXPECT_EQ(update().unchanged, 2u);

  std::filesystem::last_write_time(b, std::filesystem::file_time_type::clock::now());
  const auto touched = update();
  EXPECT_EQ(touched.indexed, 0u) << "the same bytes at another time";
  EXPECT_EQ(touched.unchanged, 2u);

  documents_.add("b.gml", tile({simple_building("b2", 390020, 5820010)}));
  documents_.add("c.gml", tile({simple_building("c1", 390020, 5820010)}));
  const auto changed = update();
  EXPECT_EQ(changed.indexed, 2u);
  EXPECT_THAT(read().ids(), ElementsAre("a1", "b2", "c1"));

  std::filesystem::remove(b);
  EXPECT_EQ(update().removed, 1u);
  EXPECT_THAT(read().ids(), ElementsAre("a1", "c1"));
}

TEST_F(Indexed, AFileThatChangesAfterTheSelectionIsAnErrorNotAnotherBuilding) {
  documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010)}));
  const auto source = open();
  const auto selection = source->select({}, {});
  ASSERT_TRUE(selection);
  documents_.add("a.gml", tile({simple_building("intruder", 390010, 5820010)}));
  std::size_t delivered = 0;
  const auto read = source->read({}, *selection,
                                 [&](Building&&) -> Result<void> {
                                   ++delivered;
                                   return {};
                                 },
                                 {});
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(read.error().message, HasSubstr("a.gml"));
  EXPECT_EQ(delivered, 0u);
}

TEST_F(Indexed, AFileThatVanishesAfterTheSelectionIsAnError) {
  const auto a = documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010)}));
  const auto source = open();
  const auto selection = source->select({}, {});
  ASSERT_TRUE(selection);
  std::filesystem::remove(a);
  const auto read = source->read({}, *selection, [](Building&&) { return Result<void>(); }, {});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("a.gml"));
}

TEST_F(Indexed, UnreadableFilesAreReportedAndTheOthersServed) {
  documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010)}));
  documents_.add("broken.gml", "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\"><open>");
  documents_.add("notes.txt", "no city model");
  const auto report = update();
  ASSERT_EQ(report.problems.size(), 1u);
  EXPECT_EQ(report.problems[0].first, "broken.gml");
  const Reading reading = read();
  EXPECT_THAT(reading.ids(), ElementsAre("a1"));
  EXPECT_THAT(reading.selection.warnings, ElementsAre(HasSubstr("notes.txt")));
  EXPECT_EQ(reading.input(1).state, "failed");
}

TEST_F(Indexed, ADamagedDatabaseIsAClearError) {
  documents_.add("a.gml", tile({simple_building("a1", 390010, 5820010)}));
  update();
  std::ofstream(options().state / "catalogue.sqlite", std::ios::binary | std::ios::trunc)
      << std::string(4096, 'x');
  const auto report = update_catalogue(options(), {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(report.error().message, HasSubstr("catalogue"));
}

TEST_F(Indexed, RepeatedIdsAndFeaturesOfOneLineKeepTheirPlaces) {
  documents_.add("a.gml", tile({simple_building("same", 390010, 5820010),
                                simple_building("same", 390500, 5820500)}));
  const Reading all = read();
  EXPECT_THAT(all.ids(), ElementsAre("same", "same"));
  const Reading second = read(box(390490, 5820490, 390600, 5820600));
  ASSERT_THAT(second.ids(), ElementsAre("same"));
  EXPECT_NEAR(second.buildings[0].geometries.at(0).points[0].x + second.selection.origin.x, 390500,
              1e-6);
}

TEST_F(Indexed, SeveralCrssInAFolderAreAnErrorOnlyWhereTheSelectionMixesThem) {
  documents_.add("zone33.gml", tile({simple_building("east", 390010, 5820010)}));
  documents_.add("zone32.gml",
                 city_model(envelope("EPSG:25832", "690000 5340000 500", "691000 5341000 600") +
                            simple_building("west", 690010, 5340010)));
  const Reading mixed = read();
  ASSERT_TRUE(mixed.error);
  EXPECT_EQ(mixed.error->code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(mixed.error->message, ::testing::AllOf(HasSubstr("EPSG:25832"), HasSubstr(kUtm33)));
  EXPECT_THAT(read(box(390000, 5820000, 390100, 5820100)).ids(), ElementsAre("east"));
  BuildingQuery both;
  both.crs = Crs{kUtm33};
  EXPECT_THAT(read(both).ids(), ::testing::UnorderedElementsAre("east", "west"));
}

TEST_F(Indexed, MembersOfArchivesAreFilesOfTheirOwn) {
  const auto archive = documents_.folder() / "tiles.zip";
  std::error_code error;
  std::filesystem::copy_file(CITYMESH_TEST_DATA "/meshes/two_tiles.zip", archive, error);
  ASSERT_FALSE(error) << error.message();
  const auto report = update();
  EXPECT_EQ(report.indexed, 1u);
  EXPECT_THAT(report.problems, IsEmpty());
  const Reading reading = read();
  EXPECT_THAT(reading.ids(), ElementsAre("north", "south"));
  EXPECT_EQ(reading.input(0).file, "tiles.zip/a/north.gml");
}

TEST_F(Indexed, CopiesOfTheSameContentDoNotDependOnEachOther) {
  const std::string text = tile({simple_building("a", 390010, 5820010)});
  const auto first = documents_.add("first.gml.gz", text);
  documents_.add("second.gml.gz", text);
  EXPECT_EQ(update().indexed, 2u);
  std::filesystem::remove(first);
  const Reading reading = read();
  EXPECT_FALSE(reading.error) << reading.error->message;
  EXPECT_THAT(reading.ids(), ElementsAre("a"));
}

}  // namespace
}  // namespace citymesh
