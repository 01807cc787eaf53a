#include "core/write/gallery.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/write/findings.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

BuildingReport report_of(const std::string& gml_id, const std::string& rung,
                         double deviation_m = 0.01) {
  BuildingReport report;
  report.gml_id = gml_id;
  report.outcome = "delivered";
  report.rung = rung;
  report.deviation_max_m = deviation_m;
  report.issues_before = {{302, "", 4, Point3{2, 1, 1}}};
  return report;
}

SourceBody source_of(const BuildingBodies& building, std::size_t faces_left_out = 0) {
  const TriangleMesh& mesh = building.bodies[0].mesh;
  SourceBody source;
  source.gml_id = building.gml_id;
  source.shell = {mesh.points, mesh.faces, mesh.surface_ids};
  source.shell.faces.resize(mesh.faces.size() - faces_left_out);
  return source;
}

/// A house without its last face, and what became of it.
void add_house(Gallery& gallery, const BuildingReport& report) {
  auto building = test::building(report.gml_id, test::house(8, 6, 3, 5), report.rung);
  building.bodies[0].rung = report.rung;
  building.bodies[0].mesh.faces.back().made_by = report.rung;
  gallery.add(report, &building, std::vector{source_of(building, 1)});
}

std::size_t count_of(const std::string& text, std::string_view word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(Gallery, ShowsDefectsAndWhatIsNew) {
  Gallery gallery;
  add_house(gallery, report_of("house", "healed"));
  const std::string html = gallery.section();
  EXPECT_THAT(html, HasSubstr("before and after: house"));
  EXPECT_EQ(count_of(html, "<circle"), 1u) << "one place of a defect";
  EXPECT_EQ(count_of(html, "class=\"p"), 1u) << "one new face";
  EXPECT_THAT(html, HasSubstr("302"));
  EXPECT_THAT(html, HasSubstr("1 defect before, 0 after"));
}

TEST(Gallery, HasNoPictureOfWhatDidNotChange) {
  Gallery gallery;
  add_house(gallery, report_of("house", "as_is"));
  EXPECT_THAT(gallery.section(), IsEmpty());
}

TEST(Gallery, TheLowestRungComesFirstThenTheLargestDeviation) {
  Gallery gallery;
  add_house(gallery, report_of("little", "healed", 0.01));
  add_house(gallery, report_of("much", "healed", 0.09));
  add_house(gallery, report_of("block", "lod1_block", 0.001));
  const std::string html = gallery.section();
  EXPECT_LT(html.find("after: block"), html.find("after: much"));
  EXPECT_LT(html.find("after: much"), html.find("after: little"));
}

TEST(Gallery, KeepsTheWorstOfManyAndStaysSmall) {
  Gallery gallery;
  for (int i = 0; i < 300; ++i)
    add_house(gallery, report_of("b" + std::to_string(i), "healed", 0.001 * (i * 7 % 300)));
  const std::string html = gallery.section();
  EXPECT_EQ(count_of(html, "before and after:"), Gallery::kMaxPictures);
  EXPECT_THAT(html, HasSubstr("after: b257<")) << "deviates by 0.299 m";
  EXPECT_THAT(html, Not(HasSubstr("after: b0<")));
  EXPECT_THAT(html, HasSubstr("300 changed buildings"));
  EXPECT_LT(html.size(), 300'000u);
}

TEST(Gallery, ADroppedBuildingIsShownAsItCame) {
  Gallery gallery;
  auto report = report_of("lost", "");
  report.outcome = "dropped";
  report.reason = "not_healed";
  const auto building = test::building("lost", test::box(4, 3, 2));
  gallery.add(report, nullptr, std::vector{source_of(building, 2)});
  EXPECT_THAT(gallery.section(), HasSubstr("not_healed"));
}

TEST(Gallery, IdsOfTheDataAreEscaped) {
  Gallery gallery;
  add_house(gallery, report_of("<script>", "healed"));
  EXPECT_THAT(gallery.section(), Not(HasSubstr("<script>")));
}

TEST(Findings, AFaceIsFoundByItsSurfaceOrByACorner) {
  const auto building = test::building("house", test::house(8, 6, 3, 5));
  const Shell shell = source_of(building).shell;
  const auto styles = [&](const Issue& issue) { return face_findings(shell, std::vector{issue}); };

  const auto by_id = styles({203, "roof_south", 0.1});
  EXPECT_EQ(std::count(by_id.begin(), by_id.end(), style::kSound), 6);
  EXPECT_EQ(by_id[5], finding_style(203));
  const auto by_word = styles({102, "roof_south ring 0 (0 0 3)", 0});
  EXPECT_EQ(by_word[5], finding_style(102));
  const auto by_place = styles({302, "", 4, Point3{0, 0, 0}});
  EXPECT_EQ(std::count(by_place.begin(), by_place.end(), finding_style(302)), 3);
  const auto nowhere = styles({601, "", 0, Point3{99, 0, 0}});
  EXPECT_EQ(std::count(nowhere.begin(), nowhere.end(), style::kSound), 7);
}

TEST(Findings, TheGravestFamilyWins) {
  EXPECT_EQ(gravest({}), style::kSound);
  EXPECT_EQ(gravest(std::vector<Issue>{{203}, {302}, {102}}), finding_style(302));
  EXPECT_LT(finding_style(issue_code::kDanglingXlink), finding_style(101));
  EXPECT_GT(finding_style(601), finding_style(307));
}

}  // namespace
}  // namespace citymesh
