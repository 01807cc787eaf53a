#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kXal = "xmlns:xAL=\"urn:oasis:names:tc:ciq:xsdschema:xAL:2.0\"";

Building read_one(const std::string& content, const std::string& version = "2.0") {
  const Reading reading = read_text("a.gml", city_model(content, version));
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_THAT(reading.buildings, SizeIs(1));
  return reading.buildings.empty() ? Building{} : reading.buildings.front();
}

std::string address(const std::string& details) {
  return "<bldg:address><Address><xalAddress>" + details + "</xalAddress></Address></bldg:address>";
}

TEST(Addresses, OfXal2AreReadAtAnyNesting) {
  const Building house = read_one(building(
      "b", address("<xAL:AddressDetails " + kXal +
                   "><xAL:Country><xAL:CountryName>Germany</xAL:CountryName><xAL:Locality "
                   "Type=\"Town\"><xAL:LocalityName> Selfkant </xAL:LocalityName><xAL:Thoroughfare>"
                   "<xAL:ThoroughfareNumber>7</xAL:ThoroughfareNumber><xAL:ThoroughfareName>"
                   "Rodebachaue</xAL:ThoroughfareName></xAL:Thoroughfare><xAL:PostalCode>"
                   "<xAL:PostalCodeNumber>52538</xAL:PostalCodeNumber></xAL:PostalCode>"
                   "</xAL:Locality></xAL:Country></xAL:AddressDetails>") +
               address("<xAL:AddressDetails " + kXal +
                       "><xAL:Locality><xAL:LocalityName>Bonn</xAL:LocalityName><xAL:PostBox>"
                       "<xAL:PostBoxNumber>12</xAL:PostBoxNumber></xAL:PostBox></xAL:Locality>"
                       "</xAL:AddressDetails>")));
  EXPECT_THAT(house.addresses, ElementsAre(Address{.street = "Rodebachaue",
                                                   .house_number = "7",
                                                   .zip_code = "52538",
                                                   .city = "Selfkant",
                                                   .country = "Germany"},
                                           Address{.po_box = "12", .city = "Bonn"}));
  EXPECT_THAT(house.attributes, IsEmpty());
  EXPECT_THAT(house.skipped_ade_elements, IsEmpty());
}

TEST(Addresses, OfXal3AreRead) {
  const Building house = read_one(
      building("b", address("<x:Address xmlns:x=\"urn:oasis:names:tc:ciq:xal:3\"><x:Country>"
                            "<x:NameElement>USA</x:NameElement></x:Country><x:AdministrativeArea>"
                            "<x:NameElement>DC</x:NameElement></x:AdministrativeArea><x:Locality>"
                            "<x:NameElement>Washington</x:NameElement></x:Locality><x:Thoroughfare>"
                            "<x:NameElement>First St SE</x:NameElement><x:Number>100</x:Number>"
                            "</x:Thoroughfare><x:PostCode><x:Identifier>20543</x:Identifier>"
                            "</x:PostCode></x:Address>")),
      "3.0");
  EXPECT_THAT(house.addresses, ElementsAre(Address{.street = "First St SE",
                                                   .house_number = "100",
                                                   .zip_code = "20543",
                                                   .city = "Washington",
                                                   .state = "DC",
                                                   .country = "USA"}));
}

TEST(Addresses, ByXlinkAreCounted) {
  const Reading reading =
      read_text("a.gml", city_model(building("b", "<bldg:address xlink:href=\"#a1\"/>")));
  EXPECT_THAT(reading.buildings.at(0).addresses, IsEmpty());
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("1 addresses by xlink:href")));
}

TEST(Installations, AreReadBesideTheShellWithTheirSurfacesAndAttributes) {
  const std::string chimney =
      "<bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id=\"chimney\">"
      "<bldg:function>1010</bldg:function>" +
      surface("WallSurface", "cw", multi_surface(member(polygon("cp", square(100, 100, 9))))) +
      "<bldg:lod3Geometry><gml:MultiSurface>" + member(polygon("c3", square(2, 2, 9))) +
      "</gml:MultiSurface></bldg:lod3Geometry></bldg:BuildingInstallation>"
      "</bldg:outerBuildingInstallation>";
  const Building house =
      read_one(building("b", chimney +
                                 "<bldg:outerBuildingInstallation><bldg:BuildingInstallation/>"
                                 "</bldg:outerBuildingInstallation>" +
                                 multi_surface(member(polygon("own", square(0, 0))))));
  ASSERT_THAT(house.installations, SizeIs(2));
  const Building& first = house.installations[0];
  EXPECT_EQ(first.gml_id, "chimney");
  EXPECT_EQ(first.kind, ObjectKind::BuildingInstallation);
  EXPECT_EQ(first.parent, "b");
  EXPECT_THAT(first.attributes, ElementsAre(std::pair("function", AttributeValue("1010"))));
  ASSERT_THAT(first.surfaces, SizeIs(1));
  EXPECT_EQ(first.surfaces[0].gml_id, "cw");
  ASSERT_THAT(first.geometries, SizeIs(2));
  EXPECT_EQ(first.geometries[0].lod, (Lod{3, -1}));
  EXPECT_TRUE(first.geometries[1].assembled);
  EXPECT_EQ(house.installations[1].gml_id, "b_2");
  ASSERT_THAT(house.geometries, SizeIs(1));
  EXPECT_THAT(house.geometries[0].polygons, SizeIs(1)) << "installations are no part of the shell";
  EXPECT_EQ(extent(house).max.x, 10) << "nor of the extent";
}

TEST(Installations, DoNotMoveTheOriginNorTheFootprint) {
  const std::string text = city_model(
      building("b", "<bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id=\"far\">" +
                        multi_surface(member(polygon("p", square(500, 500, -50)))) +
                        "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>" +
                        multi_surface(member(polygon("own", square(1000, 1000, 5))))));
  EXPECT_EQ(read_text("a.gml", text).selection.origin, (Point3{1000, 1000, 5}));
  BuildingQuery query;
  query.bbox = RequestBox{499, 499, 511, 511, {}, {}};
  EXPECT_EQ(read_text("a.gml", text, query).selection.buildings, 0u);
}

TEST(Installations, OfVersion3InsideTheBuildingAreLeftOut) {
  const auto installation = [](const std::string& id, const std::string& relation) {
    return "<bldg:buildingInstallation><bldg:BuildingInstallation gml:id=\"" + id +
           "\"><con:relationToConstruction>" + relation +
           "</con:relationToConstruction><lod2MultiSurface><gml:MultiSurface>" +
           member(polygon(id + "p", square(0, 0))) +
           "</gml:MultiSurface></lod2MultiSurface></bldg:BuildingInstallation>"
           "</bldg:buildingInstallation>";
  };
  const Building house = read_one(
      building("b", installation("stairs", "inside") + installation("balcony", "outside")), "3.0");
  ASSERT_THAT(house.installations, SizeIs(1));
  EXPECT_EQ(house.installations[0].gml_id, "balcony");
  EXPECT_THAT(house.installations[0].geometries, SizeIs(1));
}

TEST(Generics, OfEveryKindAndVersionKeepTheNameOfTheirSet) {
  const Building house = read_one(
      building("b",
               "<genericAttribute><gen:GenericAttributeSet><gen:name>energy</gen:name>"
               "<gen:genericAttribute><gen:MeasureAttribute><gen:name>demand</gen:name>"
               "<gen:value uom=\"kWh\">12.5</gen:value></gen:MeasureAttribute>"
               "</gen:genericAttribute></gen:GenericAttributeSet></genericAttribute>"
               "<genericAttribute><gen:CodeAttribute><gen:name>class</gen:name><gen:value "
               "codeSpace=\"x\">31</gen:value></gen:CodeAttribute></genericAttribute>"
               "<genericAttribute><gen:IntAttribute><gen:name>n</gen:name><gen:value>3</gen:value>"
               "</gen:IntAttribute></genericAttribute><genericAttribute><gen:DateAttribute>"
               "<gen:name>day</gen:name><gen:value>2020-02-01</gen:value></gen:DateAttribute>"
               "</genericAttribute><genericAttribute><gen:UriAttribute><gen:name>u</gen:name>"
               "<gen:value>http://x</gen:value></gen:UriAttribute></genericAttribute>"
               "<genericAttribute><gen:DoubleAttribute><gen:name>d</gen:name><gen:value>0.25"
               "</gen:value></gen:DoubleAttribute></genericAttribute>"),
      "3.0");
  EXPECT_THAT(house.attributes, ElementsAre(std::pair("energy.demand", AttributeValue(12.5)),
                                            std::pair("class", AttributeValue("31")),
                                            std::pair("n", AttributeValue(std::int64_t{3})),
                                            std::pair("day", AttributeValue("2020-02-01")),
                                            std::pair("u", AttributeValue("http://x")),
                                            std::pair("d", AttributeValue(0.25))));
}

TEST(Attributes, NameDescriptionAndDatesAreKept) {
  const Building house = read_one(building(
      "b",
      "<gml:description>old</gml:description><gml:name codeSpace=\"x\">Hall</gml:name>"
      "<creationDate>2014-07-09</creationDate><terminationDate>2020-01-01</terminationDate>"));
  EXPECT_THAT(house.attributes,
              ElementsAre(std::pair("description", AttributeValue("old")),
                          std::pair("name", AttributeValue("Hall")),
                          std::pair("creationDate", AttributeValue("2014-07-09")),
                          std::pair("terminationDate", AttributeValue("2020-01-01"))));
}

TEST(Ade, FeaturesOfOtherNamespacesAreCountedByType) {
  const Reading reading = read_text(
      "a.gml", city_model("<cityObjectMember><ade:Stadium gml:id=\"s\"/></cityObjectMember>"
                          "<cityObjectMember><ade:Stadium gml:id=\"t\"/></cityObjectMember>" +
                          building("b", multi_surface(member(polygon("p", square(0, 0)))))));
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("2 objects of extension types")));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("(Stadium 2)")));
}

TEST(Roots, ABuildingAloneAndFeatureCollectionsAreRead) {
  const std::string spaces =
      " xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\" "
      "xmlns:gml=\"http://www.opengis.net/gml\" xmlns:wfs=\"http://www.opengis.net/wfs/2.0\"";
  const std::string inner = multi_surface(member(polygon("p", square(0, 0))));
  const std::string house = "<bldg:Building gml:id=\"b\">" + inner + "</bldg:Building>";
  for (const std::string& text :
       {"<bldg:Building gml:id=\"b\"" + spaces + ">" + inner + "</bldg:Building>",
        "<gml:FeatureCollection" + spaces + "><gml:featureMember>" + house +
            "</gml:featureMember></gml:FeatureCollection>",
        "<gml:FeatureCollection" + spaces + "><gml:featureMembers>" + house +
            "</gml:featureMembers></gml:FeatureCollection>",
        "<wfs:FeatureCollection" + spaces + "><wfs:boundedBy/><wfs:member>" + house +
            "</wfs:member></wfs:FeatureCollection>",
        "<wfs:FeatureCollection" + spaces + "><wfs:member><wfs:FeatureCollection><wfs:member>" +
            house + "</wfs:member></wfs:FeatureCollection></wfs:member></wfs:FeatureCollection>"}) {
    const Reading reading = read_text("a.gml", text);
    EXPECT_THAT(reading.ids(), ElementsAre("b")) << text;
    EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  }
}

}  // namespace
}  // namespace citymesh
