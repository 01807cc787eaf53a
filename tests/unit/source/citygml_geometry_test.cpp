#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kTriangle = "0 0 0 4 0 0 4 3 1 0 0 0";

Building read_one(const std::string& content, const std::string& version = "2.0") {
  const Reading reading = read_text("a.gml", city_model(content, version));
  EXPECT_FALSE(reading.error);
  EXPECT_THAT(reading.buildings, SizeIs(1));
  return reading.buildings.empty() ? Building{} : reading.buildings.front();
}

std::vector<Point3> corners(const Geometry& geometry, std::size_t polygon) {
  std::vector<Point3> points;
  for (const auto index : geometry.polygons.at(polygon).rings.at(0))
    points.push_back(geometry.points.at(index));
  return points;
}

std::string implicit(const std::string& matrix, const std::string& geometry,
                     const std::string& point, const std::string& srs = "") {
  return "<bldg:lod3ImplicitRepresentation><ImplicitGeometry><mimeType>x</mimeType>"
         "<transformationMatrix>" +
         matrix + "</transformationMatrix>" + geometry + "<referencePoint><gml:Point" +
         (srs.empty() ? "" : " srsName=\"" + srs + "\"") + "><gml:pos>" + point +
         "</gml:pos></gml:Point></referencePoint></ImplicitGeometry>"
         "</bldg:lod3ImplicitRepresentation>";
}

std::string installation(const std::string& id, const std::string& content) {
  return "<bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id=\"" + id + "\">" +
         content + "</bldg:BuildingInstallation></bldg:outerBuildingInstallation>";
}

const std::string kRelative = "<relativeGMLGeometry><gml:MultiSurface gml:id=\"template\">" +
                              member(polygon("t", kTriangle)) +
                              "</gml:MultiSurface></relativeGMLGeometry>";

TEST(ImplicitGeometry, IsPutByMatrixAndReferencePointAndSharedByHref) {
  const Building house = read_one(building(
      "b",
      installation("i1", implicit("0 -1 0 0.5 1 0 0 0 0 0 2 0 0 0 0 1", kRelative, "100 200 10")) +
          installation("i2",
                       implicit("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                "<relativeGMLGeometry xlink:href=\"#template\"/>", "300 400 20")) +
          multi_surface(member(polygon("own", square(0, 0))))));
  ASSERT_THAT(house.installations, SizeIs(2));
  EXPECT_THAT(house.installations[0].source_issues, IsEmpty());
  const Geometry& turned = house.installations[0].geometries.at(0);
  EXPECT_EQ(turned.lod, (Lod{3, -1}));
  EXPECT_THAT(corners(turned, 0), ElementsAre(Point3{100.5, 200, 10}, Point3{100.5, 204, 10},
                                              Point3{97.5, 204, 12}, Point3{100.5, 200, 10}));
  EXPECT_THAT(corners(house.installations[1].geometries.at(0), 0),
              ElementsAre(Point3{300, 400, 20}, Point3{304, 400, 20}, Point3{304, 403, 21},
                          Point3{300, 400, 20}));
}

TEST(ImplicitGeometry, IsSharedBetweenBuildings) {
  const std::string unit = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
  const std::string owner = building("owner", implicit(unit, kRelative, "10 10 0"));
  const std::string user = building(
      "user", implicit(unit, "<relativeGMLGeometry xlink:href=\"#template\"/>", "50 10 0"));
  for (const std::string& text : {owner + user, user + owner}) {
    const Reading reading = read_text("a.gml", city_model(text));
    ASSERT_THAT(reading.buildings, SizeIs(2));
    for (const Building& one : reading.buildings) {
      EXPECT_THAT(one.source_issues, IsEmpty());
      ASSERT_THAT(one.geometries, SizeIs(1));
      EXPECT_EQ(extent(one).min.x, one.gml_id == "owner" ? 0 : 40);
    }
  }
}

TEST(ImplicitGeometry, MirroredOnesStillLookOutwards) {
  const Building house =
      read_one(building("b", implicit("-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", kRelative, "0 0 0")));
  const auto points = corners(house.geometries.at(0), 0);
  ASSERT_THAT(points, SizeIs(4));
  EXPECT_EQ(points[1].y - points[0].y, 3) << "the ring runs the other way";
}

TEST(ImplicitGeometry, InDegreesMeasuresMetresFromTheReferencePoint) {
  const Building house = read_one(building(
      "b", implicit("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", kRelative, "35.68 139.75 5", "EPSG:6697")));
  const Box3 box = extent(house);
  EXPECT_NEAR(box.max.x - box.min.x, 4, 0.1);
  EXPECT_NEAR(box.max.y - box.min.y, 3, 0.1);
  EXPECT_EQ(box.max.z - box.min.z, 1);
}

TEST(ImplicitGeometry, WithoutWhatItNeedsIsAnIssue) {
  const std::string unit = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
  for (const std::string& bad : {implicit("1 2 3", kRelative, "0 0 0"),
                                 implicit("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0", kRelative, "0 0 0"),
                                 implicit(unit, "", "0 0 0"), implicit(unit, kRelative, "0 zero"),
                                 implicit(unit + " nan", kRelative, "0 0 0")}) {
    const Building house = read_one(building("b", bad));
    EXPECT_THAT(house, HasIssue(issue_code::kUnreadableGeometry)) << bad;
    EXPECT_THAT(house.geometries, IsEmpty());
  }
}

TEST(References, BoundarySurfacesByHrefAreFollowedWithinAndBetweenBuildings) {
  const std::string wall = surface("WallSurface", "wall",
                                   multi_surface(member(polygon("pw", square(0, 0)))) +
                                       "<bldg:opening><bldg:Door gml:id=\"door\">" +
                                       multi_surface(member(polygon("pd", square(2, 2, 0, 1)))) +
                                       "</bldg:Door></bldg:opening>");
  const std::string owner = building("owner", wall);
  const std::string user = building(
      "user", surface("RoofSurface", "r", multi_surface(member(polygon("pr", square(0, 0, 9))))) +
                  "<bldg:boundedBy xlink:href=\"#wall\"/>");
  for (const std::string& text : {owner + user, user + owner}) {
    const Reading reading = read_text("a.gml", city_model(text));
    ASSERT_THAT(reading.buildings, SizeIs(2));
    for (const Building& one : reading.buildings) {
      if (one.gml_id != "user") continue;
      EXPECT_THAT(one.source_issues, IsEmpty());
      ASSERT_THAT(one.surfaces, SizeIs(3));
      EXPECT_EQ(one.surfaces[1].type, SurfaceType::WallSurface);
      EXPECT_EQ(one.surfaces[1].gml_id, "wall");
      EXPECT_EQ(one.surfaces[2].type, SurfaceType::Door);
      EXPECT_EQ(one.surfaces[2].parent, 1);
      ASSERT_THAT(one.geometries, SizeIs(1));
      ASSERT_THAT(one.geometries[0].polygons, SizeIs(3));
      EXPECT_EQ(one.geometries[0].polygons[1].surface, 1);
      EXPECT_EQ(one.geometries[0].polygons[2].surface, 2);
    }
  }
  EXPECT_THAT(read_one(building("b", "<bldg:boundedBy xlink:href=\"#nowhere\"/>")),
              HasIssue(issue_code::kDanglingXlink));
}

TEST(References, OverTwoFeaturesAreFollowedInAnyOrder) {
  const std::string a =
      building("a", solid(member_by("#list") + member(polygon("own", kTriangle))));
  const std::string b = building("b", "<bldg:lod2MultiSurface><gml:MultiSurface>" +
                                          member("<gml:CompositeSurface gml:id=\"list\">" +
                                                 member_by("#far") + "</gml:CompositeSurface>") +
                                          "</gml:MultiSurface></bldg:lod2MultiSurface>");
  const std::string c = building("c", multi_surface(member(polygon("far", square(0, 0)))));
  for (const std::string& text : {a + b + c, c + b + a, b + a + c}) {
    const Reading reading = read_text("a.gml", city_model(text));
    ASSERT_THAT(reading.buildings, SizeIs(3));
    for (const Building& one : reading.buildings) {
      EXPECT_THAT(one.source_issues, IsEmpty()) << one.gml_id;
      ASSERT_THAT(one.geometries, SizeIs(1)) << one.gml_id;
      EXPECT_THAT(one.geometries[0].polygons, SizeIs(one.gml_id == "a" ? 2 : 1));
    }
  }
}

TEST(References, BorrowedSolidsKeepTheirShells) {
  const std::string shell = [](const std::string& id) {
    return "<gml:CompositeSurface>" + member(polygon(id, kTriangle)) + "</gml:CompositeSurface>";
  }("outer");
  const std::string inner =
      "<gml:CompositeSurface>" + member(polygon("cavity", kTriangle)) + "</gml:CompositeSurface>";
  const std::string owner =
      building("owner", "<bldg:lod2Solid><gml:Solid gml:id=\"s\"><gml:exterior>" + shell +
                            "</gml:exterior><gml:interior>" + inner +
                            "</gml:interior></gml:Solid></bldg:lod2Solid>");
  const std::string user = building("user", "<bldg:lod2Solid xlink:href=\"#s\"/>");
  const Reading reading = read_text("a.gml", city_model(user + owner));
  ASSERT_THAT(reading.buildings, SizeIs(2));
  const Geometry& borrowed = reading.buildings[0].geometries.at(0);
  EXPECT_EQ(borrowed.type, GeometryType::Solid);
  ASSERT_THAT(borrowed.solids, SizeIs(1));
  EXPECT_THAT(borrowed.solids[0].exterior, ElementsAre(0u));
  EXPECT_THAT(borrowed.solids[0].interiors, ElementsAre(ElementsAre(1u)));
}

TEST(References, CyclesBetweenBuildingsAreReported) {
  const auto list = [](const std::string& id, const std::string& other) {
    return building(id, "<bldg:lod2MultiSurface><gml:MultiSurface gml:id=\"" + id + "_m\">" +
                            member_by("#" + other + "_m") +
                            "</gml:MultiSurface></bldg:lod2MultiSurface>");
  };
  const Reading reading = read_text("a.gml", city_model(list("a", "b") + list("b", "a")));
  ASSERT_THAT(reading.buildings, SizeIs(2));
  for (const Building& one : reading.buildings)
    EXPECT_THAT(one, HasIssue(issue_code::kCyclicXlink)) << one.gml_id;
}

TEST(Openings, OfVersion3CloseTheirWallAndVolumesStayOutOfTheShell) {
  const auto lod3 = [](const std::string& members) {
    return "<lod3MultiSurface><gml:MultiSurface>" + members +
           "</gml:MultiSurface></lod3MultiSurface>";
  };
  const Building house = read_one(
      building("b", "<boundary><con:WallSurface gml:id=\"w\">" +
                        lod3(member(polygon("pw", square(0, 0)))) +
                        "<con:fillingSurface><con:WindowSurface gml:id=\"ws\">" +
                        lod3(member(polygon("ps", square(2, 2, 0, 1)))) +
                        "</con:WindowSurface></con:fillingSurface><con:filling><con:Window "
                        "gml:id=\"win\"><lod3Solid><gml:Solid><gml:exterior><gml:Shell>" +
                        member(polygon("pv", square(2, 2, 1, 1))) +
                        "</gml:Shell></gml:exterior></gml:Solid></lod3Solid></con:Window>"
                        "</con:filling></con:WallSurface></boundary>"),
      "3.0");
  ASSERT_THAT(house.surfaces, SizeIs(3));
  EXPECT_EQ(house.surfaces[1].type, SurfaceType::Window);
  EXPECT_EQ(house.surfaces[1].parent, 0);
  EXPECT_EQ(house.surfaces[2].gml_id, "win");
  ASSERT_THAT(house.geometries, SizeIs(1));
  EXPECT_THAT(house.geometries[0].polygons, SizeIs(2)) << "wall and window surface";
}

TEST(Levels, ZeroAndFourAreRead) {
  const auto level = [](const std::string& property) {
    return "<bldg:" + property + "><gml:MultiSurface>" + member(polygon(property, kTriangle)) +
           "</gml:MultiSurface></bldg:" + property + ">";
  };
  const Building house = read_one(
      building("b", level("lod0FootPrint") + level("lod0RoofEdge") + level("lod4MultiSurface") +
                        surface("ClosureSurface", "c", level("lod4MultiSurface"))));
  ASSERT_THAT(house.geometries, SizeIs(4));
  EXPECT_TRUE(house.geometries[0].footprint);
  EXPECT_TRUE(house.geometries[1].footprint);
  EXPECT_EQ(house.geometries[2].lod, (Lod{4, -1}));
  EXPECT_EQ(house.surfaces[0].type, SurfaceType::ClosureSurface);

  const Building three = read_one(
      building("b", "<lod0MultiSurface><gml:MultiSurface>" + member(polygon("p", kTriangle)) +
                        "</gml:MultiSurface></lod0MultiSurface>"),
      "3.0");
  EXPECT_TRUE(three.geometries.at(0).footprint);
}

TEST(Geometries, EveryListOfSurfacesOrSolidsIsRead) {
  const auto in = [](const std::string& open, const std::string& content) {
    return "<gml:" + open + ">" + content + "</gml:" + open + ">";
  };
  const std::string triangle =
      "<gml:Triangle><gml:exterior>" + ring(kTriangle) + "</gml:exterior></gml:Triangle>";
  const std::string patch =
      "<gml:PolygonPatch><gml:exterior>" + ring(kTriangle) + "</gml:exterior></gml:PolygonPatch>";
  const std::string solid_of =
      in("Solid", in("exterior", in("Shell", member(polygon("", kTriangle)))));
  struct Case {
    std::string xml;
    GeometryType type;
    std::size_t polygons, solids;
  };
  for (const auto& [xml, type, polygons, solids] :
       {Case{in("TriangulatedSurface", in("patches", triangle + triangle)),
             GeometryType::CompositeSurface, 2, 0},
        Case{in("Tin", in("trianglePatches", triangle)), GeometryType::CompositeSurface, 1, 0},
        Case{in("PolyhedralSurface", in("polygonPatches", patch + patch)),
             GeometryType::CompositeSurface, 2, 0},
        Case{in("Surface", in("patches", patch)), GeometryType::CompositeSurface, 1, 0},
        Case{in("MultiGeometry",
                in("geometryMember", in("MultiSurface", member(polygon("", kTriangle))))),
             GeometryType::MultiSurface, 1, 0},
        Case{in("MultiGeometry", in("geometryMember", solid_of)), GeometryType::MultiSolid, 1, 1},
        Case{in("GeometricComplex", in("element", solid_of) + in("element", solid_of)),
             GeometryType::MultiSolid, 2, 2},
        Case{in("CompositeSolid", in("solidMember", solid_of) + in("solidMember", solid_of)),
             GeometryType::CompositeSolid, 2, 2},
        Case{in("MultiSolid", in("solidMembers", solid_of + solid_of)), GeometryType::MultiSolid, 2,
             2}}) {
    const Building house =
        read_one(building("b", "<bldg:lod2Geometry>" + xml + "</bldg:lod2Geometry>"));
    ASSERT_THAT(house.geometries, SizeIs(1)) << xml;
    EXPECT_EQ(house.geometries[0].type, type) << xml;
    EXPECT_THAT(house.geometries[0].polygons, SizeIs(polygons)) << xml;
    EXPECT_THAT(house.geometries[0].solids, SizeIs(solids)) << xml;
  }
}

TEST(Coordinates, SeparatorsCountsAndDimensionsAreFollowed) {
  const auto with_ring = [](const std::string& content, const std::string& property) {
    return building("b", "<bldg:" + property +
                             "><gml:MultiSurface><gml:surfaceMember><gml:Polygon><gml:exterior>"
                             "<gml:LinearRing>" +
                             content +
                             "</gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>"
                             "</gml:MultiSurface></bldg:" +
                             property + ">");
  };
  const std::vector<Point3> three{{0, 0, 0}, {4.5, 0, 0}, {4.5, 3, 1}, {0, 0, 0}};
  for (const std::string& content :
       {std::string("<gml:coordinates decimal=\",\" cs=\":\" ts=\";\">0:0:0;4,5:0:0;4,5:3:1;0:0:0"
                    "</gml:coordinates>"),
        std::string("<gml:coordinates>0,0,0\n4.5,0,0\n4.5,3,1\n0,0,0</gml:coordinates>"),
        std::string("<gml:posList count=\"4\" srsDimension=\"2\">0 0 0 4.5 0 0 4.5 3 1 0 0 0"
                    "</gml:posList>")})
    EXPECT_EQ(corners(read_one(with_ring(content, "lod2MultiSurface")).geometries.at(0), 0), three)
        << content;

  const std::vector<Point3> two{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 0, 0}};
  for (const std::string& content :
       {std::string("<gml:coordinates>0,0 4,0 4,3 0,0</gml:coordinates>"),
        std::string("<gml:posList count=\"4\">0 0 4 0 4 3 0 0</gml:posList>"),
        std::string("<gml:posList>0 0 4 0 4 3 0 0</gml:posList>"),
        std::string("<gml:pos>0 0</gml:pos><gml:pos>4 0</gml:pos><gml:pos>4 3</gml:pos>"
                    "<gml:pos>0 0</gml:pos>")})
    EXPECT_EQ(corners(read_one(with_ring(content, "lod0FootPrint")).geometries.at(0), 0), two)
        << content;
}

}  // namespace
}  // namespace citymesh
