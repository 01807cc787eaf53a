#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/gates/gates.h"
#include "core/write/styles.h"
#include "core/write/write.h"
#include "tests/unit/write/files.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

Scene scene_of(const std::string& process) {
  return {{"EPSG:25833"}, {391000, 5820000, 0}, process};
}

/// errors.glb of a house with a bad roof and a sound box.
class ErrorsGlb : public ::testing::Test {
 protected:
  void write(const std::string& process) {
    auto writer = ReportWriter::create(folder_.path(), scene_of(process));
    ASSERT_TRUE(writer);
    const auto house = test::house(8, 6, 3, 5);
    SourceBody bad{"bad", "b_bad", {house.points, house.faces, house.surface_ids}, {}};
    bad.issues = {{203, "roof_south", 0.2, Point3{4, 1.5, 4}}, {302, "", 4, Point3{8, 3, 1}}};
    const auto box = test::box(4, 3, 2, {20, 0, 0});
    SourceBody good{"good", "b_good", {box.points, box.faces, box.surface_ids}, {}};
    BuildingReport report;
    report.gml_id = "pair";
    report.outcome = "delivered";
    ASSERT_TRUE(writer.value()->add(report, nullptr, std::vector{bad, good}));
    ASSERT_TRUE(writer.value()->finish({}));
  }

  nlohmann::json document() const {
    const std::string bytes = test::read_file(folder_.path() / "errors.glb");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return nlohmann::json::parse(bytes.substr(20, length));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ErrorsGlb, ANodePerBuildingHasItsIssues) {
  write("validate");
  const auto json = document();
  ASSERT_EQ(json["nodes"].size(), 2u);
  const auto& extras = json["nodes"][0]["extras"];
  EXPECT_EQ(json["nodes"][0]["name"], "b_bad");
  EXPECT_EQ(extras["gml_id"], "bad");
  EXPECT_EQ(extras["building"], "pair");
  ASSERT_EQ(extras["issues"].size(), 2u);
  EXPECT_EQ(extras["issues"][0]["code"], "203");
  EXPECT_EQ(extras["issues"][0]["at"], nlohmann::json({4, 1.5, 4}));
  EXPECT_TRUE(json["nodes"][1]["extras"]["issues"].empty());
}

TEST_F(ErrorsGlb, FacesAndMarksHaveTheColourOfTheirFamilyAndTheRestIsGrey) {
  write("heal");
  const auto json = document();
  const auto triangles = [&](std::size_t mesh, const std::string& material) {
    std::size_t count = 0;
    for (const auto& primitive : json["meshes"][mesh]["primitives"])
      if (json["materials"][primitive["material"].get<std::size_t>()]["name"] == material)
        count +=
            json["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() /
            3;
    return count;
  };
  const std::string sound(kStyles[style::kSound].meaning);
  EXPECT_EQ(triangles(0, std::string(kStyles[finding_style(203)].meaning)), 2u + 8u)
      << "the roof and its mark";
  EXPECT_EQ(triangles(0, std::string(kStyles[finding_style(302)].meaning)), 8u)
      << "a mark that lies at no corner";
  EXPECT_EQ(triangles(0, sound), 2u * 4u + 2u * 3u) << "the other faces";
  EXPECT_EQ(triangles(1, sound), 12u);
  for (const auto& material : json["materials"]) EXPECT_EQ(material["doubleSided"], true);
}

TEST_F(ErrorsGlb, IsReadBackAsGlb) {
  write("validate");
  std::vector<std::string> names;
  const auto parsed =
      parse_file("glb", folder_.path() / "errors.glb", [&](ParsedBody&& body) -> Result<void> {
        names.push_back(body.name);
        EXPECT_FALSE(body.triangles.empty());
        return {};
      });
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(names, (std::vector<std::string>{"b_bad", "b_good"}));
}

TEST_F(ErrorsGlb, BelongsToProcessesThatShowDefects) {
  write("export-for-simulation");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "errors.glb"));
  EXPECT_EQ(test::files_in(folder_.path()), 3u);
}

}  // namespace
}  // namespace citymesh
