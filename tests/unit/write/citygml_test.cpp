#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/xmlschemas.h>

#include <memory>
#include <set>

#include "core/gates/gates.h"
#include "tests/unit/write/scene.h"
#include "tests/unit/write/writing.h"

namespace citymesh {
namespace {

using test::encode;
using ::testing::HasSubstr;
using ::testing::Not;

class BothVersions : public ::testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(CityGml, BothVersions, ::testing::Values("citygml2", "citygml3"),
                         [](const auto& param) { return std::string(param.param); });

/// Whether texts stand in this order.
void expect_order(const std::string& xml, const std::vector<std::string>& texts) {
  std::size_t at = 0;
  for (const std::string& text : texts) {
    const auto found = xml.find(text, at);
    ASSERT_NE(found, std::string::npos) << text << " after byte " << at << "\n" << xml;
    at = found + text.size();
  }
}

TEST_P(BothVersions, StatesCrsDimensionAndAnEnvelopeThatBeginsAtTheOrigin) {
  const std::string xml = encode(GetParam(), test::building("b_1", test::box(5, 5, 3, {2, 3, 4})));
  EXPECT_THAT(xml, HasSubstr("srsName=\"urn:ogc:def:crs:EPSG::25833\" srsDimension=\"3\""));
  EXPECT_THAT(xml, HasSubstr("<gml:lowerCorner>391000.0000 5820000.0000 0.0000 "));
  EXPECT_THAT(xml, HasSubstr("<gml:upperCorner>391007.0000 5820008.0000 7.0000 "));
}

TEST_P(BothVersions, NamesACompoundCrs) {
  Scene scene = test::kScene;
  scene.crs.id = "EPSG:25833+5783";
  EXPECT_THAT(encode(GetParam(), test::building("b_1", test::box(1, 1, 1)), scene),
              HasSubstr("\"urn:ogc:def:crs,crs:EPSG::25833,crs:EPSG::5783\""));
}

TEST_P(BothVersions, WritesEachPolygonOnceAndReferencesItFromTheSolid) {
  const std::string xml = encode(GetParam(), test::building("b_1", test::box(1, 1, 1)));
  for (int i = 0; i < 6; ++i) {
    const std::string id = "cm.b_1.p" + std::to_string(i);
    EXPECT_THAT(xml, HasSubstr("<gml:Polygon gml:id=\"" + id + "\">"));
    EXPECT_THAT(xml, HasSubstr("<gml:surfaceMember xlink:href=\"#" + id + "\"/>"));
  }
  EXPECT_THAT(xml, HasSubstr("391000.0000 5820001.0000 0.0000 391001.0000"));
}

TEST_P(BothVersions, KeepsTheIdsThatXmlCanHoldAndMakesTheOthersValidAndUnique) {
  auto building = test::rich_building();
  building.bodies[1].gml_id = "1 house one";  // becomes the same id as the building's
  const std::string xml = encode(GetParam(), building);
  EXPECT_THAT(xml, HasSubstr("<bldg:Building gml:id=\"b_1_house_one\">"));
  EXPECT_THAT(xml, HasSubstr("gml:id=\"b_1_house_one_2\""));
  EXPECT_THAT(xml, HasSubstr("WallSurface gml:id=\"GML_south\""));
  EXPECT_THAT(xml, HasSubstr("RoofSurface gml:id=\"_roof_1_\""));
  std::set<std::string> ids;
  for (auto at = xml.find("gml:id=\""); at != std::string::npos; at = xml.find("gml:id=\"", at)) {
    at += 8;
    const std::string id = xml.substr(at, xml.find('"', at) - at);
    EXPECT_TRUE(ids.insert(id).second) << id;
  }
}

TEST_P(BothVersions, WritesCavitiesAsInteriorShellsAndHolesAsInteriorRings) {
  const std::string xml = encode(GetParam(), test::building("b_1", test::with_shaft_and_cavity()));
  const std::string shell = GetParam() == "citygml2" ? "<gml:interior>\n<gml:CompositeSurface"
                                                     : "<gml:interior>\n<gml:Shell";
  expect_order(xml, {"<gml:exterior>\n", shell, shell});
  expect_order(xml, {"<gml:interior><gml:LinearRing>", "<gml:interior><gml:LinearRing>"});
}

TEST_P(BothVersions, HasGenericAttributesOfTheRightType) {
  const std::string xml = encode(GetParam(), test::rich_building());
  EXPECT_THAT(xml, HasSubstr("A &amp; B &lt;&quot;C&quot;&gt;"));
  if (GetParam() == "citygml2") {
    EXPECT_THAT(xml, HasSubstr("<gen:intAttribute name=\"rooms\">\n<gen:value>-5</gen:value>"));
    EXPECT_THAT(xml, HasSubstr("<gen:doubleAttribute name=\"rent\">\n<gen:value>12.5</gen:value>"));
    EXPECT_THAT(xml, HasSubstr("<gen:stringAttribute name=\"storeysBelowGround\">"))
        << "a value that the schema's element cannot hold";
  } else {
    EXPECT_THAT(xml, HasSubstr("<gen:IntAttribute>\n<gen:name>rooms</gen:name>"));
    EXPECT_THAT(xml, HasSubstr("<gen:IntAttribute>\n<gen:name>yearOfConstruction</gen:name>"));
  }
}

TEST(CityGml2, HasItsElementsInTheOrderOfTheSchema) {
  expect_order(encode("citygml2", test::rich_building()), {"<bldg:Building ",
                                                           "<gml:name>Rathaus",
                                                           "<creationDate>2020-02-03<",
                                                           "<gen:",
                                                           "<bldg:class>",
                                                           "<bldg:function>1010<",
                                                           "<bldg:function>1020<",
                                                           "<bldg:usage>",
                                                           "<bldg:yearOfConstruction>1987<",
                                                           "<bldg:roofType>1000<",
                                                           "<bldg:measuredHeight uom=\"m\">3.25<",
                                                           "<bldg:storeysAboveGround>1<",
                                                           "<bldg:outerBuildingInstallation>",
                                                           "<bldg:lod2Geometry>",
                                                           "<bldg:boundedBy>",
                                                           "</bldg:outerBuildingInstallation>",
                                                           "<bldg:boundedBy>",
                                                           "<bldg:GroundSurface",
                                                           "<bldg:opening>",
                                                           "<bldg:Window gml:id=\"GML_window\">",
                                                           "<bldg:lod3MultiSurface>",
                                                           "<bldg:lod3Solid>",
                                                           "<bldg:consistsOfBuildingPart>",
                                                           "<bldg:lod2Solid>",
                                                           "<bldg:boundedBy>",
                                                           "<bldg:consistsOfBuildingPart>",
                                                           "<bldg:lod1Solid>",
                                                           "</bldg:consistsOfBuildingPart>\n",
                                                           "<bldg:address>",
                                                           "<xAL:CountryName>Germany<",
                                                           "<xAL:AdministrativeAreaName>BE<",
                                                           "<xAL:LocalityName>Berlin<",
                                                           "<xAL:PostBoxNumber>PO 7<",
                                                           "<xAL:ThoroughfareNumber>12a<",
                                                           "<xAL:ThoroughfareName>Main Street<",
                                                           "<xAL:PostalCodeNumber>12345<",
                                                           "</bldg:Building>"});
}

TEST(CityGml2, HasNoBoundarySurfacesAtLod1AndNamesTheTypeOfItsPolygons) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  building.bodies[0].lod = "1.2";
  const std::string xml = encode("citygml2", building);
  EXPECT_THAT(xml, Not(HasSubstr("boundedBy><bldg")));
  EXPECT_THAT(xml, HasSubstr("<bldg:lod1Solid>"));
  EXPECT_THAT(xml, HasSubstr("<gml:Polygon gml:id=\"roof\">\n<gml:name>RoofSurface</gml:name>"));
}

TEST(CityGml3, HasItsElementsInTheOrderOfTheSchema) {
  expect_order(encode("citygml3", test::rich_building()),
               {"<bldg:Building ",
                "<gml:name>Rathaus",
                "<genericAttribute>",
                "<boundary>",
                "<con:fillingSurface>",
                "<con:WindowSurface gml:id=\"GML_window\">",
                "<lod3Solid>",
                "<con:dateOfConstruction>1987-05-06<",
                "<con:height>",
                "<con:value uom=\"m\">3.25<",
                "<bldg:class>",
                "<bldg:function>1010<",
                "<bldg:usage>",
                "<bldg:roofType>",
                "<bldg:storeysAboveGround>",
                "<bldg:buildingInstallation>",
                "<bldg:address>",
                "<xAL:NameElement>Germany<",
                "<xAL:NameElement>Main Street<",
                "<xAL:Number>12a<",
                "<xAL:Identifier>12345<",
                "<bldg:buildingPart>",
                "<lod2Solid>",
                "<bldg:buildingPart>",
                "<lod1MultiSurface>",
                "<lod1Solid>",
                "</bldg:Building>"});
}

TEST(CityGml3, IsUniqueInWhatAWallWithoutNeighbourOfAWindowGets) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  building.bodies[0].lod = "3";
  for (Face& face : building.bodies[0].mesh.faces) face.type = SurfaceType::Window;
  const std::string xml = encode("citygml3", building);
  EXPECT_THAT(xml, HasSubstr("<con:WallSurface gml:id=\"cm.b_1.h0\">\n<con:fillingSurface>"));
}

/// With CITYMESH_SCHEMAS naming a folder of OGC's schemas (files `citygml2.xsd` and `citygml3.xsd`
/// that import the building and generics modules), files are validated against them.
TEST_P(BothVersions, HasDatesAndRelationsInTheElementsOfTheSchemaWhereTheyAreOnes) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  const std::string time = GetParam() == "citygml3" ? "T00:00:00" : "";
  building.attributes = {{"creationDate", "2014-07-31" + time},
                         {"terminationDate", "2023-02-29" + time},
                         {"relativeToTerrain", "entirelyAboveTerrain"},
                         {"relativeToWater", "nearWater"}};
  const std::string xml = encode(GetParam(), building);
  EXPECT_THAT(xml, HasSubstr("<creationDate>2014-07-31" + time + "</creationDate>"));
  EXPECT_THAT(xml, Not(HasSubstr("<terminationDate>"))) << "no such day";
  EXPECT_THAT(xml, HasSubstr("<relativeToTerrain>entirelyAboveTerrain</relativeToTerrain>"));
  EXPECT_THAT(xml, Not(HasSubstr("<relativeToWater>"))) << "not of the schema's list";
}

TEST(CityGml3, HasNoOpeningsInClosuresWhichAreNoSurfacesOfAConstruction) {
  auto building = test::rich_building();
  for (Body& body : building.bodies)
    for (Face& face : body.mesh.faces)
      if (face.type == SurfaceType::WallSurface) face.type = SurfaceType::ClosureSurface;
  const std::string xml = encode("citygml3", building);
  ASSERT_THAT(xml, HasSubstr("<ClosureSurface"));
  std::size_t openings = 0;
  for (auto at = xml.find("<con:fillingSurface>"); at != std::string::npos;
       at = xml.find("<con:fillingSurface>", at + 1), ++openings) {
    const auto closure = xml.rfind("<ClosureSurface", at),
               closed = xml.rfind("</ClosureSurface", at);
    EXPECT_TRUE(closure == std::string::npos || (closed != std::string::npos && closed > closure))
        << xml.substr(closure, at - closure);
  }
  EXPECT_GT(openings, 0u);
}

TEST_P(BothVersions, IsValidAgainstTheSchemasOfOgc) {
  const char* folder = std::getenv("CITYMESH_SCHEMAS");
  if (folder == nullptr) GTEST_SKIP() << "CITYMESH_SCHEMAS names no folder of OGC's schemas";
  const std::string schema_file =
      (std::filesystem::path(folder) / (std::string(GetParam()) + ".xsd")).string();
  const std::unique_ptr<xmlSchemaParserCtxt, void (*)(xmlSchemaParserCtxtPtr)> parser(
      xmlSchemaNewParserCtxt(schema_file.c_str()), xmlSchemaFreeParserCtxt);
  const std::unique_ptr<xmlSchema, void (*)(xmlSchemaPtr)> schema(xmlSchemaParse(parser.get()),
                                                                  xmlSchemaFree);
  ASSERT_TRUE(schema) << schema_file;
  test::TemporaryFolder files;
  test::write_scene(files.path(), GetParam(),
                    {test::rich_building(), test::building("b_2", test::house(10, 8, 5, 9))});
  const std::unique_ptr<xmlSchemaValidCtxt, void (*)(xmlSchemaValidCtxtPtr)> validator(
      xmlSchemaNewValidCtxt(schema.get()), xmlSchemaFreeValidCtxt);
  EXPECT_EQ(xmlSchemaValidateFile(validator.get(),
                                  (files.path() / find_format(GetParam())->file_name).c_str(), 0),
            0);
}

}  // namespace
}  // namespace citymesh
