#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kRest =
    R"("transform":{"scale":[0.01,0.01,0.01],"translate":[400000,5000000,30]},)"
    R"("vertices":[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0]])";
const std::string kSquare = R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3]]]})";

std::string document(const std::string& objects, const std::string& version = "2.0",
                     const std::string& more = "") {
  return R"({"type":"CityJSON","version":")" + version + "\"," + more + R"("CityObjects":{)" +
         objects + "}," + kRest + "}";
}

std::vector<Point3> corners(const Geometry& geometry, std::size_t polygon) {
  std::vector<Point3> points;
  for (const auto index : geometry.polygons.at(polygon).rings.at(0))
    points.push_back(geometry.points.at(index));
  return points;
}

TEST(CityJsonAddresses, OfBothVersionsAreRead) {
  const Address expected{.street = "rue de la Patate",
                         .house_number = "1",
                         .zip_code = "H0H 0H0",
                         .city = "Chibougamau",
                         .country = "Canada"};
  const Reading two = read_text(
      "a.json",
      document(R"("b":{"type":"Building","address":[{"Country":"Canada","Locality":"Chibougamau",)"
               R"("ThoroughfareNumber":"1","ThoroughfareName":"rue de la Patate",)"
               R"("Postcode":"H0H 0H0","location":{"type":"MultiPoint","lod":"1",)"
               R"("boundaries":[0]}},{}]})"));
  EXPECT_THAT(two.buildings.at(0).addresses, ElementsAre(expected));
  const Reading one = read_text(
      "a.json", document(R"("b":{"type":"Building","address":{"CountryName":"Canada",)"
                         R"("LocalityName":"Chibougamau","ThoroughfareNumber":1,)"
                         R"("ThoroughfareName":"rue de la Patate","PostalCode":"H0H 0H0"}})",
                         "1.0"));
  EXPECT_THAT(one.buildings.at(0).addresses, ElementsAre(expected));
  for (const auto* odd : {"3", "null", "[1,[]]", "\"x\""})
    EXPECT_THAT(read_text("a.json",
                          document(std::string(R"("b":{"type":"Building","address":)") + odd + "}"))
                    .buildings.at(0)
                    .addresses,
                IsEmpty());
}

TEST(CityJsonInstallations, BelongToTheirBuildingOrPartAndAreNoShell) {
  const Reading reading = read_text(
      "a.json", document(R"("b":{"type":"Building","children":["p","i"],"geometry":[)" + kSquare +
                         R"(]},"p":{"type":"BuildingPart","parents":["b"],"children":["j"]},)"
                         R"("i":{"type":"BuildingInstallation","parents":["b"],"geometry":[)" +
                         kSquare +
                         R"(]},"j":{"type":"BuildingInstallation","parents":["p"]},)"
                         R"("k":{"type":"BuildingInstallation"})"));
  ASSERT_THAT(reading.ids(), ElementsAre("b"));
  const Building& house = reading.buildings[0];
  ASSERT_THAT(house.installations, SizeIs(1));
  EXPECT_EQ(house.installations[0].kind, ObjectKind::BuildingInstallation);
  EXPECT_THAT(house.installations[0].geometries, SizeIs(1));
  ASSERT_THAT(house.parts, SizeIs(1));
  EXPECT_EQ(house.parts[0].kind, ObjectKind::BuildingPart);
  EXPECT_THAT(house.parts[0].installations, SizeIs(1));
  EXPECT_THAT(house.geometries, SizeIs(1));
  EXPECT_THAT(reading.selection.warnings,
              Contains(HasSubstr("BuildingInstallation without a building 1")));
}

const std::string kTemplates =
    R"("geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2.1",)"
    R"("boundaries":[[[0,1,2]]],"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0]}},)"
    R"({"type":"Solid","lod":"1","boundaries":[[[[0,1,2]]],[[[2,1,0]]]]}],)"
    R"("vertices-templates":[[0.0,0.0,0.0],[4.0,0.0,0.0],[4.0,3.0,1.0]]},)";

std::string instance(const std::string& number, const std::string& matrix) {
  return R"({"type":"GeometryInstance","template":)" + number +
         R"(,"boundaries":[1],"transformationMatrix":[)" + matrix + "]}";
}

const std::string kUnit = "1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1";

TEST(CityJsonTemplates, ArePutByMatrixAndReferenceVertex) {
  const std::string objects = R"("b":{"type":"Building","geometry":[)" +
                              instance("0", "0,-1,0,0.5, 1,0,0,0, 0,0,2,0, 0,0,0,1") + "," +
                              instance("1", kUnit) + "]}";
  const Reading reading = read_text("a.json", document(objects, "2.0", kTemplates));
  const Building& house = reading.buildings.at(0);
  EXPECT_THAT(house.source_issues, IsEmpty());
  ASSERT_THAT(house.geometries, SizeIs(2));
  const Point3 origin = reading.selection.origin;
  EXPECT_EQ(house.geometries[0].lod, (Lod{2, 1}));
  EXPECT_THAT(corners(house.geometries[0], 0),
              ElementsAre(Point3{400010.5 - origin.x, 5000000 - origin.y, 30 - origin.z},
                          Point3{400010.5 - origin.x, 5000004 - origin.y, 30 - origin.z},
                          Point3{400007.5 - origin.x, 5000004 - origin.y, 32 - origin.z}));
  ASSERT_THAT(house.surfaces, SizeIs(1));
  EXPECT_EQ(house.surfaces[0].type, SurfaceType::RoofSurface);
  EXPECT_EQ(house.geometries[0].polygons[0].surface, 0);
  EXPECT_EQ(house.geometries[1].type, GeometryType::Solid);
  EXPECT_THAT(house.geometries[1].solids.at(0).interiors, SizeIs(1)) << "inner shells stay";
}

TEST(CityJsonTemplates, OfASequenceStandInItsFirstLine) {
  const std::string text =
      R"({"type":"CityJSON","version":"2.0",)" + kTemplates +
      R"("transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{},"vertices":[]})"
      "\n"
      R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building","geometry":[)" +
      instance("0", kUnit) + R"(]}},"vertices":[[0,0,0],[10,10,0]]})" + "\n";
  const Reading reading = read_text("a.jsonl", text);
  EXPECT_THAT(reading.buildings.at(0).geometries, SizeIs(1));
}

TEST(CityJsonTemplates, InstancesThatDoNotFitAreIssues) {
  for (const std::string& bad :
       {instance("7", kUnit), instance("0", "1,2,3"), instance("\"x\"", kUnit),
        instance("0", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0"),
        std::string(R"({"type":"GeometryInstance","template":0,"boundaries":[99],)"
                    R"("transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})")}) {
    const Reading reading = read_text(
        "a.json",
        document(R"("b":{"type":"Building","geometry":[)" + bad + "]}", "2.0", kTemplates));
    EXPECT_THAT(reading.buildings.at(0), HasIssue(issue_code::kUnreadableGeometry)) << bad;
  }
}

TEST(CityJsonSemantics, OpeningsNamedByTheirWallOnlyGetTheirParent) {
  const Reading reading = read_text(
      "a.json",
      document(R"("b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":3,)"
               R"("boundaries":[[[0,1,2]],[[0,2,3]]],"semantics":{"surfaces":[)"
               R"({"type":"WallSurface","children":[1]},{"type":"Window"}],"values":[0,1]}}]})"));
  const Building& house = reading.buildings.at(0);
  ASSERT_THAT(house.surfaces, SizeIs(2));
  EXPECT_EQ(house.surfaces[1].parent, 0);
  EXPECT_EQ(house.surfaces[0].parent, -1);
}

TEST(CityJsonExtensions, AreSkippedByTypeAndExtraMembersTolerated) {
  const Reading reading = read_text(
      "a.json",
      document(R"("n":{"type":"+NoiseBuilding","parents":["b"],"geometry":[]},)"
               R"("b":{"type":"Building","+noise":{"a":1},"attributes":{"+level":3,)"
               R"("nested":{"a":[1,2]}},"geometry":[)" +
                   kSquare + "]}",
               "2.0", R"("+census":{"x":1},"extensions":{"Noise":{"url":"u","version":"1"}},)"));
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("(+NoiseBuilding 1)")));
  EXPECT_THAT(reading.buildings[0].attributes,
              ElementsAre(std::pair("+level", AttributeValue(std::int64_t{3})),
                          std::pair("nested", AttributeValue("{\"a\":[1,2]}"))));
}

}  // namespace
}  // namespace citymesh
