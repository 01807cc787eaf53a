// Mesh files of others from CITYMESH_EXTRA_DATA, and what we write ourselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/source/source.h"
#include "core/write/write.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct FileContent {
  InputReport input{};
  std::vector<Building> buildings{};
  Point3 origin{};

  std::set<int> issues() const {
    std::set<int> codes;
    for (const Building& building : buildings)
      for (const Issue& issue : building.source_issues) codes.insert(issue.code);
    return codes;
  }
  std::size_t faces() const {
    std::size_t count = 0;
    for (const Building& building : buildings)
      for (const Geometry& geometry : building.geometries) count += geometry.polygons.size();
    return count;
  }
};

FileContent content_of(const fs::path& path) {
  FileContent content;
  auto source = open_files({path}, {});
  if (!source) {
    ADD_FAILURE() << source.error().message;
    return content;
  }
  const auto selection = (*source)->select({}, {});
  if (!selection) {
    ADD_FAILURE() << path << ": " << selection.error().message;
    return content;
  }
  content.input = selection->inputs.at(0);
  content.origin = selection->origin;
  const auto read = (*source)->read({}, *selection,
                                    [&](Building&& building) -> Result<void> {
                                      content.buildings.push_back(std::move(building));
                                      return {};
                                    },
                                    {});
  EXPECT_TRUE(read) << path;
  return content;
}

const char* extra_data() { return std::getenv("CITYMESH_EXTRA_DATA"); }
constexpr const char* kNoData = "CITYMESH_EXTRA_DATA is not set: no data outside of the repository";

struct KnownSoup {
  const char* path;
  std::size_t faces;
};

// The table of README.md there.
constexpr KnownSoup kSoups[] = {
    {"kaykit/building_castle_red.obj", 3071},
    {"kaykit/building_church_red.obj", 883},
    {"kaykit/building_tower_A_red.obj", 840},
    {"kaykit/building_bridge_A.obj", 309},
    {"kaykit/wall_straight_gate.obj", 177},
    {"kaykit/building_destroyed.obj", 482},
    {"kaykit/building_well_red.obj", 432},
    {"kaykit/city_building_A.obj", 440},
    {"kaykit/city_building_D.obj", 581},
    {"kaykit/city_building_E.obj", 720},
    {"tour_part_dieu/tour_part_dieu_0.obj", 1176},
    {"tour_part_dieu/tour_part_dieu_1.obj", 183},
    {"tour_part_dieu/tour_part_dieu_2.obj", 82},
    {"openfoam_windAroundBuildings.obj.gz", 400020},
    {"easy3d-repair/self_intersection/pig.off", 891},
    {"easy3d-repair/self_intersection/two_spheres.obj", 640},
    {"easy3d-repair/degenerate.off", 8},
    {"easy3d-repair/non_manifold/complex_edges_0.off", 9},
    {"easy3d-repair/extreme/complex_face_2.off", 1},
};

TEST(MeshFiles, SoupsHaveTheFacesTheyAreKnownToHave) {
  if (!extra_data()) GTEST_SKIP() << kNoData;
  for (const KnownSoup& soup : kSoups) {
    const FileContent content = content_of(fs::path(extra_data()) / "soups" / soup.path);
    EXPECT_EQ(content.input.state, "read") << soup.path << content.input.message;
    EXPECT_THAT(content.buildings, SizeIs(1)) << soup.path;
    EXPECT_EQ(content.faces(), soup.faces) << soup.path;
    EXPECT_THAT(content.issues(), IsEmpty()) << soup.path;
  }
}

TEST(MeshFiles, AHeaderThatStatesMoreFacesThanThereAreIsRefused) {
  if (!extra_data()) GTEST_SKIP() << kNoData;
  const FileContent content =
      content_of(fs::path(extra_data()) / "soups/easy3d-repair/non_manifold/5_umbrellas_open.off");
  EXPECT_EQ(content.input.state, "failed");
  EXPECT_THAT(content.input.message, ::testing::HasSubstr("20 of 25 faces"));
}

/// What the descriptions of the defect suite say where it is not "readable".
struct Exception {
  bool refused = false;
  int issue = 0;
};

const std::map<std::string, Exception> kExceptions = {
    {"test_empty/completely_empty.obj", {.refused = true}},
    {"test_empty/completely_empty.off", {.refused = true}},
    {"test_empty/empty_primitive.obj", {.issue = issue_code::kUnreadableGeometry}},
    {"test_empty/empty_primitive.off", {.issue = issue_code::kUnreadableGeometry}},
    {"test_empty/empty_primitive.poly", {.issue = issue_code::kUnreadableGeometry}},
    // Valid there, but further from zero than any place on earth.
    {"poly/cube26.poly", {.issue = issue_code::kCoordinateOutOfRange}},
    {"test_valid/basecube_large_coords.poly", {.issue = issue_code::kCoordinateOutOfRange}},
    {"test_file_format/index0.obj", {.issue = issue_code::kVertexIndexOutOfRange}},
    {"test_file_format/index901.obj", {.issue = issue_code::kVertexIndexOutOfRange}},
    {"test_jsonfg/cubes2.fg.json", {.issue = issue_code::kUnreadableGeometry}},
    {"test_jsonfg/geojson.json", {.refused = true}},
};

TEST(MeshFiles, DefectSuiteIsReadOrRefusedAsItSays) {
  if (!extra_data()) GTEST_SKIP() << kNoData;
  const fs::path folder = fs::path(extra_data()) / "val3dity-defects";
  std::size_t files = 0, exceptions = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    const std::string extension = entry.path().extension().string();
    const bool json = extension == ".json" &&
                      (name.starts_with("test_tu3djson/") || name.starts_with("test_jsonfg/"));
    if (!json && extension != ".obj" && extension != ".off" && extension != ".ply" &&
        extension != ".poly")
      continue;
    ++files;
    const FileContent content = content_of(entry.path());
    const auto exception = kExceptions.find(name);
    if (exception == kExceptions.end()) {
      EXPECT_EQ(content.input.state, "read") << name << ": " << content.input.message;
      EXPECT_GT(content.faces(), 0u) << name;
      EXPECT_THAT(content.issues(), IsEmpty()) << name;
      continue;
    }
    ++exceptions;
    EXPECT_EQ(content.input.state, exception->second.refused ? "failed" : "read") << name;
    EXPECT_EQ(content.buildings.empty(), exception->second.refused) << name;
    if (!exception->second.refused) {
      EXPECT_THAT(content.issues(), ::testing::ElementsAre(exception->second.issue)) << name;
    }
  }
  EXPECT_EQ(exceptions, kExceptions.size());
  EXPECT_GE(files, 130u);
}

TEST(MeshFiles, SolidsOfTheDefectSuiteKeepTheirShells) {
  if (!extra_data()) GTEST_SKIP() << kNoData;
  const fs::path folder = fs::path(extra_data()) / "val3dity-defects";
  const FileContent tu3d = content_of(folder / "test_tu3djson/cube3.json");
  ASSERT_THAT(tu3d.buildings, SizeIs(2));
  EXPECT_EQ(tu3d.buildings[1].geometries.at(0).type, GeometryType::MultiSolid);
  const FileContent fg = content_of(folder / "test_jsonfg/building.fg.json");
  ASSERT_THAT(fg.buildings, SizeIs(1));
  EXPECT_EQ(fg.buildings[0].gml_id, "DENW19AL0000giv5BL");
  EXPECT_EQ(fg.buildings[0].geometries.at(0).type, GeometryType::Solid);
  EXPECT_EQ(fg.input.crs, "EPSG:5555");
  const FileContent poly = content_of(folder / "test_geometry_generic/201.poly");
  EXPECT_THAT(poly.buildings.at(0).geometries.at(0).polygons.at(0).rings, SizeIs(3));
}

/// Corners in metres and surface type of every triangle.
using Triangles = std::multiset<std::pair<std::vector<std::array<double, 3>>, SurfaceType>>;

Triangles triangles_of(const TriangleMesh& mesh) {
  Triangles triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::vector<std::array<double, 3>> corners;
    for (const std::uint32_t corner : mesh.triangles[i]) {
      const Point3 p = to_metres(mesh.points[corner]);
      corners.push_back({p.x, p.y, p.z});
    }
    triangles.emplace(std::move(corners), mesh.surface_types[i]);
  }
  return triangles;
}

Triangles triangles_of(const Building& building, const Point3& origin) {
  Triangles triangles;
  for (const Geometry& geometry : building.geometries)
    for (const Polygon& polygon : geometry.polygons) {
      std::vector<std::array<double, 3>> corners;
      for (const std::uint32_t index : polygon.rings.at(0)) {
        const Point3& p = geometry.points[index];
        corners.push_back({p.x + origin.x, p.y + origin.y, p.z + origin.z});
      }
      triangles.emplace(std::move(corners),
                        polygon.surface < 0
                            ? SurfaceType::Unknown
                            : building.surfaces[static_cast<std::size_t>(polygon.surface)].type);
    }
  return triangles;
}

TEST(MeshFiles, WhatWeWriteIsReadBackAsTheSameMesh) {
  BuildingBodies house{.gml_id = "h", .rung = "as_is"};
  house.bodies.push_back({.name = "house", .gml_id = "h", .mesh = test::house(8, 6, 3, 5)});
  house.bodies.push_back({.name = "hall", .gml_id = "h2", .mesh = test::box(20, 12, 7.5)});
  for (const auto* key : {"obj", "stl", "ply"}) {
    const TempFolder folder;
    const Format* format = find_format(key);
    ASSERT_NE(format, nullptr);
    auto writer = open_writer(*format, folder.path(), {});
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE((*writer)->add(house));
    ASSERT_TRUE((*writer)->finish());
    const FileContent content = content_of(folder / std::string(format->file_name));
    EXPECT_EQ(content.input.state, "read") << key << ": " << content.input.message;
    ASSERT_THAT(content.buildings, SizeIs(2)) << key;
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_EQ(content.buildings[b].gml_id, house.bodies[b].name) << key;
      EXPECT_EQ(triangles_of(content.buildings[b], content.origin),
                triangles_of(house.bodies[b].mesh))
          << key;
    }
  }
}

}  // namespace
}  // namespace citymesh
