#include "core/reconstruct/share_space.h"

#include <gtest/gtest.h>

#include <set>
#include <variant>

#include "core/citymodel/grid.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/mesh/mesh.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::block;

/// A box standing on the ground, in metres.
Shell box(double x0, double y0, double x1, double y1, double height) {
  const Building building = block(x0, y0, x1, y1, height).done();
  return std::get<Gridded>(grid(building, building.geometries[0])).shell;
}

TriangleMesh mesh_of(const Shell& shell) { return std::get<TriangleMesh>(mesh(shell)); }

double volume(const Shell& shell) {
  const TriangleMesh mesh = mesh_of(shell);
  return volume_m3(mesh.points, mesh.triangles);
}

void expect_sound(const Shell& shell) {
  const TriangleMesh mesh = mesh_of(shell);
  const auto failures = check_shell(mesh.points, mesh.triangles, {});
  EXPECT_TRUE(failures.empty()) << failures[0].gate << " " << failures[0].where;
}

/// Area of the faces that the boundary of one body has the other way round in the other.
double common_area(const Shell& a, const Shell& b) {
  using Corners = std::set<GridPoint>;
  const auto area = [](const Shell& shell, const Face& face) {
    double sum = 0;
    Shell alone{shell.points, {face}, shell.surface_ids};
    const TriangleMesh mesh = mesh_of(alone);
    sum += area_m2(mesh.points, mesh.triangles);
    return sum;
  };
  const auto corners = [](const Shell& shell, const Face& face) {
    Corners result;
    for (const std::uint32_t v : face.rings[0]) result.insert(shell.points[v]);
    return result;
  };
  std::set<Corners> of_a;
  for (const Face& face : a.faces) of_a.insert(corners(a, face));
  double sum = 0;
  for (const Face& face : b.faces)
    if (of_a.contains(corners(b, face))) sum += area(b, face);
  return sum;
}

SharedOut shared(std::vector<Shell> bodies) {
  auto out = share_space(bodies, {}, {});
  EXPECT_TRUE(out);
  return out ? std::move(*out) : SharedOut{};
}

TEST(ShareSpace, TheLargerOfTwoBoxesGivesWayAndTheyTouch) {
  const SharedOut out = shared({box(0, 0, 10, 10, 10), box(8, 2, 14, 6, 5)});
  ASSERT_EQ(out.bodies.size(), 2u);
  for (const Shell& body : out.bodies) expect_sound(body);
  EXPECT_NEAR(volume(out.bodies[0]), 1000 - 40, 1e-6);
  EXPECT_NEAR(volume(out.bodies[1]), 120, 1e-6) << "the smaller stays whole";
  ASSERT_EQ(out.spaces.size(), 1u);
  EXPECT_EQ(out.spaces[0].from, 0u);
  EXPECT_EQ(out.spaces[0].to, 1u);
  EXPECT_NEAR(out.spaces[0].volume_m3, 40, 1e-6);
  // Two sides of 2 m, one of 4 m and the roof of the niche.
  EXPECT_NEAR(common_area(out.bodies[0], out.bodies[1]), 2 * 10 + 20 + 8, 1e-6);
}

TEST(ShareSpace, OfAChainOfThreeEveryPlaceHasOneOwner) {
  const SharedOut out = shared({box(0, 0, 10, 10, 10), box(8, 0, 16, 10, 9), box(14, 1, 20, 9, 8)});
  ASSERT_EQ(out.bodies.size(), 3u);
  double sum = 0;
  for (const Shell& body : out.bodies) {
    expect_sound(body);
    sum += volume(body);
  }
  EXPECT_NEAR(sum, 1000 + 720 + 384 - 2 * 10 * 9 - 2 * 8 * 8, 1e-6) << "that of the union";
  const auto again = shared_space(out.bodies, {}, {});
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->empty());
}

TEST(ShareSpace, APartInsideAnotherStaysWholeInANiche) {
  const SharedOut out = shared({box(0, 0, 10, 10, 10), box(3, 3, 5, 5, 4)});
  for (const Shell& body : out.bodies) expect_sound(body);
  EXPECT_NEAR(volume(out.bodies[0]), 1000 - 16, 1e-6);
  EXPECT_NEAR(volume(out.bodies[1]), 16, 1e-6);
}

TEST(ShareSpace, OfTwoThatAreTheSameTheFirstHasAll) {
  const SharedOut out = shared({box(0, 0, 10, 10, 10), box(0, 0, 10, 10, 10)});
  ASSERT_EQ(out.bodies.size(), 2u);
  EXPECT_NEAR(volume(out.bodies[0]), 1000, 1e-6);
  EXPECT_TRUE(out.bodies[1].faces.empty());
  ASSERT_EQ(out.spaces.size(), 1u);
  EXPECT_EQ(out.spaces[0].from, 1u);
}

TEST(ShareSpace, BodiesThatOnlyTouchShareNothing) {
  const std::vector<Shell> bodies{box(0, 0, 10, 10, 10), box(10, 2, 14, 6, 5)};
  const auto spaces = shared_space(bodies, {}, {});
  ASSERT_TRUE(spaces);
  EXPECT_TRUE(spaces->empty());
}

TEST(ShareSpace, FacesThatAreNewSayThatTheyAre) {
  const SharedOut out = shared({box(0, 0, 10, 10, 10), box(8, 2, 14, 6, 5)});
  std::size_t added = 0;
  for (const Face& face : out.bodies[0].faces) added += face.added ? 1 : 0;
  EXPECT_GE(added, 4u) << "the niche";
  for (const Face& face : out.bodies[1].faces) EXPECT_FALSE(face.added);
}

}  // namespace
}  // namespace citymesh
