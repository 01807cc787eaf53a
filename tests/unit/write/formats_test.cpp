#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/gates/gates.h"
#include "core/write/write.h"
#include "tests/unit/write/files.h"
#include "tests/unit/write/scene.h"
#include "tests/unit/write/writing.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

using test::encode;
using test::kScene;
using test::write_scene;

std::vector<ParsedBody> parsed_file(std::string_view key, const std::filesystem::path& folder) {
  std::vector<ParsedBody> bodies;
  const auto parsed = parse_file(key, folder / find_format(key)->file_name, [&](ParsedBody&& body) {
    bodies.push_back(std::move(body));
    return Result<void>{};
  });
  EXPECT_TRUE(parsed) << parsed.error().message;
  return bodies;
}

/// Triangles by patch as grid coordinates, rotated to start at the smallest corner and sorted: the
/// same for the same geometry however it is stored.
using Triangles = std::map<std::string, std::vector<std::array<GridPoint, 3>>>;

void insert(Triangles& triangles, const std::string& patch, std::array<GridPoint, 3> corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  auto& list = triangles[patch];
  list.insert(std::upper_bound(list.begin(), list.end(), corners), corners);
}

Triangles triangles_of(const TriangleMesh& mesh) {
  Triangles triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    insert(triangles, std::string(to_string(mesh.surface_types[i])),
           {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
  }
  return triangles;
}

Triangles triangles_of(const ParsedBody& body) {
  const auto welded = weld(body);
  EXPECT_TRUE(welded) << welded.error().message;
  Triangles triangles;
  for (std::size_t i = 0; i < welded->triangles.size(); ++i) {
    const Triangle& t = welded->triangles[i];
    insert(triangles, body.patches[i],
           {welded->points[t[0]], welded->points[t[1]], welded->points[t[2]]});
  }
  return triangles;
}

class EveryFormat : public ::testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::ValuesIn([] {
                           std::vector<std::string_view> keys;
                           for (const Format& format : formats()) keys.push_back(format.key);
                           return keys;
                         }()),
                         [](const auto& param) { return std::string(param.param); });

TEST_P(EveryFormat, GivesBackTheSamePointsTrianglesAndPatchesOfEachBody) {
  const auto city = test::synthetic_city(2, 3);
  test::TemporaryFolder folder;
  write_scene(folder.path(), GetParam(), city);
  const auto bodies = parsed_file(GetParam(), folder.path());
  ASSERT_EQ(bodies.size(), city.size());
  for (std::size_t i = 0; i < city.size(); ++i) {
    EXPECT_EQ(bodies[i].name, city[i].bodies[0].name);
    EXPECT_EQ(triangles_of(bodies[i]), triangles_of(city[i].bodies[0].mesh));
    EXPECT_EQ(weld(bodies[i])->points.size(), city[i].bodies[0].mesh.points.size());
  }
}

TEST_P(EveryFormat, EncodesOneBuildingAsACompleteDocument) {
  const auto house = test::building("b_1", test::house(10, 8, 5, 9, {-500.0001, 3.25, -0.0001}));
  std::vector<ParsedBody> bodies;
  const auto parsed = parse_text(GetParam(), encode(GetParam(), house), [&](ParsedBody&& body) {
    bodies.push_back(std::move(body));
    return Result<void>{};
  });
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(triangles_of(bodies[0]), triangles_of(house.bodies[0].mesh));
}

TEST_P(EveryFormat, IsReadWithoutACrashWhateverByteIsWrong) {
  const std::string whole = encode(GetParam(), test::building("b_1", test::house(10, 8, 5, 9)));
  std::uint32_t state = 7;
  const auto random = [&state](std::size_t below) {
    state = static_cast<std::uint32_t>(static_cast<std::uint64_t>(state) * 48271 % 2147483647);
    return state % below;
  };
  constexpr std::string_view kWrong = "0123456789-.eE+ \n\t\"[]{}:,/abfgosvx_\\\xFF\x01";
  for (int round = 0; round < 3000; ++round) {
    std::string text = whole;
    for (std::size_t n = random(3) + 1; n > 0; --n) {
      const std::size_t at = random(text.size());
      if (random(4) == 0) {
        text.erase(at, random(20) + 1);
      } else {
        text[at] = kWrong[random(kWrong.size())];
      }
    }
    const auto parsed = parse_text(GetParam(), text, [](ParsedBody&& body) {
      const auto welded = weld(body);
      EXPECT_TRUE(!welded || welded->triangles.size() == body.triangles.size());
      return Result<void>{};
    });
    EXPECT_TRUE(parsed || parsed.error().code == ErrorCode::DataLoss);
  }
}

TEST_P(EveryFormat, IsCompleteAndReadableWithoutAnyBuilding) {
  test::TemporaryFolder folder;
  write_scene(folder.path(), GetParam(), {});
  EXPECT_TRUE(parsed_file(GetParam(), folder.path()).empty());
}

TEST_P(EveryFormat, AppearsUnderItsNameOnlyWhenComplete) {
  test::TemporaryFolder folder;
  const Format& format = *find_format(GetParam());
  {
    auto writer = open_writer(format, folder.path(), kScene);
    ASSERT_TRUE(writer);
    EXPECT_TRUE(writer.value()->add(test::building("b_1", test::box(1, 1, 1))));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / format.file_name));
  }
  EXPECT_EQ(test::files_in(folder.path()), 0u) << "an abandoned writer leaves nothing behind";
}

TEST_P(EveryFormat, SaysWhichFileTheDiskRefusedAndWhy) {
  test::TemporaryFolder folder;
  const auto missing = open_writer(*find_format(GetParam()), folder.path() / "missing", kScene);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(missing.error().message, HasSubstr("model"));
  EXPECT_THAT(missing.error().message, HasSubstr("No such file or directory"));
}

TEST_P(EveryFormat, ReportsAFullDisk) {
  // A file size limit makes the kernel refuse the bytes, as a full disk does.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  test::TemporaryFolder folder;
  auto writer = open_writer(*find_format(GetParam()), folder.path(), kScene);
  Result<void> result = writer ? Result<void>{} : Result<void>(writer.error());
  for (const auto& building : test::synthetic_city(2, 2))
    if (result) result = writer.value()->add(building);
  if (result) result = writer.value()->finish();
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(result.error().message, HasSubstr("File too large"));
}

TEST(Formats, AreFoundByKeyAndListedForMessages) {
  EXPECT_EQ(find_format("dwg"), nullptr);
  EXPECT_THAT(format_keys(), HasSubstr("obj, stl, stl_binary, ply, vtu, glb, cityjson"));
  EXPECT_EQ(find_format("stl_binary")->file_name, "model_binary.stl");
  EXPECT_EQ(find_format("stl_binary")->sidecar, "model_binary.patches.json");
}

TEST(Formats, HaveFilesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Format& format : formats()) {
    EXPECT_TRUE(names.insert(format.file_name).second) << format.file_name;
    EXPECT_FALSE(format.title.empty());
    EXPECT_FALSE(format.media_type.empty());
  }
}

TEST(Obj, StatesOriginCrsUnitAndAxesInItsHeader) {
  const std::string text = encode("obj", test::building("b_1", test::box(1, 1, 1)));
  EXPECT_THAT(text, HasSubstr("# crs EPSG:25833\n"));
  EXPECT_THAT(text, HasSubstr("# origin 391000 5820000 0\n"));
  EXPECT_THAT(text, HasSubstr("# unit metre\n"));
  EXPECT_THAT(text, HasSubstr("# axes x east, y north, z up, right-handed\n"));
  EXPECT_THAT(text, HasSubstr("# absolute coordinates = origin + v\n"));
}

TEST(Obj, KeepsHostileTextsInsideTheirComment) {
  Scene scene = kScene;
  scene.crs.id = "EPSG:1\nf 1 2 3";
  EXPECT_THAT(encode("obj", test::building("b_1", test::box(1, 1, 1)), scene),
              Not(HasSubstr("\nf 1 2 3\n# origin")));
}

TEST(Obj, SharesNoVertexBetweenObjects) {
  test::TemporaryFolder folder;
  const auto city = {test::building("b_1", test::box(1, 1, 1)),
                     test::building("b_2", test::box(1, 1, 1, {1, 0, 0}))};
  const std::string text = write_scene(folder.path(), "obj", city);
  EXPECT_EQ(std::count(text.begin(), text.end(), 'v') -
                static_cast<std::ptrdiff_t>(std::string("v").size()),  // one in the header
            16);
  EXPECT_THAT(text, HasSubstr("o b_2\nv 1.0000 1.0000 0.0000\n"));
  EXPECT_THAT(text, HasSubstr("g b_2__GroundSurface\nf 9 10 11\n"));
}

TEST(Obj, GroupsFacesInTheOrderOfSurfaceTypes) {
  const std::string text = encode("obj", test::building("b_1", test::box(1, 1, 1)));
  const auto ground = text.find("g b_1__GroundSurface"), wall = text.find("g b_1__WallSurface"),
             roof = text.find("g b_1__RoofSurface");
  EXPECT_LT(ground, wall);
  EXPECT_LT(wall, roof);
  EXPECT_EQ(text.find("g b_1__", roof + 1), std::string::npos);
}

TEST(Stl, NamesASolidByBodyAndSurfaceType) {
  const std::string text = encode("stl", test::building("b_1", test::box(1, 1, 1)));
  EXPECT_TRUE(text.starts_with("solid b_1__GroundSurface\nfacet normal 0.0000 0.0000 -1.0000\n"));
  EXPECT_THAT(text, HasSubstr("endsolid b_1__RoofSurface\n"));
}

TEST(Stl, ByTypeHasEachSolidOnceForTheWholeScene) {
  Scene scene = kScene;
  scene.patches = Patches::ByType;
  test::TemporaryFolder folder;
  const std::string text = write_scene(folder.path(), "stl",
                                       {test::building("b_1", test::box(1, 1, 1)),
                                        test::building("b_2", test::box(1, 1, 1, {5, 0, 0}))},
                                       scene);
  std::vector<std::string> solids;
  for (auto at = text.find("\nsolid "); at != std::string::npos; at = text.find("\nsolid ", at + 1))
    solids.push_back(text.substr(at + 7, text.find('\n', at + 1) - at - 7));
  EXPECT_TRUE(text.starts_with("solid GroundSurface\n"));
  EXPECT_THAT(solids, ElementsAre("WallSurface", "RoofSurface"));

  const auto bodies = parsed_file("stl", folder.path());
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies[0].name, "");
  EXPECT_EQ(bodies[0].patches.front(), "GroundSurface");
  EXPECT_EQ(bodies[0].triangles.size(), 4u);
  EXPECT_EQ(bodies[1].triangles.size(), 16u);
}

TEST(BinaryStl, RefusesWhatFloat32CannotHoldAndNamesTheAsciiFormat) {
  test::TemporaryFolder folder;
  auto writer = open_writer(*find_format("stl_binary"), folder.path(), kScene);
  const auto at_limit = test::building("b_1", test::box(24, 10, 10, {1000, 0, 0}));
  const auto beyond = test::building("b_2", test::box(24.0001, 10, 10, {1000, 0, 0}));
  EXPECT_TRUE(writer.value()->encode(at_limit));
  const auto refused = writer.value()->encode(beyond);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(refused.error().message, HasSubstr("1024.0001 m"));
  EXPECT_THAT(refused.error().message, HasSubstr("stl (ASCII)"));
  EXPECT_FALSE(writer.value()->add(beyond));
}

TEST(BinaryStl, KeepsTheGridUpToItsLimit) {
  // Steps of 0.1 mm next to 1024 m, where float32 is coarsest.
  std::vector<BuildingBodies> buildings;
  for (int i = 0; i < 200; ++i) {
    const std::string name = "b_" + std::to_string(i);
    buildings.push_back(
        test::building(name, test::box(1, 1, 1, {1022.9 + 0.0001 * i, -1023.9 + 0.0003 * i, 0})));
  }
  test::TemporaryFolder folder;
  write_scene(folder.path(), "stl_binary", buildings);
  const auto bodies = parsed_file("stl_binary", folder.path());
  ASSERT_EQ(bodies.size(), buildings.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    EXPECT_EQ(triangles_of(bodies[i]), triangles_of(buildings[i].bodies[0].mesh));
}

TEST(BinaryStl, ListsTriangleRangesAndTheFrameInItsSidecar) {
  test::TemporaryFolder folder;
  const std::string stl = write_scene(
      folder.path(), "stl_binary",
      {test::building("b_1", test::box(1, 1, 1)), test::building("b_2", test::house(10, 8, 5, 9))});
  EXPECT_EQ(stl.size(), 84 + 50 * (12 + 16));
  EXPECT_FALSE(stl.starts_with("solid"));
  const auto sidecar =
      nlohmann::json::parse(test::read_file(folder.path() / "model_binary.patches.json"));
  EXPECT_EQ(sidecar["crs"], "EPSG:25833");
  EXPECT_EQ(sidecar["origin"], nlohmann::json({391000.0, 5820000.0, 0.0}));
  EXPECT_EQ(sidecar["unit"], "metre");
  EXPECT_EQ(sidecar["triangles"], 28);
  ASSERT_EQ(sidecar["patches"].size(), 6u);
  const auto& patch = sidecar["patches"][3];
  EXPECT_EQ(patch["name"], "b_2__GroundSurface");
  EXPECT_EQ(patch["body"], "b_2");
  EXPECT_EQ(patch["surface_type"], "GroundSurface");
  EXPECT_EQ(patch["first_triangle"], 12);
  EXPECT_EQ(patch["triangle_count"], 2);
}

TEST(BinaryStl, ByTypeHasOneRangePerSurfaceTypeAndKeepsTheBodies) {
  Scene scene = kScene;
  scene.patches = Patches::ByType;
  test::TemporaryFolder folder;
  write_scene(folder.path(), "stl_binary",
              {test::building("b_1", test::box(1, 1, 1)),
               test::building("b_2", test::box(1, 1, 1, {5, 0, 0}))},
              scene);
  const auto sidecar =
      nlohmann::json::parse(test::read_file(folder.path() / "model_binary.patches.json"));
  ASSERT_EQ(sidecar["patches"].size(), 3u);
  EXPECT_EQ(sidecar["patches"][1]["name"], "WallSurface");
  EXPECT_EQ(sidecar["patches"][1]["first_triangle"], 4);
  EXPECT_EQ(sidecar["patches"][1]["triangle_count"], 16);
  EXPECT_EQ(sidecar["patches"][1]["bodies"][1]["body"], "b_2");
  EXPECT_EQ(sidecar["patches"][1]["bodies"][1]["first_triangle"], 8);
  EXPECT_EQ(parsed_file("stl_binary", folder.path()).size(), 3u);
}

// ---- CityJSON ----

BuildingBodies building_with_parts() {
  BuildingBodies building = test::building("B 1", test::box(5, 5, 3));
  building.bodies[0].name = "b_1";
  building.attributes = {{"roofType", std::string("1000 \"flat\"")},
                         {"measuredHeight", 3.1},
                         {"storeysAboveGround", std::int64_t{2}},
                         {"listed", true},
                         {"roofType", std::string("again")}};
  for (const char* id : {"part one", "part two"}) {
    Body part;
    part.name = id[5] == 'o' ? "p_1" : "p_2";
    part.gml_id = id;
    part.kind = ObjectKind::BuildingPart;
    part.lod = "1";
    part.mesh = test::box(2, 2, 2, {id[5] == 'o' ? 10.0 : 20.0, 0, 0});
    building.bodies.push_back(std::move(part));
  }
  return building;
}

nlohmann::json cityjson_of(const std::vector<BuildingBodies>& buildings,
                           const Scene& scene = kScene) {
  test::TemporaryFolder folder;
  return nlohmann::json::parse(write_scene(folder.path(), "cityjson", buildings, scene));
}

TEST(CityJson, HasTheMembersTheStandardAsksFor) {
  const auto json = cityjson_of({building_with_parts()});
  EXPECT_EQ(json["type"], "CityJSON");
  EXPECT_EQ(json["version"], "2.0");
  EXPECT_EQ(json["transform"]["scale"], nlohmann::json({0.0001, 0.0001, 0.0001}));
  EXPECT_EQ(json["transform"]["translate"], nlohmann::json({391000.0, 5820000.0, 0.0}));
  EXPECT_EQ(json["metadata"]["referenceSystem"], "https://www.opengis.net/def/crs/EPSG/0/25833");
  EXPECT_EQ(json["metadata"]["geographicalExtent"],
            nlohmann::json({391000.0, 5820000.0, 0.0, 391022.0, 5820005.0, 3.0}));
  for (const auto& vertex : json["vertices"]) {
    ASSERT_EQ(vertex.size(), 3u);
    for (const auto& value : vertex) EXPECT_TRUE(value.is_number_integer());
  }
}

TEST(CityJson, LinksPartsAndTheirBuildingBothWays) {
  const auto json = cityjson_of({building_with_parts()});
  const auto& objects = json["CityObjects"];
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects["B 1"]["type"], "Building");
  EXPECT_EQ(objects["B 1"]["children"], nlohmann::json({"part one", "part two"}));
  EXPECT_EQ(objects["part two"]["type"], "BuildingPart");
  EXPECT_EQ(objects["part two"]["parents"], nlohmann::json({"B 1"}));
  EXPECT_EQ(objects["part two"]["geometry"][0]["lod"], "1");
}

TEST(CityJson, KeepsAttributesWithTheirTypesAndTheFirstOfARepeatedName) {
  const auto json = cityjson_of({building_with_parts()});
  EXPECT_EQ(json["CityObjects"]["B 1"]["attributes"], (nlohmann::json{{"roofType", "1000 \"flat\""},
                                                                      {"measuredHeight", 3.1},
                                                                      {"storeysAboveGround", 2},
                                                                      {"listed", true}}));
}

TEST(CityJson, HasASolidOfPolygonsWithOneSemanticSurfacePerSourceSurface) {
  const auto json = cityjson_of({test::building("b_1", test::box(5, 5, 3))});
  const auto& geometry = json["CityObjects"]["b_1"]["geometry"][0];
  EXPECT_EQ(geometry["type"], "Solid");
  EXPECT_EQ(geometry["lod"], "2");
  ASSERT_EQ(geometry["boundaries"].size(), 1u);
  ASSERT_EQ(geometry["boundaries"][0].size(), 6u);
  for (const auto& face : geometry["boundaries"][0]) {
    ASSERT_EQ(face.size(), 1u);
    EXPECT_EQ(face[0].size(), 4u);
    for (const auto& index : face[0]) EXPECT_LT(index.get<std::size_t>(), json["vertices"].size());
  }
  const auto& semantics = geometry["semantics"];
  ASSERT_EQ(semantics["surfaces"].size(), 6u);
  EXPECT_EQ(semantics["surfaces"][0],
            (nlohmann::json{{"type", "GroundSurface"}, {"id", "ground"}}));
  ASSERT_EQ(semantics["values"].size(), 1u);
  EXPECT_EQ(semantics["values"][0], nlohmann::json({0, 1, 2, 3, 4, 5}));
}

TEST(CityJson, WritesHolesAsInnerRingsAndCavitiesAsInnerShells) {
  const auto json = cityjson_of({test::building("b_1", test::with_shaft_and_cavity())});
  const auto& geometry = json["CityObjects"]["b_1"]["geometry"][0];
  EXPECT_EQ(geometry["type"], "Solid");
  const auto& shells = geometry["boundaries"];
  ASSERT_EQ(shells.size(), 3u) << "the exterior and two cavities";
  EXPECT_EQ(shells[0].size(), 10u);
  EXPECT_EQ(shells[0][0].size(), 2u) << "the ground has the hole of the shaft";
  EXPECT_EQ(shells[1].size(), 6u);
  EXPECT_EQ(shells[2].size(), 6u);
  EXPECT_EQ(geometry["semantics"]["values"][2].size(), 6u);
}

TEST(CityJson, BeginsANewSolidWhereAnExteriorFollowsACavity) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  auto& faces = building.bodies[0].mesh.faces;
  faces[1].cavity = true;
  const auto json = cityjson_of({building});
  const auto& geometry = json["CityObjects"]["b_1"]["geometry"][0];
  EXPECT_EQ(geometry["type"], "MultiSolid");
  ASSERT_EQ(geometry["boundaries"].size(), 2u);
  EXPECT_EQ(geometry["boundaries"][0].size(), 2u);
  EXPECT_EQ(geometry["semantics"]["values"], nlohmann::json::parse("[[[0],[1]],[[2,3,4,5]]]"));
}

TEST(CityJson, ExteriorsThatShareNoPointAreSolidsOfTheirOwn) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  TriangleMesh& mesh = building.bodies[0].mesh;
  const auto count = static_cast<std::uint32_t>(mesh.points.size());
  const std::vector<Face> faces = mesh.faces;
  for (std::uint32_t i = 0; i < count; ++i) {
    GridPoint moved = mesh.points[i];
    moved.x += 50'000;
    mesh.points.push_back(moved);
  }
  for (Face face : faces) {
    for (Ring& ring : face.rings)
      for (std::uint32_t& corner : ring) corner += count;
    mesh.faces.push_back(std::move(face));
  }
  const auto json = cityjson_of({building});
  const auto& geometry = json["CityObjects"]["b_1"]["geometry"][0];
  EXPECT_EQ(geometry["type"], "MultiSolid");
  ASSERT_EQ(geometry["boundaries"].size(), 2u);
  EXPECT_EQ(geometry["boundaries"][0][0].size(), 6u);
  EXPECT_EQ(geometry["boundaries"][1][0].size(), 6u);
}

TEST(CityJson, KeepsAddresses) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  building.addresses = {{"Main \"Street\"", "12a", "", "12345", "Berlin", "", "Germany"}};
  EXPECT_EQ(cityjson_of({building})["CityObjects"]["b_1"]["address"],
            nlohmann::json::parse(
                R"([{"Country":"Germany","Locality":"Berlin","Postcode":"12345",
                     "ThoroughfareName":"Main \"Street\"","ThoroughfareNumber":"12a"}])"));
}

TEST(CityJson, KeepsInstallationsAsChildren) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  Body balcony{.name = "balcony", .gml_id = "balcony", .kind = ObjectKind::BuildingInstallation};
  balcony.mesh = test::box(1, 1, 1, {3, 0, 0});
  building.bodies.push_back(std::move(balcony));
  const auto objects = cityjson_of({building})["CityObjects"];
  EXPECT_EQ(objects["balcony"]["type"], "BuildingInstallation");
  EXPECT_EQ(objects["balcony"]["parents"], nlohmann::json({"b_1"}));
}

TEST(CityJson, StatesNoSemanticsWhereTheTypeIsUnknown) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  for (auto& face : building.bodies[0].mesh.faces) face.type = SurfaceType::Unknown;
  EXPECT_FALSE(cityjson_of({building})["CityObjects"]["b_1"]["geometry"][0].contains("semantics"));
  building.bodies[0].mesh.faces[3].type = SurfaceType::RoofSurface;
  EXPECT_TRUE(
      cityjson_of({building})["CityObjects"]["b_1"]["geometry"][0]["semantics"]["values"][0][0]
          .is_null());
}

TEST(CityJson, GivesEveryObjectAnIdOfItsOwn) {
  auto second = test::building("b_2", test::box(1, 1, 1, {5, 0, 0}));
  second.gml_id = "b_1";
  EXPECT_EQ(cityjson_of({test::building("b_1", test::box(1, 1, 1)), second})["CityObjects"].size(),
            2u);
}

TEST(CityJson, NamesACompoundCrsInTheTitleAndItsHorizontalPartAsUri) {
  Scene scene = kScene;
  scene.crs.id = "EPSG:25833+5783";
  const auto json = cityjson_of({test::building("b_1", test::box(1, 1, 1))}, scene);
  EXPECT_EQ(json["metadata"]["referenceSystem"], "https://www.opengis.net/def/crs/EPSG/0/25833");
  EXPECT_THAT(json["metadata"]["title"].get<std::string>(), HasSubstr("crs EPSG:25833+5783"));
  scene.crs.id = "LOCAL";
  EXPECT_FALSE(cityjson_of({}, scene)["metadata"].contains("referenceSystem"));
}

}  // namespace
}  // namespace citymesh
