#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/gates/gates.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::box;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Triangles;

constexpr std::int64_t m = 10000;  // a metre in steps

std::vector<std::string> failed(const Triangles& shell) {
  std::vector<std::string> gates;
  for (const GateFailure& failure : check_shell(shell.points, shell.triangles, {})) {
    EXPECT_GT(failure.count, 0u);
    EXPECT_FALSE(failure.where.empty());
    gates.emplace_back(failure.gate);
  }
  return gates;
}

/// Equal points become one, as the re-read of a file does.
Triangles welded(const Triangles& shell) {
  Triangles result;
  for (const Triangle& t : shell.triangles) {
    Triangle w{};
    for (std::size_t i = 0; i < 3; ++i) {
      const GridPoint& p = shell.points[t[i]];
      auto at = std::find(result.points.begin(), result.points.end(), p);
      w[i] = static_cast<std::uint32_t>(at - result.points.begin());
      if (at == result.points.end()) result.points.push_back(p);
    }
    result.triangles.push_back(w);
  }
  return result;
}

TEST(Gates, ABoxPasses) { EXPECT_THAT(failed(box({0, 0, 0}, {m, m, m})), IsEmpty()); }

TEST(Gates, NothingFailsG1) { EXPECT_THAT(failed({}), Contains("G1")); }

TEST(Gates, AMissingTriangleFailsG1) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.triangles.pop_back();
  EXPECT_THAT(failed(shell), Contains("G1"));
}

TEST(Gates, TwoBoxesThatShareAnEdgeFailG2) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.add(box({m, m, 0}, {2 * m, 2 * m, m}));
  EXPECT_THAT(failed(welded(shell)), Contains("G2"));
}

TEST(Gates, TwoBoxesThatShareACornerFailG2) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.add(box({m, m, m}, {2 * m, 2 * m, 2 * m}));
  EXPECT_THAT(failed(welded(shell)), Contains("G2"));
}

TEST(Gates, BoxesApartPass) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.add(box({2 * m, 0, 0}, {3 * m, m, m}));
  EXPECT_THAT(failed(shell), IsEmpty());
}

TEST(Gates, BoxesThatInterpenetrateFailG4) {
  auto shell = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  shell.add(box({m, m, m}, {3 * m, 3 * m, 3 * m}));
  EXPECT_THAT(failed(shell), Contains("G4"));
}

TEST(Gates, BoxesThatTouchInAFaceFailG4) {
  auto shell = box({0, 0, 0}, {2 * m, 2 * m, 2 * m});
  shell.add(box({2 * m, m / 2, m / 2}, {3 * m, m, m}));
  EXPECT_THAT(failed(shell), Contains("G4"));
}

TEST(Gates, AFlatBoxFailsG5) { EXPECT_THAT(failed(box({0, 0, 0}, {m, m, 5})), Contains("G5")); }

TEST(Gates, ATriangleWithoutAreaFailsG5) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.triangles.push_back({0, 1, 1});
  EXPECT_THAT(failed(shell), Contains("G5"));
}

TEST(Gates, AVertexOnAForeignEdgeFailsG6) {
  auto shell = box({0, 0, 0}, {m, m, m});
  // A second box whose corner comes within half a millimetre of the first one's edge.
  shell.add(box({m + 5, 0, m / 2}, {2 * m, m, 2 * m}));
  EXPECT_THAT(failed(shell), Contains("G6"));
}

TEST(Gates, ABoxTurnedInsideOutFailsG7) {
  EXPECT_THAT(failed(box({0, 0, 0}, {m, m, m}).turn()), Contains("G7"));
}

TEST(Gates, ATurnedTriangleFailsG7) {
  auto shell = box({0, 0, 0}, {m, m, m});
  std::swap(shell.triangles[0][1], shell.triangles[0][2]);
  EXPECT_THAT(failed(shell), Contains("G7"));
}

TEST(Gates, ATriangleGivenTwiceFailsG8) {
  auto shell = box({0, 0, 0}, {m, m, m});
  shell.triangles.push_back(shell.triangles[0]);
  EXPECT_THAT(failed(shell), Contains("G8"));
}

TEST(Gates, ABoxInsideABoxIsAnInteriorFaceUnlessItIsACavity) {
  auto shell = box({0, 0, 0}, {9 * m, 9 * m, 9 * m});
  auto cavity = shell;
  shell.add(box({m, m, m}, {2 * m, 2 * m, 2 * m}));
  EXPECT_THAT(failed(shell), Contains("G8"));
  cavity.add(box({m, m, m}, {2 * m, 2 * m, 2 * m}).turn());
  EXPECT_THAT(failed(cavity), IsEmpty());
}

TEST(Gates, ATorusPassesEulersFormula) {
  // A square ring: outer box with a square tunnel along z.
  Triangles ring;
  const std::int64_t out[4][2] = {{0, 0}, {3 * m, 0}, {3 * m, 3 * m}, {0, 3 * m}};
  const std::int64_t in[4][2] = {{m, m}, {2 * m, m}, {2 * m, 2 * m}, {m, 2 * m}};
  for (const std::int64_t z : {std::int64_t{0}, m}) {
    for (const auto& p : out) ring.points.push_back({p[0], p[1], z});
    for (const auto& p : in) ring.points.push_back({p[0], p[1], z});
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    ring.triangles.push_back({a, b, c});
    ring.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    quad(i, j, j + 8, i + 8);            // outer wall
    quad(j + 4, i + 4, i + 12, j + 12);  // tunnel wall
    quad(i + 8, j + 8, j + 12, i + 12);  // top
    quad(j, i, i + 4, j + 4);            // bottom
  }
  EXPECT_THAT(failed(ring), IsEmpty());
}

TEST(Gates, CoordinatesBeyondTheGridFailG13) {
  EXPECT_THAT(failed(box({0, 0, 0}, {m, m, kGridLimit + 1})), Contains("G13"));
}

TEST(Gates, NamesThatSolversCannotReadFailG14) {
  ParsedBody body;
  body.triangles = {{0, 1, 2}};
  body.patches = {"WallSurface"};
  for (const char* good : {"b_1", "House", "x_9"}) {
    body.name = good;
    EXPECT_THAT(check_labels(body, true), IsEmpty()) << good;
  }
  for (const char* bad : {"", "1a", "_a", "a b", "a-b", "ä"}) {
    body.name = bad;
    EXPECT_THAT(check_labels(body, true), Not(IsEmpty())) << bad;
    EXPECT_THAT(check_labels(body, false), IsEmpty()) << bad;
  }
}

TEST(Gates, ATriangleWithoutAPatchFailsG14) {
  ParsedBody body;
  body.name = "house";
  body.triangles = {{0, 1, 2}, {0, 2, 3}};
  body.patches = {"WallSurface"};
  ASSERT_EQ(check_labels(body, true).size(), 1u);
  EXPECT_EQ(check_labels(body, true)[0].gate, "G14");
  body.patches = {"WallSurface", ""};
  EXPECT_EQ(check_labels(body, true).size(), 1u);
  body.patches = {"WallSurface", "RoofSurface"};
  EXPECT_THAT(check_labels(body, true), IsEmpty());
}

TEST(Gates, TheVerdictDoesNotDependOnThePlace) {
  for (const std::int64_t shift : {std::int64_t{0}, kGridLimit - 3 * m, -kGridLimit + m}) {
    auto shell = box({shift, shift, shift}, {shift + m, shift + m, shift + m});
    EXPECT_THAT(failed(shell), IsEmpty());
    shell.triangles.pop_back();
    EXPECT_THAT(failed(shell), Not(IsEmpty()));
  }
}

}  // namespace
}  // namespace citymesh
