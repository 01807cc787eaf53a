// The bytes of every format for a cube and a house, compared with the files beside this test. After
// a wanted change of a format: CITYMESH_UPDATE_GOLDEN=1, look at the difference, commit it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/base/version.h"
#include "core/write/write.h"
#include "tests/unit/write/files.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

/// Files name the version of the program; the golden ones say VERSION.
std::string without_version(std::string text) {
  const std::string version = "citymesh " + std::string(citymesh::version());
  for (auto at = text.find(version); at != std::string::npos; at = text.find(version, at))
    text.replace(at, version.size(), "citymesh VERSION");
  return text;
}

std::vector<BuildingBodies> cube_and_house() {
  BuildingBodies cube = test::building("cube", test::box(1, 1, 1));
  cube.attributes = {{"measuredHeight", 1.0}, {"function", std::string("31001_1000")}};
  BuildingBodies house =
      test::building("house", test::house(10.5, 8.25, 5.0625, 9.125, {-20, 3.0001, -0.0001}));
  Body annex;
  annex.name = annex.gml_id = "annex";
  annex.kind = ObjectKind::BuildingPart;
  annex.lod = "1";
  annex.mesh = test::box(3, 3, 2.5, {-5, 3, 0});
  house.bodies.push_back(std::move(annex));
  return {cube, house};
}

void expect_golden(const std::string& name, const std::string& text) {
  const auto file = std::filesystem::path(CITYMESH_GOLDEN) / name;
  if (std::getenv("CITYMESH_UPDATE_GOLDEN") != nullptr)
    std::ofstream(file, std::ios::binary) << without_version(text);
  EXPECT_TRUE(test::read_file(file) == without_version(text)) << name << " differs:\n" << text;
}

void expect_golden_files(std::string_view key, Patches patches, const std::string& prefix,
                         const std::vector<BuildingBodies>& buildings) {
  const Format& format = *find_format(key);
  test::TemporaryFolder folder;
  const Scene scene{{"EPSG:25833"}, {391000, 5820000, 0}, "export-for-simulation", patches};
  auto writer = open_writer(format, folder.path(), scene);
  ASSERT_TRUE(writer);
  for (const auto& building : buildings) ASSERT_TRUE(writer.value()->add(building));
  ASSERT_TRUE(writer.value()->finish());
  for (const std::string_view name : {format.file_name, format.sidecar})
    if (!name.empty())
      expect_golden(prefix + std::string(name), test::read_file(folder.path() / name));
}

void expect_golden_scene(std::string_view key, Patches patches, const std::string& prefix) {
  expect_golden_files(key, patches, prefix, cube_and_house());
}

/// City model formats have more to keep.
void expect_golden_model(std::string_view key) {
  expect_golden_files(key, Patches::ByObject, "", {test::rich_building(), cube_and_house()[0]});
}

TEST(Golden, Obj) { expect_golden_scene("obj", Patches::ByObject, ""); }
TEST(Golden, Stl) { expect_golden_scene("stl", Patches::ByObject, ""); }
TEST(Golden, StlByType) { expect_golden_scene("stl", Patches::ByType, "by_type."); }
TEST(Golden, BinaryStl) { expect_golden_scene("stl_binary", Patches::ByObject, ""); }
TEST(Golden, BinaryStlByType) { expect_golden_scene("stl_binary", Patches::ByType, "by_type."); }
TEST(Golden, Ply) { expect_golden_scene("ply", Patches::ByObject, ""); }
TEST(Golden, Vtu) { expect_golden_scene("vtu", Patches::ByObject, ""); }
TEST(Golden, Glb) { expect_golden_model("glb"); }
TEST(Golden, CityJsonSeq) { expect_golden_model("cityjsonseq"); }
TEST(Golden, CityGml2) { expect_golden_model("citygml2"); }
TEST(Golden, CityGml3) { expect_golden_model("citygml3"); }
TEST(Golden, CityJson) { expect_golden_model("cityjson"); }

TEST(Golden, Picture) {
  test::TemporaryFolder folder;
  auto writer = ReportWriter::create(folder.path(), {});
  for (const auto& building : cube_and_house()) ASSERT_TRUE(writer.value()->add({}, &building, {}));
  RunReport report;
  report.process = "export-for-simulation";
  report.rungs = {{"as_is", 2}};
  report.counts = {2, 2, 0, 0};
  ASSERT_TRUE(writer.value()->finish(report));
  expect_golden("picture.svg", test::read_file(folder.path() / "picture.svg"));
}

}  // namespace
}  // namespace citymesh
