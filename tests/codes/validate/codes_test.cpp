// One building per code, with exactly one defect; a sound building has none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/citymodel/grid.h"
#include "core/validate/validate.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::block;
using testing::Draw;
using testing::rectangle;

std::vector<int> codes(const Building& building) {
  const auto gridded = grid(building, building.geometries[0]);
  if (const Issue* issue = std::get_if<Issue>(&gridded)) return {issue->code};
  std::vector<int> found;
  for (const Issue& issue : validate(std::get<Gridded>(gridded).shell, {})) {
    EXPECT_NE(issue_name(issue.code), "UNKNOWN_ISSUE");
    found.push_back(issue.code);
  }
  return found;
}

void reverse(Building& building, std::size_t polygon) {
  auto& ring = building.geometries[0].polygons[polygon].rings[0];
  std::reverse(ring.begin(), ring.end());
}

TEST(Codes, ASoundBuildingHasNone) {
  EXPECT_THAT(codes(block(0, 0, 10, 8, 6).done()), ::testing::IsEmpty());
}

TEST(Codes, Code101_TooFewPoints) {
  auto draw = block(0, 0, 10, 8, 6);
  draw.face(SurfaceType::WallSurface, {{{0, 0, 0}, {10, 0, 0}}});
  EXPECT_THAT(codes(draw.done()), ::testing::Contains(101));
}

TEST(Codes, Code102_ConsecutivePointsSame) {
  auto building = block(0, 0, 10, 8, 6).done();
  Ring& ring = building.geometries[0].polygons[0].rings[0];
  ring.insert(ring.begin(), ring.front());
  EXPECT_EQ(codes(building), std::vector{102});
}

TEST(Codes, Code104_RingSelfIntersection) {
  auto building = block(0, 0, 10, 8, 6).done();
  Ring& ring = building.geometries[0].polygons[0].rings[0];
  std::swap(ring[1], ring[2]);
  EXPECT_THAT(codes(building), ::testing::Contains(104));
}

TEST(Codes, Code201_IntersectionOfRings) {
  auto draw = block(0, 0, 10, 8, 6);
  draw.geometry().polygons.pop_back();
  const auto roof = rectangle(0, 0, 10, 8, 6);
  draw.face(SurfaceType::RoofSurface, {roof, {{8, 2, 6}, {8, 4, 6}, {12, 3, 6}}});
  EXPECT_THAT(codes(draw.done()), ::testing::Contains(201));
}

TEST(Codes, Code203_NonPlanarPolygon) {
  Draw draw;
  const auto base = rectangle(0, 0, 10, 8);
  draw.ground(base);
  const double top[4] = {6, 6, 6.2, 6};
  std::vector<Point3> roof;
  for (std::size_t i = 0; i < 4; ++i) roof.push_back({base[i].x, base[i].y, top[i]});
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    draw.face(SurfaceType::WallSurface, {{base[i], base[j], roof[j], roof[i]}});
  }
  draw.face(SurfaceType::RoofSurface, {roof});
  EXPECT_EQ(codes(draw.done()), std::vector{203});
}

TEST(Codes, Code301_TooFewPolygons) {
  Draw draw;
  draw.ground(rectangle(0, 0, 10, 8));
  EXPECT_THAT(codes(draw.done()), ::testing::Contains(301));
}

TEST(Codes, Code302_ShellNotClosed) {
  auto building = block(0, 0, 10, 8, 6).done();
  building.geometries[0].polygons.pop_back();
  EXPECT_EQ(codes(building), std::vector{302});
}

TEST(Codes, Code303_NonManifoldEdge) {
  auto draw = block(0, 0, 10, 8, 6);
  const auto east = rectangle(10, 8, 14, 12);
  draw.ground(east).walls(east, 6).flat_roof(east, 6);
  EXPECT_EQ(codes(draw.done()), std::vector{303});
}

TEST(Codes, Code307_PolygonWrongOrientation) {
  auto building = block(0, 0, 10, 8, 6).done();
  reverse(building, 0);
  EXPECT_EQ(codes(building), std::vector{307});
}

TEST(Codes, Code902_EmptyPrimitive) {
  Building building = Draw().done();
  EXPECT_EQ(codes(building), std::vector{902});
}

TEST(Codes, C105_CoordinateOutOfRange) {
  auto building = block(0, 0, 10, 8, 6).done();
  building.geometries[0].points[0].x = 3e5;
  EXPECT_EQ(codes(building), std::vector{issue_code::kCoordinateOutOfRange});
}

}  // namespace
}  // namespace citymesh
