#include "core/citymodel/building.h"

#include <gtest/gtest.h>

namespace citymesh {
namespace {

TEST(SurfaceType, NamesAreThoseOfCityGmlAndReadBack) {
  for (const auto type :
       {SurfaceType::Unknown, SurfaceType::GroundSurface, SurfaceType::WallSurface,
        SurfaceType::RoofSurface, SurfaceType::ClosureSurface, SurfaceType::OuterCeilingSurface,
        SurfaceType::OuterFloorSurface, SurfaceType::Window, SurfaceType::Door,
        SurfaceType::InteriorWallSurface, SurfaceType::CeilingSurface, SurfaceType::FloorSurface})
    EXPECT_EQ(surface_type_from(to_string(type)), type);
  EXPECT_EQ(to_string(SurfaceType::RoofSurface), "RoofSurface");
  EXPECT_FALSE(surface_type_from("roofsurface"));
}

TEST(Lod, IsReadWithAndWithoutMinor) {
  EXPECT_EQ(lod_from("2"), (Lod{2, -1}));
  EXPECT_EQ(lod_from("2.2"), (Lod{2, 2}));
  EXPECT_EQ(to_string(Lod{2, 2}), "2.2");
  EXPECT_EQ(to_string(Lod{1}), "1");
  for (const auto* text : {"", ".", "2.", ".2", "two", "-1", "300", "2.2.2", " 2"})
    EXPECT_FALSE(lod_from(text)) << text;
}

TEST(NumberAttribute, ReadsNumbersAndTextThatIsANumber) {
  const Attributes attributes{{"height", 12.5},
                              {"storeys", std::int64_t{3}},
                              {"text", std::string(" 7.25\n")},
                              {"word", std::string("high")},
                              {"flag", true}};
  EXPECT_EQ(number_attribute(attributes, "height"), 12.5);
  EXPECT_EQ(number_attribute(attributes, "storeys"), 3.0);
  EXPECT_EQ(number_attribute(attributes, "text"), 7.25);
  EXPECT_FALSE(number_attribute(attributes, "word"));
  EXPECT_FALSE(number_attribute(attributes, "flag"));
  EXPECT_FALSE(number_attribute(attributes, "absent"));
}

TEST(Extent, CoversTheBuildingAndItsParts) {
  Building building;
  building.geometries.push_back({.points = {{0, 0, 0}, {1, 1, 1}}});
  building.parts.emplace_back().geometries.push_back({.points = {{5, -2, 3}}});
  const Box3 box = extent(building);
  EXPECT_EQ(box.min, (Point3{0, -2, 0}));
  EXPECT_EQ(box.max, (Point3{5, 1, 3}));
  EXPECT_TRUE(extent(Building{}).is_empty());
}

}  // namespace
}  // namespace citymesh
