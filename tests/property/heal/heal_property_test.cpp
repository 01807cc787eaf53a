// Random damage to sound buildings. Seeds are fixed: a failure can be run again.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/gates/gates.h"
#include "core/heal/heal.h"
#include "core/mesh/mesh.h"
#include "tests/support/shapes.h"

namespace citymesh {
namespace {

using testing::Draw;
using testing::rectangle;

const std::vector<Lod> kLod{{2, -1}};

std::vector<Issue> delivery_gate(const Shell& shell) {
  const Meshed meshed = mesh(shell);
  if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
  const auto& triangles = std::get<TriangleMesh>(meshed);
  std::vector<Issue> issues;
  for (const GateFailure& f : check_shell(triangles.points, triangles.triangles, {}))
    issues.push_back({1, std::string(f.gate), 0});
  return issues;
}

Building gabled_house(std::mt19937& random) {
  std::uniform_real_distribution<double> size(4, 25), height(3, 15), rise(1, 5);
  const double x = size(random), y = size(random), eaves = height(random),
               ridge = eaves + rise(random);
  const auto base = rectangle(0, 0, x, y);
  Draw draw;
  draw.ground(base).wall(base[1], base[2], eaves).wall(base[3], base[0], eaves);
  draw.face(SurfaceType::WallSurface,
            {{{0, 0, 0}, {x, 0, 0}, {x, 0, eaves}, {x / 2, 0, ridge}, {0, 0, eaves}}});
  draw.face(SurfaceType::WallSurface,
            {{{x, y, 0}, {0, y, 0}, {0, y, eaves}, {x / 2, y, ridge}, {x, y, eaves}}});
  draw.face(SurfaceType::RoofSurface,
            {{{0, 0, eaves}, {x / 2, 0, ridge}, {x / 2, y, ridge}, {0, y, eaves}}});
  draw.face(SurfaceType::RoofSurface,
            {{{x / 2, 0, ridge}, {x, 0, eaves}, {x, y, eaves}, {x / 2, y, ridge}}});
  return draw.done();
}

void damage(Building& building, std::mt19937& random) {
  Geometry& g = building.geometries[0];
  const auto pick = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  std::uniform_real_distribution<double> jitter(-0.02, 0.02);
  for (std::size_t i = pick(4); i > 0; --i) switch (pick(6)) {
      case 0:
        g.polygons.erase(g.polygons.begin() + static_cast<std::ptrdiff_t>(pick(g.polygons.size())));
        break;
      case 1: {
        auto& ring = g.polygons[pick(g.polygons.size())].rings[0];
        std::reverse(ring.begin(), ring.end());
        break;
      }
      case 2:
        g.points[pick(g.points.size())].z += jitter(random);
        break;
      case 3:
        g.points[pick(g.points.size())].x += jitter(random);
        break;
      case 4:
        g.polygons.push_back(g.polygons[pick(g.polygons.size())]);
        break;
      case 5: {
        auto& ring = g.polygons[pick(g.polygons.size())].rings[0];
        ring.push_back(ring[pick(ring.size())]);
        break;
      }
    }
}

TEST(HealProperty, WhatIsDeliveredPassesTheGatesAndHasAVolume) {
  std::mt19937 random(20240917);
  int healed_count = 0;
  for (int i = 0; i < 400; ++i) {
    Building building = gabled_house(random);
    damage(building, random);
    const Healed healed = heal(building, kLod, {}, delivery_gate, RunContext{});
    if (healed.rung.empty()) {
      EXPECT_FALSE(healed.reason.empty()) << "house " << i;
      continue;
    }
    healed_count += healed.rung == "healed" ? 1 : 0;
    EXPECT_TRUE(delivery_gate(healed.shell).empty()) << "house " << i;
    if (healed.rung == "healed") {
      EXPECT_LE(healed.max_displacement_m, 0.1) << "house " << i;
    }
  }
  EXPECT_GT(healed_count, 100);
}

TEST(HealProperty, ShiftingABuildingByWholeMetresShiftsTheResult) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    Building here = gabled_house(random);
    damage(here, random);
    Building there = here;
    // Powers of two keep the doubles exact.
    for (Point3& p : there.geometries[0].points) p = {p.x + 4096, p.y - 2048, p.z + 64};
    for (Building* b : {&here, &there})
      for (Point3& p : b->geometries[0].points)
        p = {std::round(p.x * 1024) / 1024, std::round(p.y * 1024) / 1024,
             std::round(p.z * 1024) / 1024};
    const Healed a = heal(here, kLod, {}, delivery_gate, RunContext{});
    const Healed b = heal(there, kLod, {}, delivery_gate, RunContext{});
    ASSERT_EQ(a.rung, b.rung) << "house " << i;
    ASSERT_EQ(a.shell.faces.size(), b.shell.faces.size()) << "house " << i;
    for (std::size_t f = 0; f < a.shell.faces.size(); ++f)
      EXPECT_EQ(a.shell.faces[f].rings, b.shell.faces[f].rings) << "house " << i << " face " << f;
  }
}

}  // namespace
}  // namespace citymesh
