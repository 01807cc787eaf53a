#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/gates/gates.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Parsed {
  std::vector<ParsedBody> bodies{};
  Result<void> result{};
};

Parsed parse(std::string_view format, std::string_view text) {
  Parsed parsed;
  parsed.result = parse_text(format, text, [&parsed](ParsedBody&& body) {
    parsed.bodies.push_back(std::move(body));
    return Result<void>{};
  });
  return parsed;
}

void expect_refused(std::string_view format, std::string_view text, const std::string& message) {
  const Parsed parsed = parse(format, text);
  ASSERT_FALSE(parsed.result) << text;
  EXPECT_EQ(parsed.result.error().code, ErrorCode::DataLoss);
  EXPECT_THAT(parsed.result.error().message, HasSubstr(message)) << text;
}

TEST(Parse, NamesAFormatItDoesNotKnow) {
  const Parsed parsed = parse("dwg", "");
  ASSERT_FALSE(parsed.result);
  EXPECT_EQ(parsed.result.error().code, ErrorCode::Unimplemented);
  EXPECT_THAT(parsed.result.error().message, HasSubstr("\"dwg\""));
}

TEST(Parse, NamesAFileThatIsNotThere) {
  for (const char* format : {"obj", "stl", "stl_binary", "ply", "vtu", "glb", "cityjson",
                             "cityjsonseq", "citygml2", "citygml3"}) {
    const auto result =
        parse_file(format, "/nowhere/model.x", [](ParsedBody&&) { return Result<void>{}; });
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::NotFound) << format;
    EXPECT_THAT(result.error().message, HasSubstr("model.x"));
  }
}

TEST(Parse, PassesTheErrorOfTheSinkOn) {
  const auto result = parse_text("obj", "o a\no b\n", [](ParsedBody&&) {
    return Result<void>(fail(ErrorCode::Cancelled, "enough"));
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Cancelled);
}

// ---- OBJ ----

constexpr std::string_view kObj =
    "# comment\no a\nv 0.0000 0.0000 0.0000\nv 1.0000 0 0\nv 0 1 -0.0001\ng a__WallSurface\nf 1 2 "
    "3\n"
    "o b_2\nv 5 0 0\nv 6 0 0\nv 5 1 0\ng b_2__RoofSurface\nf 4 5 6\n";

TEST(ParseObj, GivesBodiesWithTheirOwnPointsAndPatches) {
  const Parsed parsed = parse("obj", kObj);
  ASSERT_TRUE(parsed.result) << parsed.result.error().message;
  ASSERT_EQ(parsed.bodies.size(), 2u);
  EXPECT_EQ(parsed.bodies[0].name, "a");
  EXPECT_EQ(parsed.bodies[0].points[2], (Point3{0, 1, -0.0001}));
  EXPECT_EQ(parsed.bodies[1].name, "b_2");
  EXPECT_EQ(parsed.bodies[1].triangles[0], (Triangle{0, 1, 2}));
  EXPECT_THAT(parsed.bodies[1].patches, ElementsAre("RoofSurface"));
}

TEST(ParseObj, RefusesAVertexSharedBetweenObjects) {
  expect_refused("obj", std::string(kObj) + "f 3 5 6\n", "line 14: vertex 3");
}

TEST(ParseObj, RefusesBrokenTextNamingTheLine) {
  expect_refused("obj", "v 0 0 0\n", "line 1: a vertex before");
  expect_refused("obj", "o a\nv 0 0\n", "line 2: expected a number");
  expect_refused("obj", "o a\nv 0 0 nan\n", "line 2: \"nan\" is not finite");
  expect_refused("obj", "o a\nv 0 0 1e999\n", "line 2");
  expect_refused("obj", "o a\nv 0 0 0 1\n", "line 2: more than three");
  expect_refused("obj", "o a\nv 0 0 0\nf 1 1 1\n", "line 3: a face outside");
  expect_refused("obj", "o a\nv 0 0 0\ng b__WallSurface\n", "line 3: group \"b__WallSurface\"");
  expect_refused("obj", "o a\nv 0 0 0\ng a__WallSurface\nf 1 1\n", "line 4: expected a vertex");
  expect_refused("obj", "o a\nv 0 0 0\ng a__WallSurface\nf 1 1 1 1\n", "line 4: a face with more");
  expect_refused("obj", "o a\nv 0 0 0\ng a__WallSurface\nf 1 1 -1\n", "line 4");
  expect_refused("obj", "o a\nvt 0 0\n", "line 2: unknown statement \"vt\"");
  expect_refused("obj", "o\n", "line 1: an object needs one name");
}

// ---- ASCII STL ----

std::string facet(std::string_view vertex = "vertex 0 1 0") {
  return "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n" + std::string(vertex) +
         "\nendloop\nendfacet\n";
}

std::string solid(const std::string& name, const std::string& facets) {
  return "solid " + name + "\n" + facets + "endsolid " + name + "\n";
}

TEST(ParseStl, JoinsTheSolidsOfABody) {
  const Parsed parsed =
      parse("stl", solid("a__b__WallSurface", facet()) + solid("a__b__RoofSurface", facet()) +
                       solid("c__WallSurface", facet() + facet()));
  ASSERT_TRUE(parsed.result) << parsed.result.error().message;
  ASSERT_EQ(parsed.bodies.size(), 2u);
  EXPECT_EQ(parsed.bodies[0].name, "a__b");
  EXPECT_THAT(parsed.bodies[0].patches, ElementsAre("WallSurface", "RoofSurface"));
  EXPECT_EQ(parsed.bodies[1].triangles.size(), 2u);
}

TEST(ParseStl, GivesANamelessBodyForEachSolidByType) {
  const Parsed parsed = parse("stl", solid("WallSurface", facet()) + solid("RoofSurface", facet()));
  ASSERT_EQ(parsed.bodies.size(), 2u);
  EXPECT_EQ(parsed.bodies[0].name, "");
  EXPECT_THAT(parsed.bodies[1].patches, ElementsAre("RoofSurface"));
}

TEST(ParseStl, RefusesBrokenTextNamingTheLine) {
  expect_refused("stl", "facet\n", "line 1: expected \"solid\"");
  expect_refused("stl", "solid a__WallSurface\n" + facet(), "ends inside of solid");
  expect_refused("stl", solid("a__WallSurface", facet("vertex 0 inf 0")), "line 6");
  expect_refused("stl", solid("a__WallSurface", facet("endloop")), "line 6: expected \"vertex\"");
  expect_refused("stl", "solid a__WallSurface\nendsolid b\n", "line 2: expected the end of solid");
  expect_refused("stl", "solid\n", "line 1: a solid needs one name");
}

// ---- binary STL ----

std::string binary_stl(std::uint32_t count, std::size_t triangles, const std::string& sidecar) {
  std::string bytes(80, ' ');
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((count >> shift) & 255);
  return bytes + std::string(50 * triangles, '\0') + sidecar;
}

std::string range(const std::string& body, int first, int count) {
  return R"({"name":"p","body":")" + body + R"(","surface_type":"WallSurface","first_triangle":)" +
         std::to_string(first) + R"(,"triangle_count":)" + std::to_string(count) + "}";
}

TEST(ParseBinaryStl, CutsBodiesByTheRangesOfTheSidecar) {
  const Parsed parsed =
      parse("stl_binary", binary_stl(3, 3,
                                     "{\"patches\":[" + range("a", 0, 1) + "," + range("a", 1, 1) +
                                         "," + range("b", 2, 1) + "]}"));
  ASSERT_TRUE(parsed.result) << parsed.result.error().message;
  ASSERT_EQ(parsed.bodies.size(), 2u);
  EXPECT_EQ(parsed.bodies[0].triangles.size(), 2u);
  EXPECT_TRUE(parsed.bodies[0].float32);
  EXPECT_EQ(parsed.bodies[1].name, "b");
}

TEST(ParseBinaryStl, RefusesCountsThatDoNotFit) {
  expect_refused("stl_binary", "short", "expected at least 84");
  expect_refused("stl_binary", binary_stl(4'000'000'000u, 1, ""), "4000000000 triangles");
  expect_refused("stl_binary", binary_stl(2, 2, "{\"patches\":[" + range("a", 0, 1) + "]}"),
                 "names 1 triangles, the file has 2");
  expect_refused("stl_binary", binary_stl(2, 2, "{\"patches\":[" + range("a", 0, 3) + "]}"),
                 "range of 3 triangles");
  expect_refused(
      "stl_binary",
      binary_stl(2, 2, "{\"patches\":[" + range("a", 0, 1) + "," + range("b", 0, 1) + "]}"),
      "does not follow");
  expect_refused("stl_binary", binary_stl(1, 1, ""), "sidecar");
  expect_refused("stl_binary", binary_stl(1, 1, "{\"patches\":[{}]}"), "sidecar");
}

// ---- CityJSON ----

std::string cityjson(const std::string& geometry, const std::string& vertices) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.0001,0.0001,0.0001],)"
         R"("translate":[1,2,3]},"CityObjects":{"a \"b\"":{"type":"Building","geometry":[)" +
         geometry + "]}},\"vertices\":[" + vertices + "]}";
}

constexpr std::string_view kTriangleVertices = "[0,0,0],[10000,0,0],[0,-15000,1]";

std::string solid_of(const std::string& faces, const std::string& more = "") {
  return R"({"type":"Solid","lod":"2","boundaries":[[)" + faces + "]]" + more + "}";
}

TEST(ParseCityJson, GivesPointsRelativeToTheOrigin) {
  const Parsed parsed = parse(
      "cityjson",
      cityjson(
          solid_of("[[0,1,2]],[[2,1,0]]",
                   R"(,"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[[0,null]]})"),
          std::string(kTriangleVertices)));
  ASSERT_TRUE(parsed.result) << parsed.result.error().message;
  ASSERT_EQ(parsed.bodies.size(), 1u);
  EXPECT_EQ(parsed.bodies[0].name, "a \"b\"");
  EXPECT_EQ(parsed.bodies[0].points.size(), 3u);
  EXPECT_DOUBLE_EQ(parsed.bodies[0].points[2].y, -1.5);
  EXPECT_THAT(parsed.bodies[0].patches, ElementsAre("RoofSurface", ""));
}

TEST(ParseCityJson, CutsPolygonsWithHolesIntoTriangles) {
  const Parsed parsed = parse(
      "cityjson", cityjson(solid_of("[[0,1,2,3],[4,5,6]]"),
                           "[0,0,0],[90,0,0],[90,90,0],[0,90,0],[30,30,0],[30,60,0],[60,30,0]"));
  ASSERT_TRUE(parsed.result) << parsed.result.error().message;
  EXPECT_EQ(parsed.bodies[0].triangles.size(), 7u);
  EXPECT_EQ(parsed.bodies[0].patches.size(), 7u);
}

TEST(ParseCityJson, RefusesWhatTheWriterWouldNotWrite) {
  const std::string vertices(kTriangleVertices);
  expect_refused("cityjson", cityjson(solid_of("[[0,1,3]]"), vertices), "vertex 3 of 3");
  expect_refused("cityjson", cityjson(solid_of("[[0,1]]"), vertices), "bound no area");
  expect_refused("cityjson", cityjson(solid_of("[[0,1,2],[0,1,2]]"), vertices), "bound no area");
  expect_refused("cityjson", cityjson(solid_of("[[0,1,2]]"), "[0,0,0],[1,0,0],[3000000000,0,1]"),
                 "beyond the grid");
  expect_refused("cityjson", cityjson(solid_of("[[0,1,2]]"), "[0,0,0.5]"), "");
  expect_refused("cityjson", cityjson(solid_of("[[0,1,2]]"), "[0,0]"), "three numbers");
  expect_refused("cityjson", cityjson(R"({"type":"MultiSurface","boundaries":[]})", vertices),
                 "expected a Solid");
  expect_refused(
      "cityjson",
      cityjson(solid_of("[[0,1,2]]", R"(,"semantics":{"surfaces":[],"values":[[0]]})"), vertices),
      "semantic surface 0 of 0");
  expect_refused(
      "cityjson",
      cityjson(solid_of("[[0,1,2]]", R"(,"semantics":{"surfaces":[],"values":[[]]})"), vertices),
      "0 semantic values for 1 faces");
  expect_refused("cityjson", "{\"type\":\"Feature\",\"version\":\"2.0\"}", "expected a CityJSON");
}

TEST(ParseCityJson, SurvivesTextThatEndsAnywhere) {
  const std::string whole = cityjson(solid_of("[[0,1,2]]"), std::string(kTriangleVertices));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(parse("cityjson", std::string_view(whole).substr(0, length)).result) << length;
  EXPECT_TRUE(parse("cityjson", whole).result);
}

// ---- files ----

TEST(ParseFile, ReadsLinesAcrossItsPiecesAndNamesTheFileInErrors) {
  std::string folder = (std::filesystem::temp_directory_path() / "citymesh-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const auto file = std::filesystem::path(folder) / "model.obj";
  const int kBodies = 60'000;  // several pieces of a megabyte
  {
    std::ofstream out(file);
    for (int i = 0; i < kBodies; ++i)
      out << "o b_" << i << "\nv 0.0000 0.0000 0.0000\nv 1.0000 0.0000 0.0000\nv 0.0000 1.0000 "
          << i << ".0000\n";
  }
  int bodies = 0;
  double sum = 0;
  const auto count = [&](ParsedBody&& body) {
    ++bodies;
    sum += body.points.at(2).z;
    return Result<void>{};
  };
  EXPECT_TRUE(parse_file("obj", file, count));
  EXPECT_EQ(bodies, kBodies);
  EXPECT_EQ(sum, 0.5 * kBodies * (kBodies - 1.0));

  std::ofstream(file, std::ios::app) << "x\n";
  const auto broken = parse_file("obj", file, count);
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("model.obj: line 240001"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace citymesh
