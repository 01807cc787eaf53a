#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kVertices =
    "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,500],[1000,0,500]]";
const std::string kTransform =
    R"("transform":{"scale":[0.01,0.01,0.01],"translate":[400000,5000000,30]})";

std::string object(const std::string& type, const std::string& geometry,
                   const std::string& more = "") {
  return "{\"type\":\"" + type + "\"" + more + ",\"geometry\":[" + geometry + "]}";
}

std::string surfaces(const std::string& boundaries = "[[[0,1,2,3]],[[0,1,5,4]]]") {
  return R"({"type":"MultiSurface","lod":"2.2","boundaries":)" + boundaries + "}";
}

const std::string kGood = "\"good\":" + object("Building", surfaces());
const std::string kLast = "\"last\":" + object("Building", surfaces());

std::string city_json(const std::string& objects, const std::string& version = "2.0",
                      const std::string& vertices = kVertices,
                      const std::string& transform = kTransform) {
  return "{\"type\":\"CityJSON\",\"version\":\"" + version + "\"," +
         (transform.empty() ? "" : transform + ",") + "\"CityObjects\":{" + objects +
         "},\n\"vertices\":" + vertices + "}";
}

Building between_good_ones(const std::string& bad, const std::string& vertices = kVertices) {
  const Reading reading =
      read_text("a.json", city_json(kGood + ",\"bad\":" + bad + "," + kLast, "2.0", vertices));
  EXPECT_FALSE(reading.error);
  EXPECT_THAT(reading.ids(), ElementsAre("good", "bad", "last"));
  for (const std::size_t i : {0u, 2u}) {
    if (i < reading.buildings.size()) {
      EXPECT_THAT(reading.buildings[i].geometries, SizeIs(1));
    }
  }
  return reading.buildings.size() > 1 ? reading.buildings[1] : Building{};
}

TEST(CityJson, ReadsASolidWithSemanticsAndTransform) {
  const std::string geometry =
      R"({"type":"Solid","lod":2,"boundaries":[[[[0,1,2,3]],[[0,1,5,4]]],[[[0,1,2]]]],)"
      R"("semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"WallSurface","id":"w"},)"
      R"({"type":"Window","parent":1}],"values":[[0,2],[null]]}})";
  const Reading reading = read_text("a.json", city_json("\"b\":" + object("Building", geometry)));
  EXPECT_EQ(reading.input().format, "CityJSON 2.0");
  ASSERT_THAT(reading.buildings, SizeIs(1));
  const Building& house = reading.buildings[0];
  ASSERT_THAT(house.geometries, SizeIs(1));
  const Geometry& geometry_read = house.geometries[0];
  EXPECT_EQ(geometry_read.type, GeometryType::Solid);
  EXPECT_EQ(geometry_read.lod, (Lod{2, -1}));
  EXPECT_THAT(geometry_read.solids.at(0).exterior, ElementsAre(0u, 1u));
  EXPECT_THAT(geometry_read.solids.at(0).interiors.at(0), ElementsAre(2u));
  EXPECT_THAT(geometry_read.polygons.at(0).rings.at(0), SizeIs(4)) << "not closed, as it came";
  EXPECT_EQ(geometry_read.polygons[0].surface, 0);
  EXPECT_EQ(geometry_read.polygons[1].surface, 2);
  EXPECT_EQ(geometry_read.polygons[2].surface, -1);
  EXPECT_EQ(house.surfaces.at(1).gml_id, "w");
  EXPECT_EQ(house.surfaces.at(2).parent, 1);
  EXPECT_EQ(reading.selection.origin, (Point3{400000, 5000000, 30}));
  EXPECT_EQ(extent(house).max, (Point3{10, 10, 5}));
}

TEST(CityJson, ReadsMultiAndCompositeSolidsAndSurfaces) {
  const auto type_of = [](const std::string& type, const std::string& boundaries) {
    const Reading reading = read_text(
        "a.json", city_json("\"b\":" + object("Building", "{\"type\":\"" + type +
                                                              "\",\"lod\":\"1\",\"boundaries\":" +
                                                              boundaries + "}")));
    return reading.buildings.at(0).geometries.at(0);
  };
  const std::string shells = "[[[[0,1,2]],[[0,2,3]]]]";
  EXPECT_THAT(type_of("MultiSolid", "[" + shells + "," + shells + "]").solids, SizeIs(2));
  EXPECT_EQ(type_of("CompositeSolid", "[" + shells + "]").type, GeometryType::CompositeSolid);
  EXPECT_EQ(type_of("CompositeSurface", "[[[0,1,2]]]").type, GeometryType::CompositeSurface);
}

TEST(CityJson, NestsPartsFromEitherDirectionAndCountsInstallations) {
  const std::string part = object("BuildingPart", surfaces(), R"(,"parents":["b"])");
  const Reading reading = read_text(
      "a.json",
      city_json("\"p1\":" + part + ",\"b\":" + object("Building", "", R"(,"children":["p2","i"])") +
                ",\"p2\":" + object("BuildingPart", surfaces()) +
                ",\"i\":" + object("BuildingInstallation", surfaces(), R"(,"parents":["b"])") +
                ",\"room\":" + object("BuildingRoom", surfaces(), R"(,"parents":["b"])") +
                ",\"orphan\":" + object("BuildingPart", surfaces(), R"(,"parents":["nobody"])")));
  EXPECT_THAT(reading.ids(), ElementsAre("b", "orphan"));
  const Building& house = reading.buildings.at(0);
  ASSERT_THAT(house.parts, SizeIs(2));
  EXPECT_EQ(house.parts[0].gml_id, "p2");
  EXPECT_EQ(house.parts[1].gml_id, "p1");
  EXPECT_EQ(house.parts[1].parent, "b");
  EXPECT_THAT(house.installations, SizeIs(1));
}

TEST(CityJson, PartsThatContainEachOtherAreDeliveredOnce) {
  const Reading reading = read_text(
      "a.json", city_json("\"p\":" + object("BuildingPart", surfaces(), R"(,"children":["q"])") +
                          ",\"q\":" + object("BuildingPart", surfaces(), R"(,"children":["p"])")));
  ASSERT_THAT(reading.ids(), ElementsAre("p"));
  EXPECT_THAT(reading.buildings[0].parts, SizeIs(1));
}

TEST(CityJson, KeepsAttributesAndSkipsOtherObjects) {
  const Reading reading = read_text(
      "a.json",
      city_json("\"road\":" + object("Road", surfaces()) +
                ",\"x\":" + object("+NoiseBuilding", surfaces()) + ",\"b\":" +
                object("Building", surfaces(),
                       R"(,"attributes":{"measuredHeight":12.5,"storeysAboveGround":3,"flat":true,)"
                       R"("name":"a \"b\"","none":null,"list":[1, 2]})")));
  ASSERT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.buildings[0].attributes,
              ElementsAre(std::pair("measuredHeight", AttributeValue(12.5)),
                          std::pair("storeysAboveGround", AttributeValue(std::int64_t{3})),
                          std::pair("flat", AttributeValue(true)),
                          std::pair("name", AttributeValue("a \"b\"")),
                          std::pair("list", AttributeValue("[1,2]"))));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("1 objects of extension types")));
}

TEST(CityJson, ReadsVersion10WithoutTransformWithNumericLodAndByteOrderMark) {
  const std::string geometry = R"({"type":"MultiSurface","lod":2.0,"boundaries":[[[0,1,2]]]})";
  const Reading reading =
      read_text("a.json", "\xef\xbb\xbf" + city_json("\"b\":" + object("Building", geometry), "1.0",
                                                     "[[0.5,0,0],[1,0,0],[1,1e0,0]]", ""));
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_EQ(reading.input().format, "CityJSON 1.0");
  EXPECT_EQ(reading.buildings.at(0).geometries.at(0).lod, (Lod{2, 0}));
  EXPECT_EQ(reading.buildings[0].geometries[0].points.at(0), (Point3{0.5, 0, 0}));
}

TEST(CityJson, ReadsASequenceLineByLineEvenPacked) {
  const std::string text =
      R"({"type":"CityJSON","version":"1.1",)" + kTransform +
      R"(,"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25833"},)"
      R"("CityObjects":{},"vertices":[]})"
      "\n" +
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":)" + object("Building", surfaces()) +
      "},\"vertices\":" + kVertices + "}\n\n" +
      R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":)" +
      object("Building", "", R"(,"children":["c"])") +
      ",\"c\":" + object("BuildingPart", surfaces(), R"(,"parents":["b"])") +
      "},\"vertices\":" + kVertices + "}";
  for (const auto* name : {"a.jsonl", "a.jsonl.gz"}) {
    const Reading reading = read_text(name, text);
    EXPECT_EQ(reading.input().format, "CityJSONSeq 1.1");
    EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
    ASSERT_THAT(reading.ids(), ElementsAre("a", "b"));
    EXPECT_THAT(reading.buildings[1].parts, SizeIs(1));
  }
}

TEST(CityJson, ReadsAPackedDocument) {
  EXPECT_THAT(read_text("a.city.json.gz", city_json(kGood)).ids(), ElementsAre("good"));
}

TEST(BadJson, ASequenceGoesOnAfterABrokenLine) {
  const std::string feature = R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":)" +
                              object("Building", surfaces()) + "},\"vertices\":" + kVertices + "}";
  const Reading reading =
      read_text("a.jsonl", R"({"type":"CityJSON","version":"2.0",)" + kTransform +
                               R"(,"CityObjects":{},"vertices":[]})"
                               "\n{\"type\":[\n" +
                               feature + "\n{\"type\":\"Feature\"}\n" + feature + "\n");
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("line 2"));
  EXPECT_THAT(reading.ids(), ElementsAre("a", "a"));
}

TEST(BadJson, ATextThatEndsEarlyNamesTheLine) {
  std::string text = city_json(kGood);
  text.resize(text.size() - 5);
  const Reading reading = read_text("a.json", text);
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("line 2: the text ends"));
  EXPECT_FALSE(reading.error);
}

TEST(BadJson, WrongHeadersAreNamed) {
  const auto message = [](const std::string& text) {
    const Reading reading = read_text("a.json", text);
    EXPECT_EQ(reading.input().state, "failed") << text;
    EXPECT_THAT(reading.buildings, IsEmpty());
    return reading.input().message;
  };
  EXPECT_THAT(message(city_json(kGood, "2.0", kVertices, "")), HasSubstr("'transform' is missing"));
  EXPECT_THAT(message(city_json(kGood, "2.0", kVertices, R"("transform":{"scale":[1]})")),
              HasSubstr("'scale'"));
  EXPECT_THAT(message(city_json(kGood, "0.9")), HasSubstr("'0.9'"));
  EXPECT_THAT(message(R"({"type":"FeatureCollection"})"), HasSubstr("FeatureCollection"));
  EXPECT_THAT(message("{}"), HasSubstr("'type'"));
  EXPECT_THAT(message(city_json(kGood, "2.0", "[[0,0]]")), HasSubstr("vertex 0"));
  EXPECT_THAT(message(city_json(kGood, "2.0", "[[0,0,null]]")), HasSubstr("vertex 0"));
  EXPECT_THAT(message(city_json(kGood, "2.0", "[[0,0,nan]]")), HasSubstr("vertex 0"));
  EXPECT_THAT(message(city_json(kGood, "2.0", "7")), HasSubstr("list of vertices"));
  EXPECT_THAT(message(R"({"type":"CityJSON","version":"2.0",)" + kTransform + "}"),
              HasSubstr("is missing"));
}

TEST(BadJson, DeepNestingIsRefusedNamingTheLimit) {
  const Reading reading = read_text(
      "a.json", "{\"type\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("max_depth = 256"));
}

TEST(BadJson, AnObjectThatDoesNotParseIsNamedAndOthersGoOn) {
  const Reading reading =
      read_text("a.json", city_json(kGood + ",\"bad\":{\"type\" \"Building\"}," + kLast));
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("'bad'"));
  EXPECT_THAT(reading.ids(), ElementsAre("good", "last"));
}

TEST(BadJson, WrongTypesAreIssuesOfTheirBuilding) {
  for (const std::string& geometry :
       {std::string("7"), std::string("{}"), std::string("null"),
        std::string(R"({"type":"MultiSurface","lod":"2"})"),
        std::string(R"({"type":"MultiSurface","lod":[2],"boundaries":[[[0,1,2]]]})"),
        std::string(R"({"type":"MultiSurface","boundaries":[[[0,1,2]]]})"),
        std::string(R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,"2"]]]})"),
        std::string(R"({"type":"MultiSurface","lod":"2","boundaries":[[0,1,2]]})"),
        std::string(R"({"type":"Solid","lod":"2","boundaries":[[[0,1,2]]]})"),
        std::string(R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1.5,2]]]})"),
        std::string(R"({"type":"GeometryInstance","template":0,"boundaries":[0]})")})
    EXPECT_THAT(between_good_ones(object("Building", geometry)),
                HasIssue(issue_code::kUnreadableGeometry))
        << geometry;
  EXPECT_THAT(between_good_ones(R"({"type":"Building","geometry":{}})"),
              HasIssue(issue_code::kUnreadableGeometry));
}

TEST(BadJson, IndicesOutOfRangeAreIssuesOfTheirPolygon) {
  for (const auto* index : {"6", "-1", "9223372036854775807", "-9223372036854775808"}) {
    const Building bad = between_good_ones(
        object("Building", surfaces("[[[0,1,2]],[[0,1," + std::string(index) + "]]]")));
    EXPECT_THAT(bad, HasIssue(issue_code::kVertexIndexOutOfRange)) << index;
    EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr(index));
    EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(1));
  }
}

TEST(BadJson, EmptyRingsAndGeometries) {
  EXPECT_THAT(between_good_ones(object("Building", surfaces("[[[]],[]]"))),
              HasIssue(issue_code::kUnreadableRing));
  EXPECT_THAT(between_good_ones(object("Building", surfaces("[]"))).geometries, IsEmpty());
  EXPECT_THAT(between_good_ones(R"({"type":"Building"})").geometries, IsEmpty());
}

TEST(BadJson, AbsurdVerticesAreIssuesOfThePolygonsThatUseThem) {
  for (const auto* value : {"1e300", "1e999", "-9223372036854775808"}) {
    const std::string vertices =
        kVertices.substr(0, kVertices.size() - 1) + ",[" + value + ",0,0]]";
    const Building bad =
        between_good_ones(object("Building", surfaces("[[[0,1,2]],[[0,1,6]]]")), vertices);
    EXPECT_THAT(bad, HasIssue(issue_code::kCoordinateOutOfRange)) << value;
    EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(1));
  }
}

TEST(BadJson, SemanticsThatDoNotFitAreIgnored) {
  for (const auto* semantics :
       {R"({"surfaces":[{"type":"RoofSurface"}],"values":[7,-1]})", R"({"surfaces":7})",
        R"({"surfaces":[7],"values":null})", R"({"surfaces":[{"type":3}],"values":[[0]]})", "[]"}) {
    const Building bad = between_good_ones(
        object("Building", R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]],[[0,2,3]]],)"
                           R"("semantics":)" +
                               std::string(semantics) + "}"));
    EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(2)) << semantics;
  }
}

}  // namespace
}  // namespace citymesh
