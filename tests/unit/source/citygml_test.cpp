#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::string kGround = "0 0 0 0 10 0 10 10 0 10 0 0 0 0 0";
const std::string kWall = "0 0 0 10 0 0 10 0 5 0 0 5 0 0 0";
const std::string kRoof = "0 0 5 10 0 5 10 10 5 0 10 5 0 0 5";

Building read_one(const std::string& content, const std::string& version = "2.0") {
  const Reading reading = read_text("a.gml", city_model(content, version));
  EXPECT_FALSE(reading.error) << reading.error->message;
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_THAT(reading.buildings, SizeIs(1));
  return reading.buildings.empty() ? Building{} : reading.buildings.front();
}

std::vector<Point3> corners(const Geometry& geometry, std::size_t polygon, std::size_t ring = 0) {
  std::vector<Point3> points;
  for (const auto index : geometry.polygons.at(polygon).rings.at(ring))
    points.push_back(geometry.points.at(index));
  return points;
}

TEST(CityGml, AssemblesABuildingThatHasOnlyBoundarySurfaces) {
  const Building house = read_one(building(
      "house", surface("GroundSurface", "g", multi_surface(member(polygon("pg", kGround)))) +
                   surface("WallSurface", "w", multi_surface(member(polygon("pw", kWall)))) +
                   surface("RoofSurface", "r", multi_surface(member(polygon("pr", kRoof))))));
  ASSERT_THAT(house.geometries, SizeIs(1));
  const Geometry& shell = house.geometries[0];
  EXPECT_TRUE(shell.assembled);
  EXPECT_EQ(shell.type, GeometryType::MultiSurface);
  EXPECT_EQ(shell.lod, (Lod{2, -1}));
  ASSERT_THAT(shell.polygons, SizeIs(3));
  EXPECT_EQ(shell.points.size(), 8u) << "points are shared";
  ASSERT_THAT(house.surfaces, SizeIs(3));
  EXPECT_EQ(house.surfaces[2].type, SurfaceType::RoofSurface);
  EXPECT_EQ(house.surfaces[2].gml_id, "r");
  EXPECT_EQ(shell.polygons[2].surface, 2);
  EXPECT_EQ(shell.polygons[2].gml_id, "pr");
  EXPECT_THAT(shell.polygons[0].rings[0], SizeIs(5)) << "the closing point stays";
  EXPECT_EQ(shell.polygons[0].rings[0].front(), shell.polygons[0].rings[0].back());
}

TEST(CityGml, FollowsXlinksForwardAndGivesThePolygonsTheirSurface) {
  const Building house = read_one(building(
      "house", solid(member_by("#pg") + member_by("#pr")) +
                   surface("GroundSurface", "g", multi_surface(member(polygon("pg", kGround)))) +
                   surface("RoofSurface", "r", multi_surface(member(polygon("pr", kRoof))))));
  ASSERT_THAT(house.geometries, SizeIs(2));
  const Geometry& stated = house.geometries[0];
  EXPECT_EQ(stated.type, GeometryType::Solid);
  EXPECT_FALSE(stated.assembled);
  ASSERT_THAT(stated.solids, SizeIs(1));
  EXPECT_THAT(stated.solids[0].exterior, ElementsAre(0u, 1u));
  EXPECT_EQ(stated.polygons[1].surface, 1);
  EXPECT_TRUE(house.geometries[1].assembled);
  EXPECT_THAT(house.source_issues, IsEmpty());
}

TEST(CityGml, FollowsXlinksBackwardFromSurfacesToTheSolid) {
  const Building house = read_one(
      building("house", solid(member(polygon("pg", kGround)) + member(polygon("pr", kRoof))) +
                            surface("GroundSurface", "g", multi_surface(member_by("#pg"))) +
                            surface("RoofSurface", "r", multi_surface(member_by("#pr")))));
  ASSERT_THAT(house.geometries, SizeIs(2));
  EXPECT_EQ(house.geometries[0].polygons[0].surface, 0);
  EXPECT_EQ(house.geometries[0].polygons[1].surface, 1);
  EXPECT_THAT(house.geometries[1].polygons, SizeIs(2));
}

TEST(CityGml, BorrowsASharedWallFromAnotherBuildingBeforeOrBehind) {
  const std::string ground = member(polygon("own", kGround));
  for (const bool owner_first : {true, false}) {
    const std::string owner = building("owner", multi_surface(member(polygon("wall", kWall))));
    const std::string user = building("user", solid(ground + member_by("#wall")));
    const Reading reading =
        read_text("a.gml", city_model(owner_first ? owner + user : user + owner));
    ASSERT_THAT(reading.buildings, SizeIs(2));
    const Building& borrower = reading.buildings[owner_first ? 1 : 0];
    EXPECT_THAT(borrower.source_issues, IsEmpty());
    ASSERT_THAT(borrower.geometries, SizeIs(1));
    ASSERT_THAT(borrower.geometries[0].polygons, SizeIs(2));
    EXPECT_EQ(borrower.geometries[0].polygons[1].gml_id, "wall");
    EXPECT_EQ(borrower.geometries[0].points.size(), 6u);
  }
}

TEST(CityGml, OrientableSurfacesReverseAndTwoReversalsCancel) {
  const auto oriented = [](const std::string& id, const std::string& sign,
                           const std::string& base) {
    return "<gml:OrientableSurface gml:id=\"" + id + "\" orientation=\"" + sign +
           "\"><gml:baseSurface" + base + "</gml:OrientableSurface>";
  };
  const Building house = read_one(building(
      "house",
      multi_surface(
          member(polygon("p", kGround)) + member(oriented("o1", "-", " xlink:href=\"#p\"/>")) +
          member(oriented("o2", "-", " xlink:href=\"#o1\"/>")) +
          member(oriented("o3", "-", ">" + polygon("q", kRoof) + "</gml:baseSurface>")))));
  const Geometry& geometry = house.geometries.at(0);
  ASSERT_THAT(geometry.polygons, SizeIs(4));
  const auto forward = corners(geometry, 0);
  EXPECT_EQ(corners(geometry, 1), std::vector<Point3>(forward.rbegin(), forward.rend()));
  EXPECT_EQ(corners(geometry, 2), forward);
  EXPECT_EQ(corners(geometry, 3)[1].y - corners(geometry, 3)[0].y, 10) << "reversed roof";
}

TEST(CityGml, ReadsEverySpellingOfARing) {
  const auto with_ring = [](const std::string& content) {
    return building("b",
                    multi_surface(member("<gml:Polygon><gml:exterior><gml:LinearRing>" + content +
                                         "</gml:LinearRing></gml:exterior></gml:Polygon>")));
  };
  const std::vector<Point3> expected{{0, 0, 0}, {4, 0, 0}, {4, 3, 1}, {0, 0, 0}};
  for (const std::string& content : {
           std::string("<gml:posList srsDimension=\"3\">0 0 0 4 0 0 4 3 1 0 0 0</gml:posList>"),
           std::string("<gml:posList>\n\t0 0  0\r\n 4 0 0 +4 3e0 1.0\t0 0 0\n</gml:posList>"),
           std::string("<gml:pos>0 0 0</gml:pos><gml:pos>4 0 0</gml:pos><gml:pos>4 3 1</gml:pos>"
                       "<gml:pos>0 0 0</gml:pos>"),
           std::string(
               "<gml:pointProperty><gml:Point><gml:pos>0 0 0</gml:pos></gml:Point>"
               "</gml:pointProperty><gml:pos>4 0 0</gml:pos><gml:pointRep><gml:Point>"
               "<gml:pos>4 3 1</gml:pos></gml:Point></gml:pointRep><gml:pos>0 0 0</gml:pos>"),
           std::string("<gml:coordinates>0,0,0 4,0,0 4,3,1 0,0,0</gml:coordinates>"),
           std::string("<gml:posList>0 0 0 4 <!-- between --> 0 0 4 3 1 0 0 0</gml:posList>"),
       })
    EXPECT_EQ(corners(read_one(with_ring(content)).geometries.at(0), 0), expected) << content;

  const std::string curves =
      "<gml:Polygon><gml:exterior><gml:Ring><gml:curveMember><gml:LineString><gml:posList>0 0 0 4 "
      "0 0</gml:posList></gml:LineString></gml:curveMember><gml:curveMember><gml:LineString>"
      "<gml:posList>4 0 0 4 3 1 0 0 0</gml:posList></gml:LineString></gml:curveMember></gml:Ring>"
      "</gml:exterior></gml:Polygon>";
  EXPECT_EQ(corners(read_one(building("b", multi_surface(member(curves)))).geometries.at(0), 0),
            expected);
}

TEST(CityGml, KeepsHolesAndPutsTheExteriorFirst) {
  const std::string hole = "<gml:interior>" + ring("2 2 0 2 4 0 4 4 0 2 2 0") + "</gml:interior>";
  const std::string outer = "<gml:exterior>" + ring(kGround) + "</gml:exterior>";
  for (const std::string& rings : {outer + hole, hole + outer}) {
    const Building house =
        read_one(building("b", multi_surface(member("<gml:Polygon>" + rings + "</gml:Polygon>"))));
    const Polygon& polygon = house.geometries.at(0).polygons.at(0);
    ASSERT_THAT(polygon.rings, SizeIs(2));
    EXPECT_THAT(polygon.rings[0], SizeIs(5));
    EXPECT_THAT(polygon.rings[1], SizeIs(4));
  }
}

TEST(CityGml, ReadsSurfacePatchesTrianglesAndSolidsWithCavities) {
  const std::string triangle = "<gml:Triangle><gml:exterior>" + ring("0 0 0 4 0 0 4 3 1 0 0 0") +
                               "</gml:exterior></gml:Triangle>";
  const std::string patch =
      "<gml:PolygonPatch><gml:exterior>" + ring(kGround) + "</gml:exterior></gml:PolygonPatch>";
  const Building house = read_one(building(
      "b",
      "<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>" +
          member("<gml:Surface><gml:patches>" + patch + triangle + "</gml:patches></gml:Surface>") +
          member("<gml:TriangulatedSurface><gml:trianglePatches>" + triangle +
                 "</gml:trianglePatches></gml:TriangulatedSurface>") +
          "</gml:CompositeSurface></gml:exterior><gml:interior><gml:CompositeSurface>" +
          member(polygon("c", kRoof)) +
          "</gml:CompositeSurface></gml:interior></gml:Solid></bldg:lod2Solid>"));
  const Geometry& geometry = house.geometries.at(0);
  ASSERT_THAT(geometry.polygons, SizeIs(4));
  EXPECT_THAT(geometry.solids.at(0).exterior, ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(geometry.solids.at(0).interiors.at(0), ElementsAre(3u));
}

TEST(CityGml, ReadsCompositeAndMultiSolids) {
  const auto one = [](const std::string& id) {
    return "<gml:solidMember><gml:Solid><gml:exterior><gml:CompositeSurface>" +
           member(polygon(id, kRoof)) +
           "</gml:CompositeSurface></gml:exterior></gml:Solid></gml:solidMember>";
  };
  for (const auto& [name, type] : {std::pair{"CompositeSolid", GeometryType::CompositeSolid},
                                   {"MultiSolid", GeometryType::MultiSolid}}) {
    const std::string tag = std::string("gml:") + name;
    const Building house =
        read_one(building("b", "<bldg:lod2Solid><" + tag + ">" + one("a") + one("c") + "</" + tag +
                                   "></bldg:lod2Solid>"));
    EXPECT_EQ(house.geometries.at(0).type, type);
    EXPECT_THAT(house.geometries.at(0).solids, SizeIs(2));
  }
}

TEST(CityGml, KeepsOpeningsWithTheirWall) {
  const std::string window =
      "<bldg:opening><bldg:Window gml:id=\"win\"><bldg:lod3MultiSurface><gml:MultiSurface>" +
      member(polygon("pwin", "2 0 2 4 0 2 4 0 4 2 0 4 2 0 2")) +
      "</gml:MultiSurface></bldg:lod3MultiSurface></bldg:Window></bldg:opening>";
  const Building house = read_one(
      building("b",
               "<bldg:boundedBy><bldg:WallSurface gml:id=\"w\"><bldg:lod3MultiSurface>"
               "<gml:MultiSurface>" +
                   member(polygon("pw", kWall)) + "</gml:MultiSurface></bldg:lod3MultiSurface>" +
                   window + "</bldg:WallSurface></bldg:boundedBy>"));
  ASSERT_THAT(house.surfaces, SizeIs(2));
  EXPECT_EQ(house.surfaces[1].type, SurfaceType::Window);
  EXPECT_EQ(house.surfaces[1].parent, 0);
  EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(2));
  EXPECT_EQ(house.geometries[0].lod, (Lod{3, -1}));
}

TEST(CityGml, NestsPartsAndMarksFootprints) {
  const Building house = read_one(
      building("b", "<bldg:lod0FootPrint><gml:MultiSurface>" + member(polygon("f", kGround)) +
                        "</gml:MultiSurface></bldg:lod0FootPrint>"
                        "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"p1\">" +
                        multi_surface(member(polygon("x", kRoof))) +
                        "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"
                        "<bldg:consistsOfBuildingPart><bldg:BuildingPart>" +
                        multi_surface(member(polygon("y", kRoof))) +
                        "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"));
  EXPECT_TRUE(house.geometries.at(0).footprint);
  ASSERT_THAT(house.parts, SizeIs(2));
  EXPECT_EQ(house.parts[0].gml_id, "p1");
  EXPECT_EQ(house.parts[0].parent, "b");
  EXPECT_EQ(house.parts[1].gml_id, "b_2") << "a missing id is made";
}

TEST(CityGml, KeepsAttributes) {
  const Building house = read_one(building(
      "b",
      "<gml:name>Town hall</gml:name><bldg:function>1000</bldg:function>"
      "<bldg:function>1010</bldg:function><bldg:roofType> 3100 </bldg:roofType>"
      "<bldg:yearOfConstruction>1965</bldg:yearOfConstruction>"
      "<bldg:measuredHeight uom=\"m\">12.50</bldg:measuredHeight>"
      "<bldg:storeysAboveGround>3</bldg:storeysAboveGround>"
      "<gen:stringAttribute name=\"owner\"><gen:value>A &amp; B</gen:value></gen:stringAttribute>"
      "<gen:intAttribute name=\"n\"><gen:value>7</gen:value></gen:intAttribute>"
      "<gen:doubleAttribute name=\"x\"><gen:value>0.5</gen:value></gen:doubleAttribute>"
      "<gen:measureAttribute name=\"h\"><gen:value uom=\"m\">2</gen:value></gen:measureAttribute>"
      "<gen:genericAttributeSet name=\"set\"><gen:stringAttribute name=\"inner\"><gen:value>v"
      "</gen:value></gen:stringAttribute></gen:genericAttributeSet>" +
          multi_surface(member(polygon("x", kRoof)))));
  EXPECT_THAT(house.attributes,
              ElementsAre(std::pair("name", AttributeValue("Town hall")),
                          std::pair("function", AttributeValue("1000;1010")),
                          std::pair("roofType", AttributeValue("3100")),
                          std::pair("yearOfConstruction", AttributeValue(std::int64_t{1965})),
                          std::pair("measuredHeight", AttributeValue(12.5)),
                          std::pair("storeysAboveGround", AttributeValue(std::int64_t{3})),
                          std::pair("owner", AttributeValue("A & B")),
                          std::pair("n", AttributeValue(std::int64_t{7})),
                          std::pair("x", AttributeValue(0.5)), std::pair("h", AttributeValue(2.0)),
                          std::pair("set.inner", AttributeValue("v"))));
}

TEST(CityGml, SkipsAndCountsWhatDoesNotBelongToTheShell) {
  const std::string inside = "<bldg:lod4MultiSurface><gml:MultiSurface>" +
                             member(polygon("in", kRoof)) +
                             "</gml:MultiSurface></bldg:lod4MultiSurface>";
  const Building house = read_one(
      "<app:appearanceMember><app:Appearance><app:theme>x</app:theme></app:Appearance>"
      "</app:appearanceMember>" +
      building("b",
               "<app:appearance><app:Appearance/></app:appearance>"
               "<bldg:outerBuildingInstallation><bldg:BuildingInstallation>" +
                   inside +
                   "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>"
                   "<bldg:interiorRoom><bldg:Room>" +
                   inside +
                   "</bldg:Room></bldg:interiorRoom>"
                   "<ade:energy><ade:demand>3</ade:demand></ade:energy><ade:extra/>" +
                   multi_surface(member(polygon("x", kRoof)))));
  EXPECT_THAT(house.installations, SizeIs(1));
  EXPECT_THAT(house.skipped_ade_elements,
              ElementsAre(std::pair("energy", 1u), std::pair("extra", 1u)));
  ASSERT_THAT(house.geometries, SizeIs(1));
  EXPECT_THAT(house.geometries[0].polygons, SizeIs(1));
  EXPECT_THAT(house.attributes, IsEmpty());
}

TEST(CityGml, ASolidMayReferToSurfacesOfAnInstallation) {
  const Building house = read_one(building(
      "b", "<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3Geometry>" +
               polygon("dormer", kRoof) +
               "</bldg:lod3Geometry></bldg:BuildingInstallation></bldg:outerBuildingInstallation>" +
               solid(member(polygon("g", kGround)) + member_by("#dormer"))));
  EXPECT_THAT(house.source_issues, IsEmpty());
  EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(2));
}

TEST(CityGml, CrsAndDimensionAreInheritedFromTheNearest) {
  const std::string two_d =
      building("flat",
               "<bldg:lod0FootPrint><gml:MultiSurface srsName=\"EPSG:25832\" "
               "srsDimension=\"2\">" +
                   member(polygon("f",
                                  "500000 5700000 500010 5700000 500010 5700010 "
                                  "500000 5700000")) +
                   "</gml:MultiSurface></bldg:lod0FootPrint>");
  const Reading reading = read_text(
      "a.gml",
      city_model(envelope("urn:ogc:def:crs:EPSG::25832", "500000 5700000 0", "500100 5700100 10") +
                 two_d + simple_building("b", 500020, 5700020, 3)));
  ASSERT_THAT(reading.buildings, SizeIs(2));
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25832");
  EXPECT_EQ(reading.selection.origin, (Point3{500000, 5700000, 0}));
  EXPECT_EQ(extent(reading.buildings[0]).max, (Point3{10, 10, 0}));
  EXPECT_EQ(extent(reading.buildings[1]).min, (Point3{20, 20, 3}));
}

TEST(CityGml, ReadsVersion1AndPrefixesOfAnyName) {
  std::string text = city_model(simple_building("b", 0, 0), "1.0");
  const Reading reading = read_text("a.gml", text);
  EXPECT_EQ(reading.input().format, "CityGML 1.0");
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
  for (std::size_t at; (at = text.find("bldg:")) != std::string::npos;) text.replace(at, 5, "q:");
  text.replace(text.find("xmlns:bldg"), 10, "xmlns:q");
  EXPECT_THAT(read_text("a.gml", text).ids(), ElementsAre("b"));
}

TEST(CityGml, ReadsVersion3) {
  const Building house = read_one(
      building("b",
               "<boundary><con:GroundSurface gml:id=\"g\"><lod2MultiSurface><gml:MultiSurface>" +
                   member(polygon("p", kGround)) +
                   "</gml:MultiSurface></lod2MultiSurface><con:fillingSurface><con:DoorSurface "
                   "gml:id=\"d\"/></con:fillingSurface></con:GroundSurface></boundary>"
                   "<con:height><con:Height><con:value uom=\"m\">9.5</con:value></con:Height>"
                   "</con:height><lod2Solid><gml:Solid><gml:exterior><gml:Shell>" +
                   member_by("#p") + member(polygon("r", kRoof)) +
                   "</gml:Shell></gml:exterior></gml:Solid></lod2Solid>"),
      "3.0");
  ASSERT_THAT(house.geometries, SizeIs(2));
  EXPECT_THAT(house.geometries[0].solids.at(0).exterior, SizeIs(2));
  EXPECT_EQ(house.geometries[0].polygons[0].surface, 0);
  EXPECT_EQ(house.surfaces.at(1).type, SurfaceType::Door);
  EXPECT_EQ(number_attribute(house.attributes, "measuredHeight"), 9.5);
}

TEST(CityGml, TakesMembersOfAWfsAnswer) {
  std::string text = city_model(simple_building("b", 0, 0));
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  replace("<CityModel", "<wfs:FeatureCollection xmlns:wfs=\"http://www.opengis.net/wfs/2.0\"");
  replace("</CityModel", "</wfs:FeatureCollection");
  replace("cityObjectMember", "wfs:member");
  const Reading reading = read_text("a.gml", text);
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
}

TEST(CityGml, ReadsGzipAndNamesBuildingsWithoutIdByFileAndOrdinal) {
  const Reading reading = read_text(
      "tile_7.gml.gz", city_model(simple_building("a", 0, 0) + simple_building("", 50, 0)));
  EXPECT_THAT(reading.ids(), ElementsAre("a", "tile_7_2"));
  EXPECT_EQ(reading.input().file, "tile_7.gml.gz");
}

TEST(CityGml, DeliversRepeatedIdsInOrder) {
  const Reading reading =
      read_text("a.gml", city_model(simple_building("x", 0, 0) + simple_building("y", 50, 0) +
                                    simple_building("x", 100, 0)));
  EXPECT_THAT(reading.ids(), ElementsAre("x", "y", "x"));
  EXPECT_THAT(reading.selection.object_ids, ElementsAre("x", "y", "x"));
}

TEST(CityGml, ABuildingWithoutGeometryIsDeliveredEmpty) {
  const Building house = read_one(building("b", "<bldg:function>1000</bldg:function>"));
  EXPECT_THAT(house.geometries, IsEmpty());
  EXPECT_THAT(house.attributes, Not(IsEmpty()));
}

}  // namespace
}  // namespace citymesh
