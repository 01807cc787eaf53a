#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kX = 390000, kY = 5820000;
const std::string kUtm33 = "urn:ogc:def:crs:EPSG::25833";

/// Three squares of 10 m in a row, 20 m apart, in EPSG:25833.
std::string row() {
  return city_model(envelope(kUtm33, "389900.7 5819900.2 12.3", "390200 5820100 50") +
                    simple_building("a", kX, kY, 20) + simple_building("b", kX + 20, kY, 20) +
                    simple_building("c", kX + 40, kY, 20));
}

BuildingQuery box(double min_x, double min_y, double max_x, double max_y,
                  const std::string& crs = "EPSG:25833") {
  return {.bbox = RequestBox{min_x, min_y, max_x, max_y, {}, {crs}}};
}

TEST(Selection, WithoutBoxOrIdsIsEverything) {
  const Reading reading = read_text("a.gml", row());
  EXPECT_THAT(reading.ids(), ElementsAre("a", "b", "c"));
  EXPECT_EQ(reading.selection.buildings, 3u);
  EXPECT_EQ(reading.input().crs, "EPSG:25833");
  EXPECT_EQ(reading.input().buildings, 3u);
}

TEST(Selection, OriginIsTheDeclaredLowerCornerInWholeMetresWhateverIsSelected) {
  const Point3 origin{389900, 5819900, 12};
  EXPECT_EQ(read_text("a.gml", row()).selection.origin, origin);
  const Reading one = read_text("a.gml", row(), {.object_ids = {"c"}});
  EXPECT_EQ(one.selection.origin, origin);
  EXPECT_EQ(extent(one.buildings.at(0)).min, (Point3{140, 100, 8}));
}

TEST(Selection, OriginWithoutDeclaredExtentIsTheLowerCornerOfAllBuildings) {
  const Reading reading = read_text(
      "a.gml",
      city_model(simple_building("a", 100.7, 200.2, 5.5) + simple_building("b", 300, 150.9, 7)),
      {.object_ids = {"b"}});
  EXPECT_EQ(reading.selection.origin, (Point3{100, 150, 5}));
}

TEST(Selection, ADeclaredExtentThatContradictsTheBuildingsIsNotUsed) {
  const Reading reading = read_text(
      "a.gml", city_model(envelope(kUtm33, "0 0 0", "1 1 1") + simple_building("a", kX, kY, 20)));
  EXPECT_EQ(reading.selection.origin, (Point3{kX, kY, 20}));
}

TEST(Selection, OriginOfABoxIsItsCentre) {
  const Reading reading = read_text("a.gml", row(), box(kX - 5, kY - 5, kX + 16, kY + 16));
  EXPECT_THAT(reading.ids(), ElementsAre("a"));
  EXPECT_EQ(reading.selection.origin, (Point3{kX + 5, kY + 5, 0}));
  EXPECT_EQ(extent(reading.buildings.at(0)).min, (Point3{-5, -5, 20}));
}

TEST(Selection, IntersectsTakesWhatTouches) {
  EXPECT_THAT(read_text("a.gml", row(), box(kX + 10, kY, kX + 20, kY + 10)).ids(),
              ElementsAre("a", "b"));
  EXPECT_THAT(read_text("a.gml", row(), box(kX + 10.01, kY, kX + 19.99, kY + 10)).ids(), IsEmpty());
}

TEST(Selection, IntersectsLooksAtTheGroundNotAtTheEaves) {
  const std::string house = building(
      "h", surface("GroundSurface", "g", multi_surface(member(polygon("p", square(kX, kY))))) +
               surface("RoofSurface", "r",
                       multi_surface(member(polygon("q", square(kX - 5, kY - 5, 9, 20))))));
  const std::string text =
      city_model(envelope(kUtm33, "389900 5819900 0", "390200 5820100 50") + house);
  EXPECT_THAT(read_text("a.gml", text, box(kX - 10, kY, kX - 1, kY + 5)).ids(), IsEmpty());
  EXPECT_THAT(read_text("a.gml", text, box(kX - 10, kY, kX, kY + 5)).ids(), ElementsAre("h"));
}

TEST(Selection, ACourtyardIsNotPartOfTheFootprint) {
  const std::string yard = "<gml:Polygon><gml:exterior>" + ring(square(kX, kY, 0, 50)) +
                           "</gml:exterior><gml:interior>" + ring(square(kX + 10, kY + 10, 0, 30)) +
                           "</gml:interior></gml:Polygon>";
  const std::string text =
      city_model(envelope(kUtm33, "389900 5819900 0", "390200 5820100 50") +
                 building("y", surface("GroundSurface", "g", multi_surface(member(yard)))));
  EXPECT_THAT(read_text("a.gml", text, box(kX + 20, kY + 20, kX + 30, kY + 30)).ids(), IsEmpty());
  EXPECT_THAT(read_text("a.gml", text, box(kX + 5, kY + 20, kX + 30, kY + 30)).ids(),
              ElementsAre("y"));
}

TEST(Selection, CentreAndWithinAreTheOtherRules) {
  auto query = box(kX, kY, kX + 26, kY + 10);
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), ElementsAre("a", "b"));
  query.bbox_rule = BboxRule::Within;
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), ElementsAre("a"));
  query.bbox_rule = BboxRule::Centre;
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), ElementsAre("a", "b"));
  query.bbox->max_x = kX + 24;
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), ElementsAre("a"));
}

TEST(Selection, AHeightRangeNarrowsTheBox) {
  auto query = box(kX, kY, kX + 10, kY + 10);
  query.bbox->z_range_m = {20.0, 30.0};
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), ElementsAre("a"));
  query.bbox->z_range_m = {20.5, 30.0};
  EXPECT_THAT(read_text("a.gml", row(), query).ids(), IsEmpty());
}

TEST(Selection, TakesABoxInDegreesAndInAnotherZone) {
  // 52.5208 N, 13.3776 E lies a few metres from the row; see crs_test for the transformation.
  const auto to_degrees = Transformer::create({"EPSG:25833"}, {"OGC:CRS84"});
  const auto to_zone_32 = Transformer::create({"EPSG:25833"}, {"EPSG:25832"});
  for (const auto& [transformer, crs, reach] :
       {std::tuple{&*to_degrees, "OGC:CRS84", 1e-6}, {&*to_zone_32, "EPSG:25832", 0.5}}) {
    std::array<Point3, 1> middle{{{kX + 25, kY + 5, 0}}};
    ASSERT_TRUE(transformer->apply(middle));
    const auto [x, y, z] = middle[0];
    const Reading reading =
        read_text("a.gml", row(), box(x - reach, y - reach, x + reach, y + reach, crs));
    ASSERT_FALSE(reading.error) << reading.error->message;
    EXPECT_THAT(reading.ids(), ElementsAre("b")) << crs;
    EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
    EXPECT_NEAR(reading.selection.origin.x, kX + 25, 1);
  }
}

TEST(Selection, EmptyBoxesAndAbsurdOnesAreErrors) {
  for (const auto& query : {box(10, 0, 0, 10), box(0, 10, 10, 0),
                            box(0, 0, std::numeric_limits<double>::quiet_NaN(), 1),
                            box(13, 95, 14, 96, "OGC:CRS84"), box(0, 0, 1, 1, "EPSG:999999")}) {
    const Reading reading = read_text("a.gml", row(), query);
    ASSERT_TRUE(reading.error);
    EXPECT_EQ(reading.error->code, ErrorCode::InvalidArgument) << reading.error->message;
  }
}

TEST(Selection, AnEmptyBoxOfTheCityIsNoError) {
  const Reading reading = read_text("a.gml", row(), box(kX + 1000, kY, kX + 1010, kY + 10));
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.selection.buildings, 0u);
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
}

TEST(Selection, IdsOfPartsSelectTheirBuildingAndMissingOnesAreNamed) {
  const std::string text =
      city_model(simple_building("a", 0, 0) +
                 building("b", "<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"b1\">" +
                                   multi_surface(member(polygon("p", square(50, 0)))) +
                                   "</bldg:BuildingPart></bldg:consistsOfBuildingPart>"));
  const Reading reading = read_text("a.gml", text, {.object_ids = {"b1", "nobody"}});
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.selection.missing_ids, ElementsAre("nobody"));
  EXPECT_THAT(reading.selection.object_ids, ElementsAre("b", "b1"));
}

TEST(Selection, IdsAndBoxMustBothHold) {
  auto query = box(kX, kY, kX + 26, kY + 10);
  query.object_ids = {"b", "c"};
  const Reading reading = read_text("a.gml", row(), query);
  EXPECT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.selection.missing_ids, IsEmpty());
}

TEST(Selection, SeveralFilesKeepTheirOrder) {
  Documents documents;
  documents.add("z.gml", city_model(simple_building("z", 0, 0)));
  documents.add("a.gml", city_model(simple_building("a", 30, 0)));
  EXPECT_THAT(documents.read().ids(), ElementsAre("z", "a"));
}

std::string in_crs(const std::string& id, const std::string& srs, double x, double y) {
  return building(id, "<gml:boundedBy><gml:Envelope srsName=\"" + srs + "\"/></gml:boundedBy>" +
                          multi_surface(member(polygon(id + "p", square(x, y)))));
}

TEST(WorkingCrs, DisagreementIsAnErrorThatListsThem) {
  const std::string text = city_model(in_crs("a", "EPSG:25832", 800000, 5800000) +
                                      in_crs("b", "EPSG:25833", 390000, 5800000));
  const Reading reading = read_text("a.gml", text);
  ASSERT_TRUE(reading.error);
  EXPECT_EQ(reading.error->code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(reading.error->message, HasSubstr("EPSG:25832, EPSG:25833"));
  EXPECT_THAT(reading.error->message, HasSubstr("`crs`"));

  const Reading one = read_text("a.gml", text, {.object_ids = {"b"}});
  EXPECT_FALSE(one.error) << "only the selected ones need to agree";
  EXPECT_EQ(one.selection.crs.id, "EPSG:25833");

  const Reading both = read_text("a.gml", text, {.crs = {"EPSG:25833"}});
  ASSERT_FALSE(both.error) << both.error->message;
  EXPECT_THAT(both.buildings, SizeIs(2));
  EXPECT_EQ(both.selection.crs.id, "EPSG:25833");
}

TEST(WorkingCrs, MustBeProjectedInMetres) {
  for (const auto* crs : {"EPSG:4326", "EPSG:2263", "EPSG:999999"}) {
    const Reading reading = read_text("a.gml", row(), {.crs = {crs}});
    ASSERT_TRUE(reading.error) << crs;
    EXPECT_EQ(reading.error->code, ErrorCode::InvalidArgument);
    EXPECT_THAT(reading.error->message, HasSubstr(crs));
  }
}

TEST(WorkingCrs, OfLatitudeAndLongitudeIsTheUtmZone) {
  const std::string lat_lon =
      "35.6800 139.7500 5 35.6801 139.7500 5 35.6801 139.7501 5 35.6800 139.7500 5";
  const std::string text = city_model(
      envelope("http://www.opengis.net/def/crs/EPSG/0/6697", "35.68 139.75 0", "35.69 139.76 50") +
      building("b", multi_surface(member(polygon("p", lat_lon)))));
  const Reading reading = read_text("a.gml", text);
  ASSERT_FALSE(reading.error) << reading.error->message;
  EXPECT_EQ(reading.selection.crs.id, "EPSG:6691+6695");
  EXPECT_NEAR(reading.selection.origin.x, 386884, 20);
  EXPECT_NEAR(reading.selection.origin.y, 3949176, 20);
  const Box3 box = extent(reading.buildings.at(0));
  EXPECT_NEAR(box.max.x - box.min.x, 9.05, 0.2) << "1e-4 degrees of longitude lie east";
  EXPECT_NEAR(box.max.y - box.min.y, 11.1, 0.2);
  EXPECT_EQ(box.min.z, 5);
}

TEST(AxisOrder, GeographicDataThatStoresLongitudeFirstIsRecognised) {
  const std::string lon_lat =
      "139.7500 35.6800 5 139.7501 35.6800 5 139.7501 35.6801 5 139.7500 35.6800 5";
  const Reading reading =
      read_text("a.gml", city_model(building("b",
                                             "<bldg:lod2MultiSurface><gml:MultiSurface "
                                             "srsName=\"EPSG:6697\">" +
                                                 member(polygon("p", lon_lat)) +
                                                 "</gml:MultiSurface></bldg:lod2MultiSurface>")));
  ASSERT_FALSE(reading.error) << reading.error->message;
  EXPECT_EQ(reading.selection.crs.id, "EPSG:6691+6695");
}

TEST(AxisOrder, ProjectedDataIsEastNorthUnlessOnlyTheOtherOrderIsPlausible) {
  // Helsinki: the registry says north, east; files say east, north.
  const Reading usual = read_text("a.gml", city_model(in_crs("b", "EPSG:3879", 25498756, 6674431)));
  EXPECT_EQ(usual.selection.origin, (Point3{25498756, 6674431, 0}));
  const Reading turned =
      read_text("a.gml", city_model(in_crs("b", "EPSG:3879", 6674431, 25498756)));
  EXPECT_EQ(turned.selection.origin, (Point3{25498756, 6674431, 0}));
}

TEST(NoCrs, IsAcceptedInMetresWithAWarning) {
  const Reading reading = read_text("a.gml", city_model(simple_building("a", 0, 0)));
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.selection.crs.id, "");
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("no CRS stated, metres assumed")));
}

TEST(NoCrs, EmptySrsNamesCountAsNone) {
  const Reading reading = read_text("a.gml", city_model(in_crs("a", "", 0, 0)));
  EXPECT_EQ(reading.selection.crs.id, "");
}

TEST(NoCrs, ABoxInACrsNeedsTheOptionThatHelps) {
  for (const std::string& text : {city_model(simple_building("a", kX, kY)),
                                  city_model(in_crs("a", "#local-CRS-1", kX, kY))}) {
    const Reading refused = read_text("a.gml", text, box(kX, kY, kX + 5, kY + 5));
    ASSERT_TRUE(refused.error);
    EXPECT_EQ(refused.error->code, ErrorCode::InvalidArgument);
    EXPECT_THAT(refused.error->message, HasSubstr("`crs`"));

    auto query = box(kX, kY, kX + 5, kY + 5);
    query.crs = {"EPSG:25833"};
    const Reading helped = read_text("a.gml", text, query);
    ASSERT_FALSE(helped.error) << helped.error->message;
    EXPECT_THAT(helped.ids(), ElementsAre("a"));
    EXPECT_EQ(helped.selection.crs.id, "EPSG:25833");
    EXPECT_THAT(helped.selection.warnings, Contains(HasSubstr("taken as EPSG:25833")));

    EXPECT_THAT(read_text("a.gml", text, box(kX, kY, kX + 5, kY + 5, "")).ids(), ElementsAre("a"))
        << "a box in the data's own coordinates needs no CRS";
  }
}

TEST(NoCrs, CanBeAssumedByTheOperator) {
  const Reading reading = read_text("a.gml", city_model(simple_building("a", kX, kY)), {},
                                    {.assume_crs = {"EPSG:25833"}});
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
  EXPECT_THAT(reading.selection.warnings, IsEmpty());
}

TEST(NoCrs, IsLeftOutOfABoxWhenOtherFilesHaveOne) {
  Documents documents;
  documents.add("a.gml", row());
  documents.add("b.gml", city_model(simple_building("x", kX, kY)));
  const Reading reading = documents.read(box(kX, kY, kX + 5, kY + 5));
  EXPECT_THAT(reading.ids(), ElementsAre("a"));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("b.gml states no CRS")));
}

}  // namespace
}  // namespace citymesh
