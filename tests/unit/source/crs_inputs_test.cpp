#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string triangle_at(double x, double y, double z) {
  const auto corner = [&](double dx, double dy) {
    return std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(z) + " ";
  };
  return corner(0, 0) + corner(10, 0) + corner(0, 20) + corner(0, 0);
}

std::string model_in(const std::string& srs, double x, double y, double z) {
  return city_model(
      "<cityObjectMember><bldg:Building gml:id=\"b\"><bldg:lod2MultiSurface>"
      "<gml:MultiSurface" +
      (srs.empty() ? "" : " srsName=\"" + srs + "\"") + ">" +
      member(polygon("p", triangle_at(x, y, z))) +
      "</gml:MultiSurface></bldg:lod2MultiSurface></bldg:Building>"
      "</cityObjectMember>");
}

TEST(SourceCrs, StandsForTheOneThatAFileDoesNotState) {
  BuildingQuery query;
  query.source_crs = {"EPSG:28992"};
  const Reading reading = read_text("a.gml", model_in("", 85000, 447000, 1), query);
  EXPECT_EQ(reading.selection.crs.id, "EPSG:28992");
  EXPECT_THAT(reading.selection.source_crs, ElementsAre("EPSG:28992"));

  query.crs = {"EPSG:25831"};
  const Reading moved = read_text("a.gml", model_in("", 85000, 447000, 1), query);
  EXPECT_EQ(moved.selection.crs.id, "EPSG:25831");
  EXPECT_GT(moved.selection.origin.y, 5.7e6) << "transformed from the CRS named";
}

TEST(SourceCrs, NeverReplacesAStatedOne) {
  BuildingQuery query;
  query.source_crs = {"EPSG:28992"};
  const Reading reading = read_text("a.gml", model_in("EPSG:25833", 390000, 5820000, 1), query);
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
}

TEST(AxisOrder, CanBeStatedAgainstWhatIsPlausible) {
  BuildingQuery query;
  query.axis_order = AxisOrder::NorthEast;
  const Reading north = read_text("a.gml", model_in("EPSG:25833", 390000, 5820000, 1), query);
  EXPECT_EQ(extent(north.buildings.at(0)).max.x - extent(north.buildings.at(0)).min.x, 20);
  EXPECT_EQ(north.selection.origin.x, 5820000);

  query.axis_order = AxisOrder::EastNorth;
  const Reading east = read_text("a.gml", model_in("EPSG:25833", 5820000, 390000, 1), query);
  EXPECT_EQ(east.selection.origin.x, 5820000);
}

TEST(AxisOrder, AppliesToFilesWithoutCrs) {
  BuildingQuery query;
  query.axis_order = AxisOrder::NorthEast;
  const Reading north = read_text("a.gml", model_in("", 100, 200, 1), query);
  EXPECT_EQ(north.selection.origin.x, 200);
  EXPECT_EQ(north.selection.origin.y, 100);
}

TEST(Feet, AreBroughtToMetresInTheUtmZoneOfTheDatum) {
  const Reading reading = read_text("a.gml", model_in("EPSG:2263", 984000, 203000, 100));
  ASSERT_FALSE(reading.error) << reading.error->message;
  EXPECT_EQ(reading.selection.crs.id, "EPSG:26918");
  EXPECT_THAT(reading.selection.source_crs, ElementsAre("EPSG:2263"));
  EXPECT_EQ(reading.selection.origin.z, 30);
  const Box3 box = extent(reading.buildings.at(0));
  EXPECT_NEAR(box.min.z, 0.48006, 1e-4);
  EXPECT_NEAR(box.max.x - box.min.x, 3.05, 0.2);
  EXPECT_THAT(reading.buildings[0].source_issues, IsEmpty());
}

TEST(Feet, OfTheHeightsFollowTheVerticalCrsWhereItIsStated) {
  const Reading reading = read_text(
      "a.gml", model_in("urn:ogc:def:crs,crs:EPSG::2263,crs:EPSG::5703", 984000, 203000, 100));
  ASSERT_FALSE(reading.error) << reading.error->message;
  EXPECT_EQ(reading.selection.crs.id, "EPSG:26918+5703");
  EXPECT_EQ(reading.selection.origin.z, 100);
}

TEST(Heights, KeepTheirCrsWhenTheWorkingCrsIsNamed) {
  BuildingQuery query;
  query.crs = {"EPSG:25832"};
  const Reading reading = read_text(
      "a.gml", model_in("urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH", 390000, 5820000, 34.5), query);
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25832+7837");
  EXPECT_EQ(reading.selection.origin.z, 34);
}

TEST(Heights, AHeightRangeIsInMetres) {
  BuildingQuery query;
  query.bbox = RequestBox{-74.1, 40.6, -73.9, 40.8, std::array<double, 2>{25, 35}, {"OGC:CRS84"}};
  const std::string text = model_in("EPSG:2263", 984000, 203000, 100);
  EXPECT_EQ(read_text("a.gml", text, query).selection.buildings, 1u) << "100 ft are 30 m";
  query.bbox->z_range_m = {90, 110};
  EXPECT_EQ(read_text("a.gml", text, query).selection.buildings, 0u);
}

}  // namespace
}  // namespace citymesh
