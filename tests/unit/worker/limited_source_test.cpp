#include "services/worker/limited_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace citymesh {
namespace {

using testing::HasSubstr;

/// Three buildings of ten points, four in a part and one in an installation of each.
class ThreeBuildings final : public CitySource {
 public:
  Result<Selection> select(const BuildingQuery&, const RunContext&) override {
    Selection selection;
    selection.buildings = 3;
    return selection;
  }
  Result<void> read(const BuildingQuery&, const Selection&, const BuildingSink& sink,
                    const RunContext&) override {
    for (const auto* id : {"a", "b", "c"}) {
      Building building = with_points(5);
      building.gml_id = id;
      building.parts.push_back(with_points(4));
      building.installations.push_back(with_points(1));
      if (auto taken = sink(std::move(building)); !taken) return taken;
    }
    return {};
  }

 private:
  static Building with_points(std::size_t count) {
    Building building;
    building.geometries.emplace_back().points.resize(count);
    return building;
  }
};

std::unique_ptr<CitySource> three_buildings(const JobLimits& limits) {
  return limited(std::make_unique<ThreeBuildings>(), limits);
}

void expect_refused(const Error& error, std::string_view why) {
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, HasSubstr(std::string(why)));
}

TEST(LimitedSourceTest, WithoutLimitsNothingIsRefused) {
  const auto source = three_buildings({});
  const auto selection = source->select({}, {});
  ASSERT_TRUE(selection);
  int read = 0;
  EXPECT_TRUE(source->read({}, *selection, [&](Building&&) { return ++read, Result<void>{}; }, {}));
  EXPECT_EQ(read, 3);
}

TEST(LimitedSourceTest, ABoxThatIsTooLargeIsRefusedWithItsArea) {
  Inputs inputs;
  EXPECT_TRUE(check_area(inputs, 100)) << "no box";
  inputs.area_km2 = 100;
  EXPECT_TRUE(check_area(inputs, 100));
  inputs.area_km2 = 123.654;
  const auto refused = check_area(inputs, 100);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
  EXPECT_THAT(refused.error().message, HasSubstr("covers 123.7 km², at most 100 km²"));
}

TEST(LimitedSourceTest, TooManyBuildingsAreNotEvenRead) {
  EXPECT_TRUE(three_buildings({.buildings = 3})->select({}, {}));
  const auto refused = three_buildings({.buildings = 2})->select({}, {});
  ASSERT_FALSE(refused);
  expect_refused(refused.error(), "3 buildings are selected, at most 2");
}

TEST(LimitedSourceTest, ReadingEndsWithTheBuildingThatHasAPointTooMany) {
  std::vector<std::string> read;
  const BuildingSink sink = [&](Building&& building) -> Result<void> {
    read.push_back(building.gml_id);
    return {};
  };
  const auto refused = three_buildings({.points = 20})->read({}, {}, sink, {});
  ASSERT_FALSE(refused);
  expect_refused(refused.error(), "up to 'c' have 30 points, at most 20");
  EXPECT_THAT(read, testing::ElementsAre("a", "b"));
  EXPECT_TRUE(three_buildings({.points = 30})->read({}, {}, sink, {}));
}

}  // namespace
}  // namespace citymesh
