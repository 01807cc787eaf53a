#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/mesh_checker/check_body.h"
#include "tests/support/mesh_checker/read_mesh.h"

namespace mesh_checker {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct Box {
  Point low{0, 0, 0};
  Point high{10, 8, 6};
  bool inward = false;
  std::size_t triangles = 12;  // of them, that many are written
};

/// Corner i of a box: bit 0 is x, bit 1 is y, bit 2 is z.
Point corner(const Box& box, std::size_t i) {
  return {(i & 1 ? box.high : box.low)[0], (i & 2 ? box.high : box.low)[1],
          (i & 4 ? box.high : box.low)[2]};
}

constexpr Triangle kBox[] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                             {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

std::string vertex(const char* key, const Point& p) {
  return std::string(key) + " " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
         std::to_string(p[2]) + "\n";
}

std::string facet(const Point& a, const Point& b, const Point& c) {
  return " facet normal 0 0 0\n  outer loop\n" + vertex("vertex", a) + vertex("vertex", b) +
         vertex("vertex", c) + "  endloop\n endfacet\n";
}

std::string facets(const Box& box) {
  std::string text;
  for (std::size_t t = 0; t < box.triangles; ++t) {
    auto [a, b, c] = kBox[t];
    if (box.inward) std::swap(b, c);
    text += facet(corner(box, a), corner(box, b), corner(box, c));
  }
  return text;
}

std::string solid(const std::string& name, const std::string& facets) {
  return "solid " + name + "\n" + facets + "endsolid " + name + "\n";
}

Body only_body(const std::string& facets) {
  auto bodies = read_stl(solid("b_1__WallSurface", facets));
  EXPECT_THAT(bodies, SizeIs(1));
  return bodies.at(0);
}

std::vector<std::string> judged(const std::string& facets) { return check(only_body(facets)); }

TEST(MeshChecker, AcceptsAClosedBox) {
  const Body body = only_body(facets({}));
  EXPECT_THAT(check(body), IsEmpty());
  EXPECT_THAT(body.points, SizeIs(8));
  EXPECT_DOUBLE_EQ(signed_volume_m3(body), 480);
}

TEST(MeshChecker, AcceptsABoxFarFromTheOrigin) {
  EXPECT_THAT(judged(facets({{390997.7, 5817682.6, 32.7}, {391007.7, 5817690.6, 40.1}})),
              IsEmpty());
}

TEST(MeshChecker, FindsAMissingTriangle) {
  EXPECT_THAT(judged(facets({.triangles = 11})), Contains(HasSubstr("3 open edges")));
}

TEST(MeshChecker, FindsATriangleThatIsTurnedAround) {
  const auto text = facets({.triangles = 11}) + facet(corner({}, 1), corner({}, 5), corner({}, 7));
  EXPECT_THAT(judged(text), Contains(HasSubstr("oriented against each other")));
}

TEST(MeshChecker, FindsABoxThatIsInsideOut) {
  EXPECT_THAT(judged(facets({.inward = true})), Contains(HasSubstr("not oriented outward")));
}

TEST(MeshChecker, FindsATJunction) {
  // The top is split at the middle of one edge, the wall below it is not.
  const Box box;
  std::string text;
  for (std::size_t t = 0; t < 12; ++t) {
    if (t == 2) continue;  // 4 5 7
    const auto [a, b, c] = kBox[t];
    text += facet(corner(box, a), corner(box, b), corner(box, c));
  }
  const Point middle{5, 0, 6};
  text += facet(corner(box, 4), middle, corner(box, 7));
  text += facet(middle, corner(box, 5), corner(box, 7));
  EXPECT_THAT(judged(text), Contains(HasSubstr("open edges")));
}

TEST(MeshChecker, FindsADuplicateTriangle) {
  EXPECT_THAT(judged(facets({}) + facets({.triangles = 1})),
              Contains(HasSubstr("more than two triangles")));
}

TEST(MeshChecker, FindsTwoBoxesThatShareAnEdge) {
  EXPECT_THAT(judged(facets({}) + facets({{10, 8, 0}, {20, 16, 6}})),
              Contains(HasSubstr("more than two triangles")));
}

TEST(MeshChecker, FindsTwoBoxesThatShareAVertex) {
  EXPECT_THAT(judged(facets({}) + facets({{10, 8, 6}, {20, 16, 12}})),
              Contains(HasSubstr("more than one fan")));
}

TEST(MeshChecker, FindsTwoBoxesThatPassThroughEachOther) {
  EXPECT_THAT(judged(facets({}) + facets({{5, 4, 3}, {15, 12, 9}})),
              Contains(HasSubstr("intersects itself")));
}

TEST(MeshChecker, FindsTwoBoxesThatTouchWithinAFace) {
  EXPECT_THAT(judged(facets({}) + facets({{10, 2, 2}, {20, 4, 4}})),
              Contains(HasSubstr("intersects itself")));
}

TEST(MeshChecker, AcceptsACavityThatFacesInward) {
  EXPECT_THAT(judged(facets({}) + facets({{2, 2, 2}, {4, 4, 4}, true})), IsEmpty());
}

TEST(MeshChecker, FindsACavityThatFacesOutward) {
  EXPECT_THAT(judged(facets({}) + facets({{2, 2, 2}, {4, 4, 4}})),
              Contains(HasSubstr("not oriented inward")));
}

TEST(MeshChecker, FindsTrianglesLowerThanAMillimetre) {
  EXPECT_THAT(judged(facets({{0, 0, 0}, {10, 8, 0.0009}})), Contains(HasSubstr("8 degenerate")));
  EXPECT_THAT(judged(facets({{0, 0, 0}, {10, 8, 0.001}})), IsEmpty());
}

TEST(MeshChecker, FindsATriangleWithARepeatedCorner) {
  EXPECT_THAT(judged(facets({}) + facet({0, 0, 0}, {0, 0, 0}, {10, 8, 6})),
              Contains(HasSubstr("1 degenerate")));
}

TEST(MeshCheckerStl, TakesThePartBeforeTheLastSeparatorAsTheBody) {
  const Box box;
  std::string roof, wall;
  for (std::size_t t = 0; t < 12; ++t) {
    const auto [a, b, c] = kBox[t];
    (t < 4 ? roof : wall) += facet(corner(box, a), corner(box, b), corner(box, c));
  }
  const auto bodies = read_stl(solid("a__b__RoofSurface", roof) + solid("a__b__WallSurface", wall) +
                               solid("c__RoofSurface", facets({})));
  ASSERT_THAT(bodies, SizeIs(2));
  EXPECT_EQ(bodies[0].name, "a__b");
  EXPECT_THAT(check(bodies[0]), IsEmpty());
  EXPECT_EQ(bodies[1].name, "c");
  EXPECT_THAT(check(bodies[1]), IsEmpty());
}

TEST(MeshCheckerStl, NeverWeldsAcrossBodies) {
  const auto bodies =
      read_stl(solid("a__WallSurface", facets({})) + solid("b__WallSurface", facets({})));
  ASSERT_THAT(bodies, SizeIs(2));
  EXPECT_THAT(check(bodies[0]), IsEmpty());
  EXPECT_THAT(check(bodies[1]), IsEmpty());
}

TEST(MeshCheckerStl, FindsABodyThatComesTwice) {
  const auto bodies =
      read_stl(solid("a__WallSurface", facets({})) + solid("b__WallSurface", facets({})) +
               solid("a__WallSurface", facets({{20, 0, 0}, {30, 8, 6}})));
  ASSERT_THAT(bodies, SizeIs(3));
  EXPECT_THAT(check(bodies[2]), ElementsAre(HasSubstr("same name")));
}

TEST(MeshCheckerStl, TakesASolidWithoutFacetsForNothing) {
  EXPECT_THAT(read_stl("solid empty\nendsolid empty\n"), IsEmpty());
}

TEST(MeshCheckerStl, RefusesWhatIsNoStl) {
  EXPECT_THROW(read_stl("hello\n"), ReadError);
  EXPECT_THROW(read_stl("solid a\n vertex nan 0 0\n"), ReadError);
  EXPECT_THROW(read_stl("solid a\n vertex 1 0\n"), ReadError);
  EXPECT_THROW(read_stl("solid a\n" + facets({})), ReadError);
}

std::string object(const std::string& name, const Box& box, std::size_t first) {
  std::string text = "o " + name + "\n";
  for (std::size_t i = 0; i < 8; ++i) text += vertex("v", corner(box, i));
  text += "g " + name + "__WallSurface\n";
  for (const auto& [a, b, c] : kBox)
    text += "f " + std::to_string(a + first) + " " + std::to_string(b + first) + " " +
            std::to_string(c + first) + "\n";
  return text;
}

TEST(MeshCheckerObj, ReadsOneBodyPerObject) {
  const auto bodies =
      read_obj("# city\n" + object("a", {}, 1) + object("b", {{20, 0, 0}, {25, 5, 5}}, 9));
  ASSERT_THAT(bodies, SizeIs(2));
  EXPECT_THAT(check(bodies[0]), IsEmpty());
  EXPECT_THAT(check(bodies[1]), IsEmpty());
  EXPECT_DOUBLE_EQ(signed_volume_m3(bodies[1]), 125);
}

TEST(MeshCheckerObj, FindsAVertexSharedByTwoBodies) {
  const auto bodies = read_obj(object("a", {}, 1) + object("b", {}, 1));
  EXPECT_THAT(check(bodies.at(1)), Contains(HasSubstr("shares a vertex with 'a'")));
}

TEST(MeshCheckerObj, FindsAGroupThatBelongsElsewhere) {
  std::string text = object("a", {}, 1);
  text.replace(text.find("g a__"), 5, "g z__");
  EXPECT_THAT(check(read_obj(text).at(0)), Contains(HasSubstr("group 'z__WallSurface'")));
}

TEST(MeshCheckerObj, FindsNamesThatSolversDoNotRead) {
  for (const std::string name : {"1a", "_a", "ä", "a-b", "a.b"})
    EXPECT_THAT(check(read_obj(object(name, {}, 1)).at(0)), Contains(HasSubstr("the name is not")))
        << name;
}

TEST(MeshCheckerObj, FindsABodyWithoutTriangles) {
  EXPECT_THAT(check(read_obj("o a\n").at(0)), ElementsAre(HasSubstr("no triangles")));
}

TEST(MeshCheckerObj, RefusesCornersThatNameNoVertex) {
  EXPECT_THROW(read_obj("o a\nv 0 0 0\nf 1 2 3\n"), ReadError);
  EXPECT_THROW(read_obj("o a\nv 0 0 0\nf 0 1 1\n"), ReadError);
  EXPECT_THROW(read_obj("o a\nv 0 0 0\nf 1 x 1\n"), ReadError);
  EXPECT_THROW(read_obj("o a\nv 0 0 1e999\n"), ReadError);
}

}  // namespace
}  // namespace mesh_checker
