// Mesh files: every file or group is a building, nothing is repaired, bad input is named.
#include <cstring>

#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kObjVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";

Building only(const Reading& reading) {
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_THAT(reading.buildings, SizeIs(1));
  return reading.buildings.empty() ? Building{} : reading.buildings[0];
}

std::string failure(const std::string& name, const std::string& text,
                    const FileSourceOptions& options = {}) {
  const Reading reading = read_text(name, text, {}, options);
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.buildings, IsEmpty());
  return reading.input().message;
}

std::vector<std::size_t> ring_sizes(const Geometry& geometry) {
  std::vector<std::size_t> sizes;
  for (const Polygon& polygon : geometry.polygons)
    for (const Ring& ring : polygon.rings) sizes.push_back(ring.size());
  return sizes;
}

std::vector<SurfaceType> types(const Building& building) {
  std::vector<SurfaceType> types;
  for (const Polygon& polygon : building.geometries.at(0).polygons)
    types.push_back(polygon.surface < 0
                        ? SurfaceType::Unknown
                        : building.surfaces.at(static_cast<std::size_t>(polygon.surface)).type);
  return types;
}

FileSourceOptions few_points(std::uint64_t count) {
  FileSourceOptions options;
  options.limits.max_points_per_building = count;
  return options;
}

// ---- OBJ ---------------------------------------------------------------------------------------

TEST(Obj, AFileWithoutNamesIsOneBuildingNamedAsTheFile) {
  const Reading reading = read_text("tower.obj", kObjVertices + "f 1 2 3 4\nf 1/1 2/2/2 5//3\n");
  EXPECT_EQ(reading.input().format, "OBJ");
  const Building tower = only(reading);
  EXPECT_EQ(tower.gml_id, "tower");
  ASSERT_THAT(tower.geometries, SizeIs(1));
  EXPECT_EQ(tower.geometries[0].type, GeometryType::MultiSurface);
  EXPECT_EQ(tower.geometries[0].lod, (Lod{2, -1}));
  EXPECT_THAT(ring_sizes(tower.geometries[0]), ElementsAre(4, 3));
  EXPECT_THAT(tower.source_issues, IsEmpty());
}

TEST(Obj, ObjectsAreBuildings) {
  const Reading reading =
      read_text("a.obj", kObjVertices +
                             "f 1 2 3\no first one\nf 1 2 3\ng roof\nf 1 2 3\no second\nf 1 2 3\n"
                             "o first one\nf 1 2 5\no no_faces\nv 0 0 0\n");
  EXPECT_THAT(reading.ids(), ElementsAre("a_1", "first one", "second"));
  EXPECT_THAT(reading.buildings[1].geometries.at(0).polygons, SizeIs(3));
}

TEST(Obj, WithoutObjectsGroupsAreBuildings) {
  const Reading reading =
      read_text("a.obj", kObjVertices + "g a walls\nf 1 2 3\ng b\nf 1 2 3\ng a\nf 1 2 5\n");
  EXPECT_THAT(reading.ids(), ElementsAre("a", "b"));
  EXPECT_THAT(reading.buildings[0].geometries.at(0).polygons, SizeIs(2));
}

TEST(Obj, NamesOfPatchesTellTheSurfaceType) {
  const std::string patches =
      "g house__RoofSurface\nf 1 2 3\ng house__WallSurface\nf 1 2 5\n"
      "g house__RoofSurface\nf 2 3 5\n";
  for (const std::string& text : {kObjVertices + patches, "o house\n" + kObjVertices + patches}) {
    const Building house = only(read_text("a.obj", text));
    EXPECT_EQ(house.gml_id, "house");
    EXPECT_THAT(types(house), ElementsAre(SurfaceType::RoofSurface, SurfaceType::WallSurface,
                                          SurfaceType::RoofSurface));
  }
}

TEST(Obj, RelativeIndicesContinuedLinesAndLineEndsOfWindows) {
  const Building house = only(read_text("a.obj", "# made by hand\r\n" + kObjVertices +
                                                     "f -5 -4 \\\r\n  -3\r\nvn 0 0 1\r\ns off\r\n"
                                                     "f 1 2 3 # the same\r\n"));
  const Geometry& geometry = house.geometries.at(0);
  ASSERT_THAT(ring_sizes(geometry), ElementsAre(3, 3));
  EXPECT_EQ(geometry.polygons[0].rings[0], geometry.polygons[1].rings[0]);
}

TEST(Obj, RingsStayAsTheyCame) {
  const Building house = only(read_text("a.obj", kObjVertices + "f 1 2 2 1\nf 1 2\nf 3\n"));
  EXPECT_THAT(ring_sizes(house.geometries.at(0)), ElementsAre(4, 2, 1));
}

TEST(Obj, IndicesOutOfRangeAreIssuesAndTheOtherFacesStay) {
  for (const auto* bad : {"0", "9", "-6", "9223372036854775807", "-9223372036854775808"}) {
    const Building house =
        only(read_text("a.obj", kObjVertices + "f 1 2 3\nf 1 2 " + bad + "\nf 1 2 5\n"));
    EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(2)) << bad;
    EXPECT_THAT(house, HasIssue(issue_code::kVertexIndexOutOfRange)) << bad;
    EXPECT_THAT(house.source_issues.at(0).where, HasSubstr("face 2")) << bad;
  }
}

TEST(Obj, CoordinatesThatAreNoPlacesAreIssues) {
  for (const auto& [bad, code] : {std::pair{"nan", issue_code::kNonFiniteCoordinate},
                                  std::pair{"inf", issue_code::kCoordinateOutOfRange},
                                  std::pair{"1e400", issue_code::kCoordinateOutOfRange},
                                  std::pair{"-1e9", issue_code::kCoordinateOutOfRange}}) {
    const Building house =
        only(read_text("a.obj", kObjVertices + "v 0 " + bad + " 0\nf 1 2 3\nf 1 2 6\n"));
    EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(1)) << bad;
    EXPECT_THAT(house, HasIssue(code)) << bad;
  }
  EXPECT_THAT(only(read_text("a.obj", kObjVertices + "v 0 1e-400 0\nf 1 2 6\n")).source_issues,
              IsEmpty());
}

TEST(Obj, GarbageFailsNamingTheLine) {
  EXPECT_THAT(failure("a.obj", kObjVertices + "v 1 2 x\nf 1 2 3\n"), HasSubstr("line 6"));
  EXPECT_THAT(failure("a.obj", kObjVertices + "v 1 2\nf 1 2 3\n"), HasSubstr("line 6"));
  EXPECT_THAT(failure("a.obj", kObjVertices + "f 1 2 x\n"), HasSubstr("'x'"));
}

TEST(Obj, WithoutFacesTheBuildingSaysSo) {
  const Building house = only(read_text("a.obj", kObjVertices));
  EXPECT_EQ(house.gml_id, "a");
  EXPECT_THAT(house.geometries, IsEmpty());
  EXPECT_THAT(house, HasIssue(issue_code::kUnreadableGeometry));
}

TEST(Obj, TooManyCornersAreRefusedForTheirBuildingOnly) {
  const std::string many = "o many\nf 1 2 3\nf 1 2 3\nf 1 2 3\no few\nf 1 2 3\n";
  const Reading reading = read_text("a.obj", kObjVertices + many, {}, few_points(8));
  ASSERT_THAT(reading.ids(), ElementsAre("many", "few"));
  EXPECT_THAT(reading.buildings[0], HasIssue(issue_code::kReadLimitExceeded));
  EXPECT_THAT(reading.buildings[0].geometries, IsEmpty());
  EXPECT_THAT(reading.buildings[1].geometries, SizeIs(1));
}

TEST(Obj, IsRecognisedByContentAndReadPacked) {
  EXPECT_EQ(read_text("a.txt", kObjVertices + "f 1 2 3\n").input().format, "OBJ");
  EXPECT_EQ(read_text("a.obj.gz", "# nothing else\n" + kObjVertices + "f 1 2 3\n").ids(),
            std::vector<std::string>{"a"});
  EXPECT_THAT(failure("a.txt", "x y z\n1 2 3\n"), HasSubstr("unknown"));
}

// ---- OFF ---------------------------------------------------------------------------------------

const std::string kOffVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Off, ReadsFacesOfAnySize) {
  for (const std::string head : {"OFF\n4 2 0\n", "OFF 4 2 0\n", "# comment\n\nOFF\n# c\n4 2 0\n",
                                 "COFF\n4 2 0\n", "OFF\r\n4 2 0\r\n"}) {
    const Reading reading =
        read_text("a.off", head + kOffVertices + "3 0 1 2 255 0 0\n\n4 0 1 2 3 # square\n");
    EXPECT_EQ(reading.input().format, "OFF");
    EXPECT_THAT(ring_sizes(only(reading).geometries.at(0)), ElementsAre(3, 4)) << head;
  }
}

TEST(Off, WithoutItsKeywordTheNameTells) {
  EXPECT_EQ(only(read_text("cube.off", "4 1 0\n" + kOffVertices + "3 0 1 2\n")).gml_id, "cube");
}

TEST(Off, CountsThatTheFileDoesNotHoldFail) {
  EXPECT_THAT(failure("a.off", "OFF\n5 1 0\n" + kOffVertices), HasSubstr("4 of 5 vertices"));
  EXPECT_THAT(failure("a.off", "OFF\n4 2 0\n" + kOffVertices + "3 0 1 2\n"),
              HasSubstr("1 of 2 faces"));
  EXPECT_THAT(failure("a.off", "OFF\n18446744073709551615 18446744073709551615 0\n0 0 0\n"),
              HasSubstr("1 of 18446744073709551615"));
  EXPECT_THAT(failure("a.off", "OFF\n4 1 0\n" + kOffVertices + "3 0 1 2\n3 0 1 2\n"),
              HasSubstr("line 8: there is more than"));
  EXPECT_THAT(failure("a.off", "OFF\n4 1 0\n" + kOffVertices + "1000000 0 1 2\n"),
              HasSubstr("line 7"));
  EXPECT_THAT(failure("a.off", "OFF\n4 -1 0\n" + kOffVertices), HasSubstr("line 2"));
  EXPECT_THAT(failure("a.off", "OFF\n"), HasSubstr("missing"));
  EXPECT_THAT(failure("a.off", "OFF BINARY\n"), HasSubstr("binary"));
  EXPECT_THAT(failure("a.off", "4OFF\n1 0 0\n0 0 0 0\n"), HasSubstr("4OFF"));
}

TEST(Off, IndicesOutOfRangeAndEmptyFacesAreIssues) {
  const Building house =
      only(read_text("a.off", "OFF\n4 4 0\n" + kOffVertices + "3 0 1 2\n3 0 1 4\n3 0 1 -1\n0\n"));
  EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(1));
  EXPECT_THAT(house, HasIssue(issue_code::kVertexIndexOutOfRange));
  EXPECT_THAT(house, HasIssue(issue_code::kUnreadableRing));
}

TEST(Off, MorePointsThanTheLimitAreNotKept) {
  const std::string text = "OFF\n4 1 0\n" + kOffVertices + "3 0 1 2\n";
  EXPECT_THAT(only(read_text("a.off", text, {}, few_points(3))),
              HasIssue(issue_code::kReadLimitExceeded));
}

// ---- STL ---------------------------------------------------------------------------------------

std::string facet(const std::string& last = "0 1 0") {
  return "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex " + last +
         "\n endloop\nendfacet\n";
}

std::string stl_solid(const std::string& name, const std::string& facets) {
  return "solid " + name + "\n" + facets + "endsolid " + name + "\n";
}

TEST(StlText, SolidsAreBuildings) {
  const Reading reading =
      read_text("a.stl", stl_solid("one", facet() + facet()) + stl_solid("", facet()) +
                             stl_solid("one", "") + stl_solid("one", facet()));
  EXPECT_EQ(reading.input().format, "STL (text)");
  EXPECT_THAT(reading.ids(), ElementsAre("one", "a_2", "one"));
  EXPECT_THAT(reading.buildings[0].geometries.at(0).polygons, SizeIs(2));
}

TEST(StlText, PatchesOfABuildingJoin) {
  const Building house =
      only(read_text("a.stl", stl_solid("b__house__RoofSurface", facet()) +
                                  stl_solid("b__house__WallSurface", facet("0 0 1"))));
  EXPECT_EQ(house.gml_id, "b__house");
  EXPECT_THAT(types(house), ElementsAre(SurfaceType::RoofSurface, SurfaceType::WallSurface));
}

TEST(StlText, CaseAndLinesDoNotMatter) {
  const Building house =
      only(read_text("a.stl",
                     "SOLID Tower of glass\nFACET NORMAL 0 0 1 OUTER LOOP VERTEX 0 0 0 "
                     "VERTEX 1 0 0 VERTEX 0 1 0 ENDLOOP ENDFACET\nENDSOLID\n"));
  EXPECT_EQ(house.gml_id, "Tower of glass");
  EXPECT_THAT(ring_sizes(house.geometries.at(0)), ElementsAre(3));
}

TEST(StlText, TruncatedAndGarbledFilesFailNamingTheLine) {
  const std::string whole = stl_solid("a", facet());
  EXPECT_THAT(failure("a.stl", whole.substr(0, whole.find("endloop"))),
              HasSubstr("line 8: the file ends"));
  EXPECT_THAT(failure("a.stl", stl_solid("a", facet("0 1 x"))), HasSubstr("line 6"));
  EXPECT_THAT(failure("a.stl", stl_solid("a", facet() + "oops\n")), HasSubstr("'oops'"));
}

TEST(StlText, NotANumberIsAnIssue) {
  const Building house = only(read_text("a.stl", stl_solid("a", facet("0 nan 0") + facet())));
  EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(1));
  EXPECT_THAT(house, HasIssue(issue_code::kNonFiniteCoordinate));
}

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

void append_float(std::string& bytes, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  append_u32(bytes, bits);
}

std::string binary_stl(std::uint32_t stated, int facets, float last = 1) {
  std::string bytes = "solid made by a program";
  bytes.resize(80, ' ');
  append_u32(bytes, stated);
  for (int f = 0; f < facets; ++f) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, last, 0.5f})
      append_float(bytes, value);
    bytes.append(2, '\7');
  }
  return bytes;
}

TEST(StlBinary, IsOneBuildingWhateverItsHeaderAndName) {
  for (const auto* name : {"tower.stl", "tower.dat", "tower.stl.gz"}) {
    const Reading reading = read_text(name, binary_stl(2, 2));
    EXPECT_EQ(reading.input().format, "STL (binary)");
    const Building tower = only(reading);
    EXPECT_EQ(tower.gml_id, "tower");
    EXPECT_THAT(ring_sizes(tower.geometries.at(0)), ElementsAre(3, 3));
    EXPECT_EQ(tower.geometries[0].points.at(2), (Point3{0, 1, 0.5}));
  }
}

TEST(StlBinary, CountsThatTheFileDoesNotHoldFailNamingTheByte) {
  EXPECT_THAT(failure("a.stl", binary_stl(3, 2)),
              HasSubstr("byte 184: the file ends after 2 of 3"));
  EXPECT_THAT(failure("a.stl", binary_stl(0xFFFFFFFF, 1)), HasSubstr("of 4294967295"));
  EXPECT_THAT(failure("a.stl", binary_stl(1, 2)), HasSubstr("goes on"));
}

TEST(StlBinary, NotANumberIsAnIssue) {
  EXPECT_THAT(only(read_text("a.stl", binary_stl(1, 1, std::nanf("")))),
              HasIssue(issue_code::kNonFiniteCoordinate));
}

// ---- PLY ---------------------------------------------------------------------------------------

std::string ply_header(const std::string& format, const std::string& face_properties,
                       const std::string& faces = "2") {
  return "ply\nformat " + format +
         " 1.0\ncomment c\nelement vertex 4\nproperty double x\nproperty float quality\n"
         "property double y\nproperty double z\nelement face " +
         faces + "\n" + face_properties + "end_header\n";
}

const std::string kPlyList = "property list uchar int vertex_indices\n";
const std::string kPlyVertices = "0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0.5\n";

TEST(Ply, ReadsText) {
  const Reading reading =
      read_text("a.ply", ply_header("ascii", kPlyList) + kPlyVertices + "3 0 1 2\n4 0 1\n2 3\n");
  EXPECT_EQ(reading.input().format, "PLY (text)");
  const Building house = only(reading);
  EXPECT_EQ(house.gml_id, "a");
  EXPECT_THAT(ring_sizes(house.geometries.at(0)), ElementsAre(3, 4));
  EXPECT_THAT(house.geometries[0].points, Contains(Point3{0, 1, 0.5}));
}

template <class Value>
void append_bytes(std::string& bytes, Value value, bool big_endian) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof raw);
  if (big_endian) std::reverse(std::begin(raw), std::end(raw));
  bytes.append(raw, sizeof raw);
}

std::string binary_ply(bool big, const std::string& faces = "2") {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian",
                                 "property short flags\n" + kPlyList, faces);
  for (const Point3 point : {Point3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}}) {
    append_bytes(bytes, point.x, big);
    append_bytes(bytes, 9.f, big);
    append_bytes(bytes, point.y, big);
    append_bytes(bytes, point.z, big);
  }
  for (const std::vector<std::int32_t>& face : {std::vector{0, 1, 2}, {0, 1, 2, 3}}) {
    append_bytes(bytes, std::int16_t{-7}, big);
    append_bytes(bytes, static_cast<std::uint8_t>(face.size()), big);
    for (const std::int32_t index : face) append_bytes(bytes, index, big);
  }
  return bytes;
}

TEST(Ply, ReadsBinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const Reading reading = read_text("a.ply", binary_ply(big));
    EXPECT_EQ(reading.input().format, "PLY (binary)");
    const Building house = only(reading);
    EXPECT_THAT(ring_sizes(house.geometries.at(0)), ElementsAre(3, 4));
    EXPECT_THAT(house.geometries[0].points, Contains(Point3{0, 1, 0.5}));
  }
}

TEST(Ply, BodiesAreBuildings) {
  const Reading reading =
      read_text("a.ply", ply_header("ascii", kPlyList + "property int body\n", "3") + kPlyVertices +
                             "3 0 1 2 7\n3 0 1 3 -1\n3 0 2 3 7\n");
  EXPECT_THAT(reading.ids(), ElementsAre("a_1", "a_2"));
  EXPECT_THAT(reading.buildings[0].geometries.at(0).polygons, SizeIs(2));
}

TEST(Ply, OtherElementsAreSteppedOver) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement material 1\nproperty list int float values\nelement vertex "
      "3\nproperty float x\nproperty float y\nproperty float z\nelement nothing 9\nelement face "
      "1\nproperty list uint8 uint32 vertex_index\nend_header\n2 1.5 2.5\n0 0 0\n1 0 0\n0 1 0\n3 0 "
      "1 2\n";
  EXPECT_THAT(ring_sizes(only(read_text("a.ply", text)).geometries.at(0)), ElementsAre(3));
}

TEST(Ply, TruncatedFilesAndAbsurdCountsFail) {
  const std::string text = ply_header("ascii", kPlyList) + kPlyVertices;
  EXPECT_THAT(failure("a.ply", text + "3 0 1 2\n"), HasSubstr("in face 1 of 2: the file ends"));
  EXPECT_THAT(failure("a.ply", text + "3 0 1 x\n"), HasSubstr("'x' is no number"));
  EXPECT_THAT(failure("a.ply", text + "-3 0 1 2\n"), HasSubstr("length of -3"));
  EXPECT_THAT(failure("a.ply", binary_ply(false, "99999999999999")), HasSubstr("byte "));
  EXPECT_THAT(failure("a.ply", "ply\nformat ascii 1.0\nelement"), HasSubstr("line 3"));
  EXPECT_THAT(failure("a.ply", "ply\nformat funny 1.0\nend_header\n"), HasSubstr("'funny'"));
  EXPECT_THAT(failure("a.ply", "ply\nformat ascii 1.0\nelement face 1\nend_header\n"),
              HasSubstr("x, y and z"));
}

TEST(Ply, IndicesThatAreNoneAreIssues) {
  for (const auto* bad : {"4", "-1", "1.5", "nan", "1e300"}) {
    const Building house =
        only(read_text("a.ply", ply_header("ascii", "property list uchar float vertex_indices\n") +
                                    kPlyVertices + "3 0 1 2\n3 0 1 " + bad + "\n"));
    EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(1)) << bad;
    EXPECT_THAT(house, HasIssue(issue_code::kVertexIndexOutOfRange)) << bad;
  }
}

TEST(Ply, MorePointsThanTheLimitAreNotKept) {
  const std::string text = ply_header("ascii", kPlyList) + kPlyVertices + "3 0 1 2\n3 0 1 2\n";
  for (const std::uint64_t limit : {3u, 5u})
    EXPECT_THAT(only(read_text("a.ply", text, {}, few_points(limit))),
                HasIssue(issue_code::kReadLimitExceeded));
}

// ---- POLY --------------------------------------------------------------------------------------

std::string poly(int first, const std::string& facets) {
  std::string text = "# a roof\n5 3 0 0\n";
  for (const auto* point : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0.2 0.2 0"})
    text += std::to_string(first++) + " " + point + "\n";
  return text + facets + "0\n0\n";
}

TEST(Poly, TheFacetsAreTheShellOfASolid) {
  for (const int first : {0, 1}) {
    const std::string text =
        first == 0 ? "2 0\n1 0\n4 0 1 2 3\n1\n3 0 1\n 4\n" : "2 0\n1 0\n4 1 2 3 4\n1\n3 1 2\n 5\n";
    const Reading reading = read_text("a.poly", poly(first, text));
    EXPECT_EQ(reading.input().format, "POLY");
    const Building house = only(reading);
    const Geometry& geometry = house.geometries.at(0);
    EXPECT_EQ(geometry.type, GeometryType::Solid);
    EXPECT_THAT(ring_sizes(geometry), ElementsAre(4, 3));
    ASSERT_THAT(geometry.solids, SizeIs(1));
    EXPECT_THAT(geometry.solids[0].exterior, ElementsAre(0, 1));
  }
}

TEST(Poly, FurtherRingsOfAFacetAreHoles) {
  for (const auto* head : {"2 1\n", "2 0\n", "2 1 0\n"}) {
    const bool hole_point = std::string(head).find(" 1") != std::string::npos;
    const Building house =
        only(read_text("a.poly", poly(0, "1 0\n" + std::string(head) + "4 0 1 2 3\n3 0 1 4\n" +
                                             (hole_point ? "1 0.5 0.1 0\n" : ""))));
    ASSERT_THAT(house.geometries.at(0).polygons, SizeIs(1));
    EXPECT_THAT(house.geometries[0].polygons[0].rings, SizeIs(2));
  }
}

TEST(Poly, BadFilesFailNamingTheLine) {
  EXPECT_THAT(failure("a.poly", "0 3 0 0\n1 0\n"), HasSubstr("file of their own"));
  EXPECT_THAT(failure("a.poly", "4 2 0 0\n0 0 0\n"), HasSubstr("line 1"));
  EXPECT_THAT(failure("a.poly", "2 3 0 0\n0 0 0 0\n2 0 0 0\n"), HasSubstr("line 3: node 2"));
  EXPECT_THAT(failure("a.poly", "999999999999 3 0 0\n0 0 0 0\n"), HasSubstr("after 1 of"));
  EXPECT_THAT(failure("a.poly", poly(0, "9 0\n1 0\n3 0 1 2\n")), HasSubstr("line "));
  EXPECT_THAT(failure("a.poly", poly(0, "1 0\n1 0\n3 0 1 x\n")), HasSubstr("'x'"));
}

TEST(Poly, NodesThatAreMissingAreIssues) {
  for (const auto* bad : {"5", "-1", "9223372036854775807"}) {
    const Building house = only(
        read_text("a.poly", poly(0, "2 0\n1 0\n3 0 1 2\n1 0\n3 0 1 " + std::string(bad) + "\n")));
    EXPECT_THAT(house.geometries.at(0).polygons, SizeIs(1)) << bad;
    EXPECT_THAT(house, HasIssue(issue_code::kVertexIndexOutOfRange)) << bad;
  }
}

}  // namespace
}  // namespace citymesh
