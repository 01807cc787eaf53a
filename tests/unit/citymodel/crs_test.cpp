#include "core/citymodel/crs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

namespace citymesh {
namespace {

using ::testing::HasSubstr;

TEST(ParseCrs, ReadsEverySpelling) {
  const std::array<std::array<const char*, 2>, 36> cases{{
      {"EPSG:25832", "EPSG:25832"},
      {" epsg:25832\n", "EPSG:25832"},
      {"EPSG:25832+5783", "EPSG:25832+5783"},
      {"25833", "EPSG:25833"},
      {"urn:ogc:def:crs:EPSG::25833", "EPSG:25833"},
      {"urn:ogc:def:crs:EPSG:6.12:25833", "EPSG:25833"},
      {"urn:x-ogc:def:crs:EPSG:25833", "EPSG:25833"},
      {"urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783", "EPSG:25832+5783"},
      {"urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783", "EPSG:3068+5783"},
      {"http://www.opengis.net/def/crs/EPSG/0/6697", "EPSG:6697"},
      {"https://www.opengis.net/def/crs/EPSG/0/7415", "EPSG:7415"},
      {"http://www.opengis.net/def/crs/EPSG/6.12/3068", "EPSG:3068"},
      {"http://www.opengis.net/def/crs/OGC/1.3/CRS84", "OGC:CRS84"},
      {"urn:ogc:def:crs:OGC:1.3:CRS84", "OGC:CRS84"},
      {"http://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/25832&"
       "2=http://www.opengis.net/def/crs/EPSG/0/5783",
       "EPSG:25832+5783"},
      {"http://www.opengis.net/gml/srs/epsg.xml#28992", "EPSG:28992"},
      {"urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH*GCG2016", "EPSG:25832+7837"},
      {"urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH", "EPSG:25833+7837"},
      {"urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH", "EPSG:25832+5783"},
      {"urn:adv:crs:DE_DHDN_3GK4*DE_DHN92_NH", "EPSG:31468+5783"},
      {"urn:adv:crs:DE_DHDN_3GK2_NW101*DE_DHHN12_NOH", "EPSG:31466+7699"},
      {"urn:adv:crs:DE_DHDN_3GK3_HE100", "EPSG:31467"},
      {"urn:adv:crs:DE_DHDN_3GK4_RDN*DE_DHHN85_NOH", "EPSG:31468+5784"},
      {"urn:adv:crs:DE_42-83_6GK3*DE_SNN76_NH", "EPSG:3835+5785"},
      {"urn:adv:crs:etrs89_utm32*de_dhhn2016_nh", "EPSG:25832+7837"},
      {"urn:adv:crs:ETRS89_UTM32-zE", "EPSG:4647"},
      {"urn:ogc:def:crs:EPSG::25832+5783", "EPSG:25832+5783"},
      {"urn:ogc:def:crs,crs:EPSG:9.6:25832,crs:EPSG:9.6:5783", "EPSG:25832+5783"},
      {"https://www.opengis.net/def/crs-compound?2=http://www.opengis.net/def/crs/EPSG/0/5783&"
       "1=http://www.opengis.net/def/crs/EPSG/0/25832",
       "EPSG:25832+5783"},
      {"http://www.opengis.net/def/crs/EPSG/0/28992/", "EPSG:28992"},
      {"urn:EPSG:geographicCRS:4326", "EPSG:4326"},
      {"EPSG:25832+EPSG:5783", "EPSG:25832+5783"},
      {"CH1903", "EPSG:21781"},
      {"#local-CRS-1", "LOCAL"},
      {"urn:example:engineering-crs", "LOCAL"},
      {"", ""},
  }};
  for (const auto& [text, id] : cases) {
    const auto crs = parse_crs(text);
    ASSERT_TRUE(crs) << text << ": " << crs.error().message;
    EXPECT_EQ(crs->id, id) << text;
  }
}

TEST(ParseCrs, NamesTheTextItDoesNotUnderstand) {
  for (const auto* text : {"EPSG:", "EPSG:abc", "urn:ogc:def:crs:EPSG::", "urn:adv:crs:MOON*DE",
                           "Gauss-Krueger", "http://example.org/crs", "urn:ogc:def:crs,crs:X::1",
                           "EPSG:1+2+3", "+", "urn:ogc:def:crs,", "EPSG:99999999999999999999"}) {
    const auto crs = parse_crs(text);
    ASSERT_FALSE(crs) << text;
    EXPECT_EQ(crs.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(crs.error().message, HasSubstr(text));
  }
}

TEST(DescribeCrs, TellsKindUnitOrderAndArea) {
  const auto utm = describe_crs({"EPSG:25833+5783"});
  ASSERT_TRUE(utm);
  EXPECT_FALSE(utm->geographic);
  EXPECT_FALSE(utm->north_first);
  EXPECT_EQ(utm->horizontal_unit_m, 1.0);
  EXPECT_GT(utm->area_of_use_deg.max.x, 13.4);

  const auto japan = describe_crs({"EPSG:6697"});
  ASSERT_TRUE(japan);
  EXPECT_TRUE(japan->geographic);
  EXPECT_TRUE(japan->north_first);

  const auto helsinki = describe_crs({"EPSG:3879"});
  ASSERT_TRUE(helsinki);
  EXPECT_TRUE(helsinki->north_first);

  const auto feet = describe_crs({"EPSG:2263"});
  ASSERT_TRUE(feet);
  EXPECT_NEAR(feet->horizontal_unit_m, 0.3048, 1e-4);
}

TEST(DescribeCrs, RefusesWhatProjDoesNotKnow) {
  for (const auto* id : {"EPSG:999999", "LOCAL", "", "nonsense"}) {
    const auto facts = describe_crs({id});
    ASSERT_FALSE(facts) << id;
    EXPECT_THAT(facts.error().message, HasSubstr(std::string("'") + id + "'"));
  }
}

TEST(WorkingCrs, IsTheCrsItselfWhenProjectedInMetres) {
  EXPECT_EQ(working_crs({"EPSG:25833"}, {})->id, "EPSG:25833");
  EXPECT_EQ(working_crs({"EPSG:7415"}, {})->id, "EPSG:7415");
  EXPECT_EQ(working_crs({"LOCAL"}, {})->id, "LOCAL");
  EXPECT_EQ(working_crs({""}, {})->id, "");
}

TEST(WorkingCrs, IsTheUtmZoneOfTheSameDatumForDegrees) {
  EXPECT_EQ(working_crs({"EPSG:6697"}, {139.75, 35.68, 0})->id, "EPSG:6691+6695");
  EXPECT_EQ(working_crs({"EPSG:6697"}, {131.73, 34.13, 0})->id, "EPSG:6689+6695");
  EXPECT_EQ(working_crs({"EPSG:4258"}, {13.4, 52.5, 0})->id, "EPSG:25833");
  EXPECT_EQ(working_crs({"EPSG:4326"}, {13.4, 52.5, 0})->id, "EPSG:32633");
  EXPECT_EQ(working_crs({"EPSG:4979"}, {-70.6, -33.4, 0})->id, "EPSG:32719");
  EXPECT_EQ(working_crs({"OGC:CRS84"}, {180, 10, 0})->id, "EPSG:32601");
}

TEST(WorkingCrs, IsTheUtmZoneOfTheSameDatumForFeet) {
  const Point3 manhattan{984000, 203000, 0};  // EPSG:2263, US survey feet
  EXPECT_EQ(working_crs({"EPSG:2263"}, manhattan)->id, "EPSG:26918");
  EXPECT_EQ(working_crs({"EPSG:2263+5703"}, manhattan)->id, "EPSG:26918+5703");
  EXPECT_EQ(working_crs({"EPSG:6539"}, manhattan)->id, "EPSG:6347") << "NAD83(2011)";
}

TEST(WorkingCrs, NamesHeightsInMetresInsteadOfFeet) {
  EXPECT_EQ(working_crs({"EPSG:2263+6360"}, {984000, 203000, 0})->id, "EPSG:26918+5703");
  EXPECT_EQ(working_crs({"EPSG:26918+6360"}, {})->id, "EPSG:26918+5703");
  EXPECT_EQ(working_crs({"EPSG:26918+8052"}, {})->id, "EPSG:26918") << "MSL in feet has no twin";
}

TEST(WorkingCrs, TakesTheHeightsOfTheSource) {
  EXPECT_EQ(with_vertical({"EPSG:25832"}, {"EPSG:25833+7837"}).id, "EPSG:25832+7837");
  EXPECT_EQ(with_vertical({"EPSG:6691"}, {"EPSG:6697"}).id, "EPSG:6691+6695");
  EXPECT_EQ(with_vertical({"EPSG:25832+5783"}, {"EPSG:25833+7837"}).id, "EPSG:25832+5783");
  EXPECT_EQ(with_vertical({"EPSG:7415"}, {"EPSG:25833+7837"}).id, "EPSG:7415");
  EXPECT_EQ(with_vertical({"EPSG:25832"}, {"EPSG:25833"}).id, "EPSG:25832");
  EXPECT_EQ(with_vertical({"EPSG:25832"}, {""}).id, "EPSG:25832");
}

TEST(DescribeCrs, TellsTheHeightsAndTheirUnit) {
  EXPECT_EQ(describe_crs({"EPSG:25833+7837"})->vertical_name, "DHHN2016 height");
  EXPECT_EQ(describe_crs({"EPSG:25833"})->vertical_name, "");
  EXPECT_EQ(describe_crs({"EPSG:4979"})->vertical_name, "ellipsoidal height");
  EXPECT_EQ(describe_crs({"EPSG:6697"})->vertical_unit_m, 1.0);
  EXPECT_NEAR(describe_crs({"EPSG:2263"})->vertical_unit_m, 0.3048006, 1e-7) << "as its axes";
  EXPECT_EQ(describe_crs({"EPSG:2263+5703"})->vertical_unit_m, 1.0);
  EXPECT_NEAR(describe_crs({"EPSG:26918+6360"})->vertical_unit_m, 0.3048006, 1e-7);
}

TEST(Transformer, BringsHeightsInFeetToMetres) {
  struct Case {
    const char *from, *to;
    double height_m;
  };
  for (const auto& [from, to, height_m] :
       {Case{"EPSG:2263", "EPSG:26918", 30.48006}, Case{"EPSG:2263+5703", "EPSG:26918+5703", 100},
        Case{"EPSG:2263+8228", "EPSG:26918+5703", 30.48},
        Case{"EPSG:26918+6360", "EPSG:26918+5703", 30.48006}}) {
    const auto transformer = Transformer::create({from}, {to});
    ASSERT_TRUE(transformer) << from;
    EXPECT_FALSE(transformer->is_identity());
    std::array<Point3, 1> point{{{984000, 203000, 100}}};
    ASSERT_TRUE(transformer->apply(point));
    EXPECT_NEAR(point[0].z, height_m, 1e-5) << from;
  }
}

TEST(WorkingCrs, AsksForAMetricOneWhereItKnowsNone) {
  const auto old_german = working_crs({"EPSG:4314"}, {13, 52, 0});
  ASSERT_FALSE(old_german);
  EXPECT_THAT(old_german.error().message, HasSubstr("`crs`"));
  EXPECT_FALSE(working_crs({"EPSG:6318"}, {150, -30, 0})) << "NAD83(2011) has no zone there";
  EXPECT_FALSE(working_crs({"EPSG:6697"}, {13, 52, 0}));
}

TEST(Transformer, PutsEastFirstOnBothSidesAndKeepsHeights) {
  const auto transformer = Transformer::create({"OGC:CRS84"}, {"EPSG:25833+5783"});
  ASSERT_TRUE(transformer) << transformer.error().message;
  std::array<Point3, 1> point{{{13.4, 52.5, 34.5}}};
  ASSERT_TRUE(transformer->apply(point));
  EXPECT_NEAR(point[0].x, 391390.733, 0.01);  // Krueger series
  EXPECT_NEAR(point[0].y, 5817855.241, 0.01);
  EXPECT_EQ(point[0].z, 34.5);

  const auto japan = Transformer::create({"EPSG:6697"}, {"EPSG:6691"});
  ASSERT_TRUE(japan);
  std::array<Point3, 1> tokyo{{{139.75, 35.68, 12}}};
  ASSERT_TRUE(japan->apply(tokyo));
  EXPECT_NEAR(tokyo[0].x, 386884.202, 0.01);
  EXPECT_EQ(tokyo[0].z, 12);
}

TEST(Transformer, LeavesCoordinatesUntouchedWithinOneCrs) {
  for (const auto& [from, to] : {std::pair{"EPSG:25833", "EPSG:25833"},
                                 {"EPSG:25833+5783", "EPSG:25833"},
                                 {"EPSG:7415", "EPSG:28992"},
                                 {"LOCAL", "LOCAL"},
                                 {"", ""}}) {
    const auto transformer = Transformer::create({from}, {to});
    ASSERT_TRUE(transformer);
    EXPECT_TRUE(transformer->is_identity()) << from << " " << to;
  }
}

TEST(Transformer, NamesTheCoordinateItCannotMove) {
  const auto transformer = Transformer::create({"OGC:CRS84"}, {"EPSG:25833"});
  ASSERT_TRUE(transformer);
  std::array<Point3, 2> points{{{13.4, 52.5, 0}, {500, 1e300, 0}}};
  const auto moved = transformer->apply(points);
  ASSERT_FALSE(moved);
  EXPECT_THAT(moved.error().message, HasSubstr("500"));
  EXPECT_FALSE(Transformer::create({"LOCAL"}, {"EPSG:25833"}));
  EXPECT_FALSE(Transformer::create({"EPSG:25833"}, {"EPSG:999999"}));
}

}  // namespace
}  // namespace citymesh
