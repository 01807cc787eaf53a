// Whatever comes in, it ends: on a rung or with a reason, after work that is bounded by its size.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/gates/gates.h"
#include "core/heal/heal.h"
#include "core/mesh/mesh.h"
#include "tests/support/defects/bad_buildings.h"

namespace citymesh {
namespace {

const std::vector<Lod> kLod{{2, -1}};
const std::set<std::string> kReasons{"no_geometry", "no_height", "not_healed"};

/// The delivery gates, counting the faces that they are asked to judge.
class CountingGate {
 public:
  std::vector<Issue> operator()(const Shell& shell) {
    faces += shell.faces.size();
    const Meshed meshed = mesh(shell);
    if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
    const auto& triangles = std::get<TriangleMesh>(meshed);
    std::vector<Issue> issues;
    for (const GateFailure& f : check_shell(triangles.points, triangles.triangles, {}))
      issues.push_back({1, std::string(f.gate), 0});
    return issues;
  }
  std::size_t faces = 0;
};

class BadInput : public ::testing::TestWithParam<testing::BadBuilding> {};

TEST_P(BadInput, EndsOnARungOrWithAReasonWithinItsWorkLimit) {
  constexpr std::size_t kSize = 100'000;
  constexpr std::size_t kAttempts = 40;  // rungs × tolerances, and room for faces that fall apart
  const Building bad = GetParam().make(kSize);
  CountingGate gate;
  const Healed healed = heal(bad, kLod, {}, std::ref(gate), RunContext{});
  std::size_t triangles = 0;
  for (const Polygon& polygon : bad.geometries[0].polygons)
    for (const Ring& ring : polygon.rings) triangles += std::max<std::size_t>(ring.size(), 3) - 2;
  EXPECT_LE(gate.faces, kAttempts * (triangles + 100));
  if (healed.rung.empty()) {
    EXPECT_TRUE(kReasons.contains(healed.reason)) << healed.reason;
  } else {
    EXPECT_TRUE(gate(healed.shell).empty()) << healed.rung;
  }
}

INSTANTIATE_TEST_SUITE_P(Heal, BadInput, ::testing::ValuesIn(testing::bad_buildings()),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(BadCoordinates, AreAReasonWhenTheyAreNoNumbers) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e300}) {
    Building building = testing::bad_buildings()[3].make(100);
    building.geometries[0].points[2].y = bad;
    CountingGate gate;
    const Healed healed = heal(building, kLod, {}, std::ref(gate), RunContext{});
    EXPECT_EQ(healed.reason, "no_geometry");
    EXPECT_FALSE(healed.issues.empty());
  }
}

}  // namespace
}  // namespace citymesh
