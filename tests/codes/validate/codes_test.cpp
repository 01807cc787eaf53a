// Every code is found in the smallest building that has its defect, and only there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/citymodel/grid.h"
#include "core/validate/neighbours.h"
#include "core/validate/validate.h"
#include "tests/codes/validate/cases.h"

namespace citymesh {
namespace {

using testing::block;
using testing::box;
using testing::Case;
using testing::cases;
using testing::Draw;

std::vector<Issue> issues(const Building& building) {
  return validate(building, building.geometries[0], {}).issues;
}

std::set<int> codes(const std::vector<Issue>& issues) {
  std::set<int> found;
  for (const Issue& issue : issues) {
    EXPECT_NE(issue_name(issue.code), "UNKNOWN_ISSUE");
    found.insert(issue.code);
  }
  return found;
}

TEST(Codes, EveryDefectHasItsCodeAndNoOther) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
    EXPECT_EQ(codes(issues(c.defective)), std::set{c.code});
  }
}

TEST(Codes, WhatIsLikeADefectButSoundHasNone) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
    EXPECT_EQ(codes(issues(c.sound)), std::set<int>{});
  }
}

TEST(Codes, EveryNumberOfTheTableThatIsCheckedHereHasACase) {
  std::set<int> covered{601, issue_code::kBuildingsOverlap, issue_code::kNearDuplicateWall,
                        issue_code::kNarrowGap};  // below
  for (const Case& c : cases()) covered.insert(c.code);
  for (int code = 101; code < 700; ++code)
    if (issue_name(code) != "UNKNOWN_ISSUE") {
      EXPECT_TRUE(covered.contains(code)) << code;
    }
}

TEST(Codes, EveryDefectIsPlaced) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
    if (c.code == 902 || c.code == 301 || c.code == issue_code::kCoordinateOutOfRange) continue;
    for (const Issue& issue : issues(c.defective)) {
      EXPECT_FALSE(issue.where.empty());
      ASSERT_TRUE(issue.at);
      EXPECT_GE(issue.at->x, -1);
      EXPECT_LE(issue.at->x, 30);
      EXPECT_GE(issue.at->z, -3);
      EXPECT_LE(issue.at->z, 10);
    }
  }
}

TEST(Codes, MeasuresAreWhatTheyAreSaidToBe) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
    const auto found = issues(c.defective);
    ASSERT_FALSE(found.empty());
    if (c.code == 203) {
      EXPECT_NEAR(found[0].measured, 0.0125, 0.0001);
    }
    if (c.code == 204) {
      EXPECT_NEAR(found[0].measured, 38.66, 0.1);
    }
    if (c.code == 302) {
      EXPECT_EQ(found[0].measured, 4);
    }
    if (c.code == 404) {
      EXPECT_EQ(found[0].measured, 2);
    }
  }
}

TEST(Codes, TheSameShellOnTheGridHasTheSameFindings) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
    const auto type = c.defective.geometries[0].type;
    // What the grid takes away (rings that close, points too far) and what no single solid has.
    if (type != GeometryType::Solid || c.code == 103 || c.code > 900) continue;
    const auto gridded = grid(c.defective, c.defective.geometries[0]);
    ASSERT_TRUE(std::holds_alternative<Gridded>(gridded));
    const auto found = codes(validate(std::get<Gridded>(gridded).shell, {}));
    // Cavities that touch or are the same cannot be told apart there.
    if (c.title != "cavities that overlap" && c.title != "a cavity twice") {
      EXPECT_EQ(found, std::set{c.code});
    }
  }
}

TEST(Codes, WhatTheReaderAssembledSaysSo) {
  auto open = block(0, 0, 10, 8, 6);
  open.geometry().polygons.pop_back();
  const auto assembled = issues(open.done());
  ASSERT_EQ(assembled.size(), 1U);
  EXPECT_EQ(assembled[0].code, 302);
  EXPECT_TRUE(assembled[0].assembled);
  EXPECT_FALSE(issues(testing::solid(open)).at(0).assembled);
}

TEST(Codes, AHigherLevelIsOnlyLookedAtWhenTheLowerOnesAreSound) {
  Building building = testing::solid(block(0, 0, 10, 8, 6));
  Ring& ring = building.geometries[0].polygons[0].rings[0];
  std::swap(ring[1], ring[2]);                           // 104
  building.geometries[0].solids[0].exterior.pop_back();  // would be 302
  EXPECT_EQ(codes(issues(building)), std::set{104});
}

TEST(Codes, WhatOccursVeryOftenIsCounted) {
  Draw draw;
  for (int i = 0; i < 250; ++i)
    draw.face(SurfaceType::WallSurface, {{{1.0 * i, 0, 0}, {1.0 * i, 1, 0}}});
  const auto found = issues(draw.done());
  ASSERT_EQ(found.size(), 101U);
  EXPECT_EQ(found.back().code, 101);
  EXPECT_EQ(found.back().measured, 150);
}

TEST(Codes, ATJunctionIsNamedAsTheReasonOfAHole) {
  auto draw = block(0, 0, 10, 8, 6);
  draw.geometry().polygons.pop_back();
  draw.face(SurfaceType::RoofSurface, {{{0, 0, 6}, {5, 0, 6}, {10, 0, 6}, {10, 8, 6}, {0, 8, 6}}});
  const auto found = issues(testing::solid(draw));
  ASSERT_EQ(codes(found), std::set{302});
  EXPECT_THAT(found[0].where, ::testing::HasSubstr("(5.0000 0.0000 6.0000) lies on an edge"));
}

// ---- several solids ----------------------------------------------------------------------------

std::vector<SolidBody> bodies(const std::vector<Draw>& draws) {
  std::vector<SolidBody> all;
  for (Draw draw : draws) {
    const Building building = testing::solid(draw);
    auto validated = validate(building, building.geometries[0], {});
    EXPECT_EQ(validated.solids.size(), 1U);
    all.push_back(validated.solids.at(0));
  }
  return all;
}

std::set<int> part_codes(const std::vector<Draw>& draws) {
  const std::vector<SolidBody> all = bodies(draws);
  std::vector<const SolidBody*> parts;
  for (const SolidBody& body : all) parts.push_back(&body);
  return codes(validate_parts(parts));
}

TEST(Codes, Code601_PartsOverlap) {
  const Draw block_ = block(0, 0, 10, 8, 6);
  EXPECT_EQ(part_codes({block_, box(9, 2, 0, 14, 6, 4)}), std::set{601});
  EXPECT_EQ(part_codes({block_, box(10, 2, 0, 14, 6, 4)}), std::set<int>{});
  // Around a corner no plane stands between them.
  Draw angle;
  const std::vector<Point3> plan{{10, -2, 0}, {12, -2, 0}, {12, 10, 0},
                                 {-2, 10, 0}, {-2, 8, 0},  {10, 8, 0}};
  angle.ground(plan).walls(plan, 4).flat_roof(plan, 4);
  EXPECT_EQ(part_codes({block_, angle}), std::set<int>{});
  // On the same plan, one higher than the other: no corner of one lies inside the other.
  EXPECT_EQ(part_codes({block_, block(0, 0, 10, 8, 9)}), std::set{601});
}

std::vector<Issue> between(const Draw& first, const Draw& second) {
  Neighbours neighbours({});
  neighbours.add("first", bodies({first}));
  neighbours.add("second", bodies({second}));
  EXPECT_TRUE(neighbours.issues_of(0).empty());
  return neighbours.issues_of(1);
}

TEST(Codes, C116_BuildingsOverlap) {
  const auto found = between(block(0, 0, 10, 8, 6), box(9.5, 2, 0, 14, 6, 4));
  ASSERT_EQ(codes(found), std::set{issue_code::kBuildingsOverlap});
  EXPECT_EQ(found[0].where, "first");
  ASSERT_TRUE(found[0].at);
  EXPECT_GE(found[0].at->x, 9.5);
  EXPECT_LE(found[0].at->x, 10);
  EXPECT_TRUE(between(block(0, 0, 10, 8, 6), block(10, 0, 14, 8, 6)).empty());
}

TEST(Codes, C117_NearDuplicateWall) {
  const auto found = between(block(0, 0, 10, 8, 6), block(10.005, 0, 14, 8, 6));
  ASSERT_EQ(codes(found), std::set{issue_code::kNearDuplicateWall});
  EXPECT_NEAR(found[0].measured, 0.005, 1e-9);
  EXPECT_THAT(found[0].where, ::testing::HasSubstr("(48.00 m²)"));
}

TEST(Codes, C118_NarrowGap) {
  const auto found = between(block(0, 0, 10, 8, 6), block(10.05, 0, 14, 8, 6));
  ASSERT_EQ(codes(found), std::set{issue_code::kNarrowGap});
  EXPECT_NEAR(found[0].measured, 0.05, 1e-9);
  EXPECT_TRUE(between(block(0, 0, 10, 8, 6), block(10.2, 0, 14, 8, 6)).empty());
}

// ---- invariance --------------------------------------------------------------------------------

TEST(Codes, MovingTheModelByManyStepsChangesNoFinding) {
  for (const Case& c : cases()) {
    if (c.code == issue_code::kCoordinateOutOfRange) continue;
    for (const Building& building : {c.defective, c.sound}) {
      SCOPED_TRACE(issue_code_text(c.code) + " " + c.title);
      const Point3 shift{-131072, 65536, 4096};  // whole metres: many steps, exact in doubles
      Building moved = building;
      for (Point3& p : moved.geometries[0].points)
        p = {p.x + shift.x, p.y + shift.y, p.z + shift.z};
      const auto here = issues(building), there = issues(moved);
      ASSERT_EQ(here.size(), there.size());
      for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_EQ(here[i].code, there[i].code);
        EXPECT_EQ(here[i].measured, there[i].measured);
        ASSERT_EQ(here[i].at.has_value(), there[i].at.has_value());
        if (!here[i].at) continue;
        EXPECT_NEAR(here[i].at->x + shift.x, there[i].at->x, 1e-6);
        EXPECT_NEAR(here[i].at->y + shift.y, there[i].at->y, 1e-6);
        EXPECT_NEAR(here[i].at->z + shift.z, there[i].at->z, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace citymesh
