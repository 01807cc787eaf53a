// What PLY, VTU and GLB say beside the triangles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/gates/gates.h"
#include "tests/unit/write/scene.h"
#include "tests/unit/write/writing.h"

namespace citymesh {
namespace {

using test::encode;
using test::kScene;
using ::testing::HasSubstr;

std::uint32_t u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

nlohmann::json gltf_of(std::string_view glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(u32(glb, 4), 2u);
  EXPECT_EQ(u32(glb, 8), glb.size());
  return nlohmann::json::parse(glb.substr(20, u32(glb, 12)));
}

TEST(Ply, SaysInItsHeaderWhereTheModelLiesAndWhichBodyIsWhich) {
  const std::string ply = encode("ply", test::rich_building());
  const std::string head = ply.substr(0, ply.find("end_header"));
  EXPECT_TRUE(head.starts_with("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(head, HasSubstr("comment crs EPSG:25833\ncomment origin 391000 5820000 0\n"));
  EXPECT_THAT(head, HasSubstr("comment surface_type 0 Unknown 1 GroundSurface 2 WallSurface"));
  EXPECT_THAT(head,
              HasSubstr("comment body {\"body\":3,\"name\":\"balcony\",\"gml_id\":\"balcony\","
                        "\"kind\":\"BuildingInstallation\""));
}

TEST(Ply, SharesNoVertexBetweenBodies) {
  const auto touching = [] {
    BuildingBodies building = test::building("b_1", test::box(1, 1, 1));
    building.bodies.push_back({.name = "b_2", .gml_id = "b_2"});
    building.bodies[1].mesh = test::box(1, 1, 1, {1, 0, 0});
    return building;
  }();
  EXPECT_THAT(encode("ply", touching), HasSubstr("element vertex 16\n"));
}

TEST(Ply, KeepsHostileIdsInsideTheirComment) {
  auto building = test::building("b_1", test::box(1, 1, 1));
  building.bodies[0].gml_id = "a\nend_header\nelement face 9";
  std::size_t bodies = 0;
  EXPECT_TRUE(parse_text("ply", encode("ply", building), [&](ParsedBody&& body) {
    bodies += body.triangles.size() == 12 ? 1u : 0u;
    return Result<void>{};
  }));
  EXPECT_EQ(bodies, 1u);
}

TEST(Vtu, HasDoublePointsTrianglesAndTheBodyAndSurfaceTypeOfEach) {
  const std::string vtu = encode("vtu", test::building("b_1", test::box(1, 1, 1)));
  for (const char* array :
       {"type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", "type=\"Int32\" Name=\"body\"",
        "type=\"UInt8\" Name=\"surface_type\"", "type=\"Int64\" Name=\"connectivity\"",
        "NumberOfPoints=\"8\" NumberOfCells=\"12\"", "header_type=\"UInt64\""})
    EXPECT_THAT(vtu, HasSubstr(array));
  EXPECT_THAT(vtu, HasSubstr(">391000 5820000 0</DataArray>"));
  EXPECT_THAT(vtu, HasSubstr("EPSG:25833"));
  EXPECT_THAT(vtu, HasSubstr("{\"body\":0,\"name\":\"b_1\""));
}

TEST(Glb, HasANodePerBodyWithWhatIsKnownOfIt) {
  const auto gltf = gltf_of(encode("glb", test::rich_building()));
  ASSERT_EQ(gltf["nodes"].size(), 4u);
  EXPECT_EQ(gltf["scenes"][0]["nodes"], nlohmann::json({0, 1, 2, 3}));
  const auto& house = gltf["nodes"][0];
  EXPECT_EQ(house["name"], "b_1_house_one");
  EXPECT_EQ(house["extras"]["gml_id"], "1 house:one");
  EXPECT_EQ(house["extras"]["rung"], "healed");
  EXPECT_EQ(house["extras"]["lod"], "3");
  EXPECT_EQ(house["extras"]["attributes"]["storeysAboveGround"], 1);
  EXPECT_EQ(house["extras"]["addresses"][0]["ThoroughfareName"], "Main Street");
  EXPECT_EQ(gltf["nodes"][3]["extras"]["building"], "1 house:one");
  EXPECT_EQ(gltf["nodes"][3]["extras"]["kind"], "BuildingInstallation");
  EXPECT_EQ(gltf["asset"]["extras"]["origin"], nlohmann::json({391000.0, 5820000.0, 0.0}));
}

TEST(Glb, TurnsUpToYAndPutsTheTranslationInTheMiddleOfTheBody) {
  const auto gltf =
      gltf_of(encode("glb", test::building("b_1", test::box(4, 6, 10, {50'000, 20'000, 30}))));
  EXPECT_EQ(gltf["nodes"][0]["translation"], nlohmann::json({50'002, 35, -20'003}));
  const auto& positions = gltf["accessors"][0];
  EXPECT_EQ(positions["min"], nlohmann::json({-2.0, -5.0, -3.0}));
  EXPECT_EQ(positions["max"], nlohmann::json({2.0, 5.0, 3.0}));
}

TEST(Glb, HasAPrimitiveWithAMaterialForEachSurfaceType) {
  const auto gltf = gltf_of(encode("glb", test::building("b_1", test::house(10, 8, 5, 9))));
  const auto& primitives = gltf["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 3u);
  std::vector<std::string> names;
  for (const auto& primitive : primitives) {
    const auto& material = gltf["materials"][primitive["material"].get<std::size_t>()];
    names.push_back(material["name"]);
    EXPECT_EQ(primitive["attributes"]["POSITION"], 0);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"GroundSurface", "WallSurface", "RoofSurface"}));
}

TEST(Glb, AlignsItsChunksAndViews) {
  const std::string glb = encode("glb", test::rich_building());
  const auto gltf = gltf_of(glb);
  const std::uint32_t json_bytes = u32(glb, 12);
  EXPECT_EQ(json_bytes % 4, 0u);
  EXPECT_EQ(glb.substr(20 + json_bytes + 4, 4), std::string_view("BIN\0", 4));
  EXPECT_EQ(u32(glb, 20 + json_bytes), gltf["buffers"][0]["byteLength"]);
  for (const auto& view : gltf["bufferViews"]) EXPECT_EQ(view.value("byteOffset", 0) % 4, 0);
  for (const auto& accessor : gltf["accessors"])
    EXPECT_EQ(accessor["byteOffset"].get<int>() % 4, 0);
}

TEST(Glb, RefusesABodyThatFloat32CannotHold) {
  test::TemporaryFolder folder;
  auto writer = open_writer(*find_format("glb"), folder.path(), kScene);
  EXPECT_TRUE(
      writer.value()->encode(test::building("b_1", test::box(2000, 10, 10, {150'000, 0, 0}))));
  const auto refused = writer.value()->encode(test::building("b_2", test::box(2100, 10, 10)));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(refused.error().message, HasSubstr("1050.0000 m from its middle"));
  EXPECT_THAT(refused.error().message, HasSubstr("ply"));
}

TEST(CityJsonSeq, HasAHeaderLineWithTheExtentAndAFeaturePerBuilding) {
  test::TemporaryFolder folder;
  const std::string text = test::write_scene(
      folder.path(), "cityjsonseq",
      {test::rich_building(), test::building("b_2", test::box(1, 1, 1, {5, 5, 5}))});
  std::istringstream lines(text);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto head = nlohmann::json::parse(line);
  EXPECT_EQ(head["type"], "CityJSON");
  EXPECT_EQ(head["metadata"]["geographicalExtent"][0], 391000.0);
  EXPECT_TRUE(head["CityObjects"].empty());
  EXPECT_TRUE(head["vertices"].empty());
  ASSERT_TRUE(std::getline(lines, line));
  const auto first = nlohmann::json::parse(line);
  EXPECT_EQ(first["type"], "CityJSONFeature");
  EXPECT_EQ(first["id"], "1 house:one");
  EXPECT_EQ(first["CityObjects"].size(), 4u);
  EXPECT_FALSE(first.contains("transform"));
  ASSERT_TRUE(std::getline(lines, line));
  const auto second = nlohmann::json::parse(line);
  EXPECT_EQ(second["vertices"].size(), 8u);
  EXPECT_EQ(second["CityObjects"]["b_2"]["geometry"][0]["boundaries"][0][0][0][0], 0);
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace citymesh
