// What healing promises, on generated houses of which it is known what they should be.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/citymodel/grid.h"
#include "core/gates/gates.h"
#include "core/geometry/measure.h"
#include "core/heal/heal.h"
#include "core/mesh/mesh.h"
#include "core/validate/validate.h"
#include "tests/support/defects/city.h"

namespace citymesh {
namespace {

using testing::Defect;
using testing::DefectiveHouse;

constexpr double kMaxVolumeError = 0.005;
const std::vector<Lod> kLod{{2, -1}};
const std::set<std::string> kSharpRungs{"as_is", "healed", "rebuilt_2_5d", "rebuilt_3d"};

std::vector<Issue> delivery_gate(const Shell& shell) {
  const Meshed meshed = mesh(shell);
  if (const Issue* issue = std::get_if<Issue>(&meshed)) return {*issue};
  const auto& triangles = std::get<TriangleMesh>(meshed);
  std::vector<Issue> issues;
  for (const GateFailure& f : check_shell(triangles.points, triangles.triangles, {}))
    issues.push_back({1, std::string(f.gate), 0});
  return issues;
}

Healed heal_house(const Building& building) {
  return heal(building, kLod, {}, delivery_gate, RunContext{});
}

double volume_of(const Shell& shell) {
  const Meshed meshed = mesh(shell);
  const auto* triangles = std::get_if<TriangleMesh>(&meshed);
  return triangles ? volume_m3(triangles->points, triangles->triangles) : 0;
}

double volume_error(const DefectiveHouse& house, const Shell& shell) {
  return std::max(0.0, std::abs(volume_of(shell) - house.volume_m3) - house.undefined_m3) /
         house.volume_m3;
}

/// A delivered shell as an input again.
Building building_of(const Shell& shell) {
  Building building;
  building.gml_id = "again";
  building.geometries.emplace_back();
  Geometry& geometry = building.geometries.back();
  geometry.type = GeometryType::Solid;
  geometry.lod = {2, -1};
  geometry.solids.emplace_back();
  for (const GridPoint& p : shell.points) geometry.points.push_back(to_metres(p));
  for (const Face& face : shell.faces) {
    Polygon polygon;
    polygon.rings = face.rings;
    polygon.surface = static_cast<std::int32_t>(building.surfaces.size());
    building.surfaces.push_back({face.type, {}});
    geometry.solids[0].exterior.push_back(static_cast<std::uint32_t>(geometry.polygons.size()));
    geometry.polygons.push_back(std::move(polygon));
  }
  return building;
}

/// Type and corners of every face, by place.
using Places = std::vector<std::pair<SurfaceType, std::vector<std::vector<GridPoint>>>>;

Places places_of(const Shell& shell, const GridPoint& shift = {}) {
  Places places;
  for (const Face& face : shell.faces) {
    places.push_back({face.type, {}});
    for (const Ring& ring : face.rings) {
      places.back().second.emplace_back();
      for (const std::uint32_t corner : ring) {
        const GridPoint& p = shell.points[corner];
        places.back().second.back().push_back({p.x - shift.x, p.y - shift.y, p.z - shift.z});
      }
    }
  }
  return places;
}

const std::vector<DefectiveHouse>& city() {
  static const std::vector<DefectiveHouse> houses =
      testing::make_city({.seed = 20240917, .sound = 2, .singles = 1, .pairs = 1});
  return houses;
}

TEST(Promise, EveryDefectiveHouseIsDeliveredWithItsGatesGreen) {
  for (const DefectiveHouse& house : city()) {
    const Healed healed = heal_house(house.building);
    ASSERT_FALSE(healed.rung.empty()) << house.building.gml_id << ": " << healed.reason;
    EXPECT_TRUE(delivery_gate(healed.shell).empty()) << house.building.gml_id;
  }
}

TEST(Promise, AlmostAllKeepTheirPlanesAndHaveTheVolumeOfTheSoundHouse) {
  std::size_t right = 0;
  std::map<std::string, int> misses;
  for (const DefectiveHouse& house : city()) {
    const Healed healed = heal_house(house.building);
    if (kSharpRungs.contains(healed.rung) && volume_error(house, healed.shell) <= kMaxVolumeError) {
      ++right;
      continue;
    }
    misses[house.building.gml_id + " " + healed.rung] = 1;
  }
  EXPECT_GE(static_cast<double>(right), 0.99 * static_cast<double>(city().size()));
  if (::testing::Test::HasFailure())
    for (const auto& [name, count] : misses) ADD_FAILURE() << name;
}

TEST(Promise, SoundHousesAreReturnedAsTheyAre) {
  for (const DefectiveHouse& house : city()) {
    if (!house.defects.empty()) continue;
    const Healed healed = heal_house(house.building);
    EXPECT_EQ(healed.rung, "as_is") << house.building.gml_id;
    EXPECT_TRUE(healed.issues.empty()) << house.building.gml_id;
    const auto gridded = grid(house.building, house.building.geometries[0]);
    ASSERT_TRUE(std::holds_alternative<Gridded>(gridded));
    EXPECT_EQ(places_of(healed.shell), places_of(std::get<Gridded>(gridded).shell))
        << house.building.gml_id;
  }
}

TEST(Promise, HealingTwiceChangesNothing) {
  for (const DefectiveHouse& house : city()) {
    const Healed once = heal_house(house.building);
    if (once.rung.empty()) continue;
    const Healed twice = heal_house(building_of(once.shell));
    EXPECT_EQ(twice.rung, "as_is") << house.building.gml_id << " from " << once.rung;
    EXPECT_TRUE(twice.repairs.empty()) << house.building.gml_id;
    EXPECT_EQ(places_of(twice.shell), places_of(once.shell)) << house.building.gml_id;
  }
}

TEST(Promise, FarFromTheOriginTheSameFindingsAndTheSameShell) {
  const GridPoint shift{1'500'000'000, -1'250'000'000, 40'000'000};
  const Point3 shift_m = to_metres(shift);
  for (std::size_t i = 0; i < city().size(); i += 3) {
    const DefectiveHouse& house = city()[i];
    Building there = house.building;
    for (Point3& p : there.geometries[0].points)
      p = {p.x + shift_m.x, p.y + shift_m.y, p.z + shift_m.z};
    const Healed near = heal_house(house.building), far = heal_house(there);
    ASSERT_EQ(near.rung, far.rung) << house.building.gml_id;
    ASSERT_EQ(near.issues.size(), far.issues.size()) << house.building.gml_id;
    for (std::size_t k = 0; k < near.issues.size(); ++k) {
      EXPECT_EQ(near.issues[k].code, far.issues[k].code) << house.building.gml_id;
      EXPECT_NEAR(near.issues[k].measured, far.issues[k].measured, 1e-6) << house.building.gml_id;
    }
    EXPECT_EQ(places_of(near.shell), places_of(far.shell, shift)) << house.building.gml_id;
  }
}

}  // namespace
}  // namespace citymesh
