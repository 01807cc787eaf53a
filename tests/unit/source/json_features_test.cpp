// tu3djson and JSON-FG: every feature is a building with its solids.
#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// ---- tu3djson ----------------------------------------------------------------------------------

const std::string kVertices = R"("vertices":[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1]])";

std::string tu3d(const std::string& features) {
  return R"({"type":"tu3djson","features":[)" + features + "]}";
}

std::string tu3d_feature(const std::string& type, const std::string& boundaries,
                         const std::string& more = "", const std::string& vertices = kVertices) {
  return R"({"type":"Something")" + more + R"(,"geometry":{"type":")" + type +
         R"(","boundaries":)" + boundaries + "," + vertices + "}}";
}

TEST(Tu3dJson, ReadsSolidsWithCavitiesAndProperties) {
  const Reading reading = read_text(
      "a.json", tu3d(tu3d_feature("Solid", "[[[[0,1,2,3]],[[0,1,4]]],[[[0,1,2]]]]",
                                  R"(,"id":"x","properties":{"storeys":3,"name":"old"})") +
                     "," + tu3d_feature("MultiSolid", "[[[[[0,1,2]]]],[[[[0,1,4],[1,2,3]]]]]")));
  EXPECT_EQ(reading.input().format, "tu3djson");
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  ASSERT_THAT(reading.ids(), ElementsAre("x", "a_2"));
  EXPECT_THAT(reading.buildings[0].attributes, SizeIs(2));
  const Geometry& solid = reading.buildings[0].geometries.at(0);
  EXPECT_EQ(solid.type, GeometryType::Solid);
  EXPECT_EQ(solid.lod, (Lod{2, -1}));
  ASSERT_THAT(solid.solids, SizeIs(1));
  EXPECT_THAT(solid.solids[0].exterior, ElementsAre(0, 1));
  EXPECT_THAT(solid.solids[0].interiors, ElementsAre(ElementsAre(2)));
  const Geometry& several = reading.buildings[1].geometries.at(0);
  EXPECT_THAT(several.solids, SizeIs(2));
  EXPECT_THAT(several.polygons.at(1).rings, SizeIs(2));
}

TEST(Tu3dJson, DefectsAreIssuesAndTheOtherFeaturesStay) {
  const std::string good = tu3d_feature("MultiSurface", "[[[0,1,2]]]");
  const auto bad_one = [&](const std::string& bad) {
    const Reading reading = read_text("a.json", tu3d(good + "," + bad + "," + good));
    EXPECT_THAT(reading.ids(), ElementsAre("a_1", "a_2", "a_3")) << bad;
    EXPECT_THAT(reading.buildings.at(2).geometries, SizeIs(1));
    return reading.buildings.at(1);
  };
  EXPECT_THAT(bad_one(tu3d_feature("MultiSurface", "[[[0,1,5]],[[0,1,2]]]")),
              HasIssue(issue_code::kVertexIndexOutOfRange));
  EXPECT_THAT(bad_one(tu3d_feature("MultiSurface", "[[[0,1,-1]]]")),
              HasIssue(issue_code::kVertexIndexOutOfRange));
  EXPECT_THAT(bad_one(tu3d_feature("MultiSurface", "[[[0,1,2]],[[]],[]]")),
              HasIssue(issue_code::kUnreadableRing));
  EXPECT_THAT(bad_one(tu3d_feature("Solid", "[[[0,1,2]]]")),
              HasIssue(issue_code::kUnreadableGeometry));
  EXPECT_THAT(bad_one(tu3d_feature("Sphere", "[]")), HasIssue(issue_code::kUnreadableGeometry));
  EXPECT_THAT(bad_one(tu3d_feature("MultiSurface", "[[[0,1,2]]]", "", R"("vertices":[[0,0]])")),
              HasIssue(issue_code::kUnreadableGeometry));
  EXPECT_THAT(bad_one(tu3d_feature("MultiSurface", "[[[0,1,2]]]", "",
                                   R"("vertices":[[0,0,1e300],[0,0,0],[1,1,1]])")),
              HasIssue(issue_code::kCoordinateOutOfRange));
  EXPECT_THAT(bad_one("{}"), HasIssue(issue_code::kUnreadableGeometry));
}

TEST(Tu3dJson, BrokenDocumentsFail) {
  for (const std::string& text :
       {std::string(R"({"type":"tu3djson"})"), std::string(R"({"type":"tu3djson","features":3})"),
        tu3d(tu3d_feature("MultiSurface", "[[[0,1,2]]]")).substr(0, 90)}) {
    const Reading reading = read_text("a.json", text);
    EXPECT_EQ(reading.input().format, "tu3djson");
    EXPECT_EQ(reading.input().state, "failed") << text;
    EXPECT_THAT(reading.buildings, IsEmpty());
  }
  const Reading reading =
      read_text("a.json", tu3d("{1},\n" + tu3d_feature("MultiSurface", "[[[0,1,2]]]") + "\n,4"));
  EXPECT_THAT(reading.input().message, HasSubstr("line 1: feature 0"));
  EXPECT_THAT(reading.ids(), ElementsAre("a_2"));
}

TEST(Tu3dJson, LimitsAreKept) {
  FileSourceOptions options;
  options.limits.max_points_per_building = 5;
  const std::string text = tu3d(tu3d_feature("MultiSurface", "[[[0,1,2]],[[0,1,2]],[[0,1,2]]]"));
  const Reading reading = read_text("a.json", text, {}, options);
  EXPECT_THAT(reading.buildings.at(0), HasIssue(issue_code::kReadLimitExceeded));
  EXPECT_THAT(reading.buildings.at(0).geometries, IsEmpty());
  std::string deep(300, '[');
  EXPECT_THAT(read_text("a.json", tu3d(deep)).input().message, HasSubstr("max_depth"));
}

// ---- JSON-FG -----------------------------------------------------------------------------------

const std::string kFace = "[[[0,0,0],[1,0,0],[0,1,0],[0,0,0]]]";

std::string fg(const std::string& features, const std::string& more = "") {
  return R"({"type":"FeatureCollection")" + more + R"(,"features":[)" + features + "]}";
}

std::string fg_feature(const std::string& place, const std::string& more = "") {
  return R"({"type":"Feature")" + more + R"(,"geometry":null,"place":)" + place + "}";
}

std::string place(const std::string& type, const std::string& coordinates,
                  const std::string& more = "") {
  return R"({"type":")" + type + R"(","coordinates":)" + coordinates + more + "}";
}

TEST(JsonFg, ReadsPolyhedraAndTheirProperties) {
  const Reading reading = read_text(
      "city.fg.json",
      fg(fg_feature(place("Polyhedron", "[[" + kFace + "],[" + kFace + "," + kFace + "]]"),
                    R"(,"id":17,"properties":{"height":9.5})") +
         "," + fg_feature(place("MultiPolyhedron", "[[[" + kFace + "]],[[" + kFace + "]]]")) + "," +
         fg_feature(place("MultiPolygon", "[" + kFace + "]"))));
  EXPECT_EQ(reading.input().format, "JSON-FG");
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  ASSERT_THAT(reading.ids(), ElementsAre("17", "city_2", "city_3"));
  const Building& first = reading.buildings[0];
  EXPECT_THAT(first.attributes, SizeIs(1));
  EXPECT_EQ(first.geometries.at(0).type, GeometryType::Solid);
  EXPECT_THAT(first.geometries[0].solids.at(0).interiors, ElementsAre(ElementsAre(1, 2)));
  EXPECT_THAT(first.geometries[0].polygons.at(0).rings.at(0), SizeIs(4)) << "closed as it came";
  EXPECT_THAT(reading.buildings[1].geometries.at(0).solids, SizeIs(2));
  EXPECT_EQ(reading.buildings[2].geometries.at(0).type, GeometryType::MultiSurface);
}

TEST(JsonFg, ALoneFeatureIsADocument) {
  const Reading reading =
      read_text("a.json", fg_feature(place("Polyhedron", "[[" + kFace + "]]"), R"(,"id":"x")"));
  EXPECT_THAT(reading.ids(), ElementsAre("x"));
}

TEST(JsonFg, CoordinateSystemsOfDocumentFeatureAndPlace) {
  const std::string solid = "[[[[[391000,5820000,0],[391001,5820000,0],[391000,5820001,0]]]]]";
  const std::string name = "http://www.opengis.net/def/crs/EPSG/0/";
  for (const std::string& text :
       {fg(fg_feature(place("Polyhedron", solid)), R"(,"coordRefSys":")" + name + "25833\""),
        fg(fg_feature(place("Polyhedron", solid), R"(,"coordRefSys":"[EPSG:25833]")")),
        fg(fg_feature(place("Polyhedron", solid,
                            R"(,"coordRefSys":{"type":"Reference","href":")" + name + "25833\"}"))),
        fg(fg_feature(place("Polyhedron", solid),
                      R"(,"coordRefSys":[")" + name + R"(25833",")" + name + "5783\"]"))}) {
    const Reading reading = read_text("a.json", text);
    EXPECT_THAT(reading.selection.crs.id, ::testing::StartsWith("EPSG:25833")) << text;
    EXPECT_THAT(reading.buildings.at(0).geometries, SizeIs(1)) << text;
  }
}

TEST(JsonFg, PlacesThatAreNotReadAreIssues) {
  const std::string good = fg_feature(place("Polyhedron", "[[" + kFace + "]]"));
  for (const std::string& bad :
       {std::string("null"), place("Point", "[1,2,3]"), place("Polyhedron", "[[[[[0,0]]]]]"),
        place("Polyhedron", "[[[[1]]]]"), std::string("{}"),
        std::string(R"({"type":"GeometryCollection","geometries":[3]})")}) {
    const Reading reading = read_text("a.json", fg(good + "," + fg_feature(bad)));
    ASSERT_THAT(reading.ids(), ElementsAre("a_1", "a_2")) << bad;
    EXPECT_THAT(reading.buildings[1], HasIssue(issue_code::kUnreadableGeometry)) << bad;
  }
}

TEST(JsonFg, GeoJsonIsNoCityModel) {
  Documents documents;
  documents.add("roads.json",
                R"({"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}})");
  const Reading named = documents.read();
  EXPECT_EQ(named.input().state, "failed");
  EXPECT_THAT(named.input().message, HasSubstr("GeoJSON"));
  EXPECT_THAT(named.buildings, IsEmpty());
}

TEST(JsonFg, TypeMayStandBehindTheFeatures) {
  const std::string text = R"({"features":[)" +
                           fg_feature(place("Polyhedron", "[[" + kFace + "]]")) +
                           R"(],"type":"FeatureCollection"})";
  EXPECT_EQ(read_text("a.json", text).input().format, "JSON-FG");
}

}  // namespace
}  // namespace citymesh
