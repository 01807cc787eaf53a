#include "core/write/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>

#include "core/write/painter.h"
#include "tests/unit/write/scene.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

bool is_well_formed(const std::string& xml) {
  xmlDoc* document = xmlReadMemory(xml.data(), static_cast<int>(xml.size()), "picture.svg", nullptr,
                                   XML_PARSE_NONET | XML_PARSE_HUGE);
  const bool good = document != nullptr;
  xmlFreeDoc(document);
  return good;
}

std::string picture_of(const std::vector<BuildingBodies>& city, const RunReport& report = {}) {
  Picture picture;
  for (const auto& building : city) picture.add(building);
  return picture.svg(report);
}

std::size_t count_of(const std::string& text, std::string_view word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(Picture, IsWellFormedXmlWithHostileTexts) {
  RunReport report;
  report.process = "<script>&\"\x01";
  report.crs.id = "<!DOCTYPE";
  report.rungs = {{"as_is", 3}, {"<b>", 1}};
  EXPECT_TRUE(is_well_formed(picture_of(test::synthetic_city(1, 2), report)));
  EXPECT_TRUE(is_well_formed(picture_of({}, report)));
}

TEST(Picture, DrawsNoDiagonalsOfTriangulatedFaces) {
  const auto faces = drawn_faces(test::box(4, 3, 2));
  ASSERT_EQ(faces.size(), 4u) << "south, west and roof are seen, east is in the sun";
  for (const DrawnFace& face : faces) {
    ASSERT_EQ(face.rings.size(), 1u);
    EXPECT_EQ(face.rings[0].size(), 4u);
    EXPECT_EQ(face.triangles.size(), 2u);
  }
}

TEST(Picture, KeepsTheHoleOfACourtyardRoof) {
  std::size_t with_hole = 0;
  auto mesh = test::courtyard(30, 30, 8, 10);
  for (const DrawnFace& face : drawn_faces(mesh)) with_hole += face.rings.size() == 2 ? 1u : 0u;
  EXPECT_EQ(with_hole, 1u);
}

TEST(Picture, StaysBoundedForLargeCities) {
  RunReport report;
  const auto city = test::synthetic_city(60, 60);
  const std::string svg = picture_of(city, report);
  EXPECT_THAT(svg, HasSubstr("shown as blocks"));
  EXPECT_LT(count_of(svg, "<path"), 2 * Picture::kMaxTriangles);
  EXPECT_LT(svg.size(), 10u << 20);
}

TEST(Picture, HasTheSameBytesEveryTime) {
  EXPECT_EQ(picture_of(test::synthetic_city(3, 3)), picture_of(test::synthetic_city(3, 3)));
}

// ---- painter's order ----

std::vector<PaintFace> paint_faces(const std::vector<TriangleMesh>& meshes) {
  std::vector<PaintFace> faces;
  const auto view = [](const DrawnFace::Corner& c) {
    return to_view(
        {c[0] / kGridStepsPerMetre, c[1] / kGridStepsPerMetre, c[2] / kGridStepsPerMetre});
  };
  for (std::uint32_t i = 0; i < meshes.size(); ++i)
    for (const DrawnFace& drawn : drawn_faces(meshes[i])) {
      PaintFace face;
      face.normal = to_view(drawn.normal);
      if (towards_viewer(face.normal) <= 1e-6) continue;
      face.paint = i;
      for (const auto& ring : drawn.rings) {
        auto& corners = face.rings.emplace_back();
        for (const auto& corner : ring) corners.push_back(view(corner));
      }
      for (const auto& t : drawn.triangles)
        face.triangles.push_back({view(t[0]), view(t[1]), view(t[2])});
      faces.push_back(std::move(face));
    }
  return faces;
}

/// Depth of the triangle seen at a place of the screen; nothing where it is not there.
std::optional<double> depth_at(const std::array<Point3, 3>& t, double x, double y) {
  const auto cross = [](const Point3& a, const Point3& b, double px, double py) {
    return (b.x - a.x) * (py - screen_y(a)) - (screen_y(b) - screen_y(a)) * (px - a.x);
  };
  const double a = cross(t[1], t[2], x, y), b = cross(t[2], t[0], x, y),
               c = cross(t[0], t[1], x, y);
  if (a < 1e-6 || b < 1e-6 || c < 1e-6) return std::nullopt;
  const double sum = a + b + c;
  return (a * depth(t[0]) + b * depth(t[1]) + c * depth(t[2])) / sum;
}

/// Looks through the screen on a grid of places: what is painted last must be what is nearest.
void expect_nearest_on_top(const std::vector<TriangleMesh>& meshes, double step) {
  const auto faces = paint_faces(meshes);
  const auto order = painting_order(faces);
  double min_x = 1e9, max_x = -1e9, min_y = 1e9, max_y = -1e9;
  for (const PaintFace& face : faces)
    for (const Point3& p : face.rings[0]) {
      min_x = std::min(min_x, p.x);
      max_x = std::max(max_x, p.x);
      min_y = std::min(min_y, screen_y(p));
      max_y = std::max(max_y, screen_y(p));
    }
  std::size_t wrong = 0, seen = 0;
  for (double x = min_x + step / 3; x < max_x; x += step)
    for (double y = min_y + step / 3; y < max_y; y += step) {
      std::optional<double> top, nearest;
      for (const PaintStep& painted : order) {
        const auto& triangles = faces[painted.face].triangles;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
          if (painted.triangle >= 0 && static_cast<std::size_t>(painted.triangle) != t) continue;
          if (const auto d = depth_at(triangles[t], x, y)) {
            top = d;
            nearest = nearest ? std::min(*nearest, *d) : *d;
          }
        }
      }
      if (!top) continue;
      ++seen;
      if (*top > *nearest + 0.05) ++wrong;
    }
  EXPECT_GT(seen, 50u);
  EXPECT_EQ(wrong, 0u) << "of " << seen;
}

TEST(PaintingOrder, PutsNearOverFarForHousesInARow) {
  expect_nearest_on_top({test::box(10, 10, 8), test::box(10, 10, 20, {0, 12, 0}),
                         test::house(10, 10, 5, 9, {12, 3, 0}), test::box(4, 30, 30, {24, 0, 0})},
                        0.7);
}

TEST(PaintingOrder, IsRightForATowerInACourtyard) {
  expect_nearest_on_top({test::courtyard(40, 40, 8, 12), test::box(8, 8, 40, {16, 16, 0}),
                         test::box(5, 5, 4, {10, 10, 0})},
                        0.7);
}

TEST(PaintingOrder, IsRightForThreeBlocksThatOverlapInACircle) {
  // Long walls, each behind the next: no order of whole faces by their middles is right.
  expect_nearest_on_top({test::box(40, 3, 10), test::box(3, 40, 10, {42, -30, 0}),
                         test::box(30, 3, 25, {8, -12, 0}), test::box(3, 20, 6, {-5, -4, 0})},
                        0.6);
}

TEST(PaintingOrder, IsRightForAWholeCity) {
  std::vector<TriangleMesh> meshes;
  for (auto& building : test::synthetic_city(2, 3))
    meshes.push_back(std::move(building.bodies[0].mesh));
  expect_nearest_on_top(meshes, 3.1);
}

}  // namespace
}  // namespace citymesh
