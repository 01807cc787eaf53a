#include "core/processes/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/processes/processes.h"

namespace citymesh {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kExport = "export-for-simulation";

Error refused(std::string_view json) {
  const auto canonical = canonical_inputs(kExport, json);
  EXPECT_FALSE(canonical) << canonical->json;
  return canonical ? Error{} : canonical.error();
}

TEST(Inputs, DefaultsCompleteWhatIsNotGiven) {
  const auto canonical = canonical_inputs(kExport, "");
  ASSERT_TRUE(canonical);
  const auto json = nlohmann::json::parse(canonical->json);
  EXPECT_EQ(json["formats"], nlohmann::json::array({"obj"}));
  EXPECT_EQ(json["lod"], nlohmann::json::array({"2", "3", "1", "0"}));
  EXPECT_EQ(json["on_failure"], "block");
  EXPECT_EQ(json["snap_tolerance_m"], 0.001);
  EXPECT_TRUE(json["bbox"].is_null());
  for (const OptionSpec& option : find_process(kExport)->inputs)
    EXPECT_TRUE(json.contains(std::string(option.name))) << option.name;
}

TEST(Inputs, HealGivesACityModelBackUnlessAskedForMore) {
  const auto canonical = canonical_inputs("heal", "");
  ASSERT_TRUE(canonical) << canonical.error().message;
  const auto json = nlohmann::json::parse(canonical->json);
  EXPECT_EQ(json["formats"], nlohmann::json::array({"cityjson"}));
  for (const OptionSpec& option : find_process("heal")->inputs)
    EXPECT_TRUE(json.contains(std::string(option.name))) << option.name;
  EXPECT_FALSE(find_process("heal")->async_only);
  for (const Format& format : formats()) {
    const std::string key(format.key);
    EXPECT_TRUE(canonical_inputs("heal", R"({"formats":[")" + key + "\"]}")) << key;
  }
}

TEST(Inputs, TheLimitsOfHealingAreRead) {
  for (const std::string_view process : {kExport, std::string_view("heal")}) {
    const auto canonical = canonical_inputs(process, R"({"snap_tolerance_m":0.002,
        "planarity_tolerance_m":0.02,"max_displacement_m":0.3,"max_hole_area_m2":25,
        "parts":"keep","on_failure":"drop"})");
    ASSERT_TRUE(canonical) << canonical.error().message;
    const auto& inputs = canonical->values;
    EXPECT_EQ(inputs.snap_tolerance_m, 0.002);
    EXPECT_EQ(inputs.planarity_tolerance_m, 0.02);
    EXPECT_EQ(inputs.max_displacement_m, 0.3);
    EXPECT_EQ(inputs.max_hole_area_m2, 25);
    EXPECT_FALSE(inputs.merge_parts);
    EXPECT_FALSE(inputs.block_on_failure);
  }
  EXPECT_THAT(refused(R"({"max_hole_area_m2":-1})").message, HasSubstr("0 to 1000000"));
  EXPECT_THAT(refused(R"({"parts":"split"})").message, HasSubstr("keep, merge"));
}

TEST(Inputs, CanonicalFormIsAFixedPoint) {
  const auto once =
      canonical_inputs(kExport, R"({"formats":"stl","bbox":{"bbox":[13.3,52.5,13.4,52.6]}})");
  ASSERT_TRUE(once);
  const auto twice = canonical_inputs(kExport, once->json);
  ASSERT_TRUE(twice);
  EXPECT_EQ(once->json, twice->json);
}

TEST(Inputs, TheTableOfFormatsIsTheTableOfWriters) {
  for (const OptionSpec& option : find_process(kExport)->inputs)
    if (option.name == "formats") {
      ASSERT_EQ(option.choices.size(), formats().size());
      for (std::size_t i = 0; i < formats().size(); ++i)
        EXPECT_EQ(option.choices[i], formats()[i].key);
    }
}

TEST(Inputs, ABoxIsCrs84UnlessItSaysSo) {
  const auto canonical = canonical_inputs(kExport, R"({"bbox":{"bbox":[13.3,52.5,13.4,52.6]}})");
  ASSERT_TRUE(canonical);
  const auto& inputs = canonical->values;
  EXPECT_EQ(inputs.query.bbox->crs.id, "OGC:CRS84");
  EXPECT_EQ(inputs.query.bbox->min_x, 13.3);
}

TEST(Inputs, AGeographicEpsgBoxIsLatitudeFirst) {
  const auto canonical = canonical_inputs(
      kExport,
      R"({"bbox":{"bbox":[52.5,13.3,52.6,13.4],"crs":"http://www.opengis.net/def/crs/EPSG/0/4326"}})");
  ASSERT_TRUE(canonical);
  const auto& inputs = canonical->values;
  EXPECT_EQ(inputs.query.bbox->min_x, 13.3);
  EXPECT_EQ(inputs.query.bbox->max_y, 52.6);
}

TEST(Inputs, ASixNumberBoxLimitsTheHeight) {
  const auto canonical =
      canonical_inputs(kExport, R"({"bbox":{"bbox":[1,2,3,4,5,6],"crs":"EPSG:25833"}})");
  ASSERT_TRUE(canonical);
  const auto& inputs = canonical->values;
  ASSERT_TRUE(inputs.query.bbox->z_range_m);
  EXPECT_EQ((*inputs.query.bbox->z_range_m)[1], 6);
}

TEST(Inputs, ABoxIsAsLargeAsItIsOnTheGround) {
  const auto area_km2 = [](const std::string& numbers, const std::string& crs) {
    const auto inputs =
        canonical_inputs(kExport, R"({"bbox":{"bbox":)" + numbers + R"(,"crs":")" + crs + "\"}}");
    EXPECT_TRUE(inputs) << inputs.error().message;
    return inputs ? inputs->values.area_km2 : -1;
  };
  // A tenth of a degree at 60° north: 11.1 km by 5.6 km.
  EXPECT_NEAR(area_km2("[10.0, 60.0, 10.1, 60.1]", "OGC:CRS84"), 61.7, 0.2);
  EXPECT_NEAR(area_km2("[10.0, 0.0, 10.1, 0.1]", "OGC:CRS84"), 123.7, 0.1);
  EXPECT_NEAR(area_km2("[60.0, 10.0, 60.1, 10.1]", "EPSG:4326"), 61.7, 0.2) << "latitude first";
  EXPECT_NEAR(area_km2("[390000, 5800000, 399000, 5809000]", "EPSG:25833"), 81, 1e-9);
  EXPECT_NEAR(area_km2("[0, 0, 30000, 30000]", "EPSG:2263"), 83.6, 0.1) << "feet";
  EXPECT_EQ(canonical_inputs(kExport, "{}")->values.area_km2, 0);
}

TEST(Inputs, WrongValuesAreNamedWithWhatIsExpected) {
  EXPECT_THAT(refused(R"({"bogus":1})").message, HasSubstr("`bogus`"));
  EXPECT_THAT(refused(R"({"bogus":1})").message, HasSubstr("bbox_rule"));
  EXPECT_THAT(refused(R"({"formats":["dwg"]})").message, HasSubstr("\"dwg\""));
  EXPECT_THAT(refused(R"({"formats":["dwg"]})").message, HasSubstr("stl_binary"));
  EXPECT_THAT(refused(R"({"formats":7})").message, HasSubstr("list of texts"));
  EXPECT_THAT(refused(R"({"on_failure":"explode"})").message, HasSubstr("block, drop"));
  EXPECT_THAT(refused(R"({"unite_neighbours":"yes"})").message, HasSubstr("true or false"));
  EXPECT_THAT(refused(R"({"snap_tolerance_m":-1})").message, HasSubstr("0.0001 to 1"));
  EXPECT_THAT(refused(R"({"snap_tolerance_m":"1"})").message, HasSubstr("a number"));
  EXPECT_THAT(refused(R"({"lod":[]})").message, HasSubstr("`lod`"));
  EXPECT_THAT(refused(R"({"lod":["high"]})").message, HasSubstr("high"));
  EXPECT_THAT(refused(R"({"crs":"EPSG:99999999"})").message, HasSubstr("`crs`"));
  EXPECT_THAT(refused(R"({"crs":"EPSG:4326"})").message, HasSubstr("geographic"));
  EXPECT_THAT(refused(R"({"source_crs":"EPSG:99999999"})").message, HasSubstr("`source_crs`"));
  EXPECT_THAT(refused(R"({"axis_order":"up"})").message, HasSubstr("north_east"));
}

TEST(Inputs, APolygonIsARegionWithItsBox) {
  const auto canonical =
      canonical_inputs(kExport, R"({"polygon":{"type":"MultiPolygon","coordinates":[
        [[[0,0],[100,0],[100,100],[0,100],[0,0]],[[10,10],[20,10],[20,20],[10,20],[10,10]]],
        [[[200,0,5],[300,0,5],[300,100,5],[200,0,5]]]],"coordRefSys":"EPSG:25833"}})");
  ASSERT_TRUE(canonical) << canonical.error().message;
  const auto& box = *canonical->values.query.bbox;
  EXPECT_EQ(box.crs.id, "EPSG:25833");
  ASSERT_EQ(box.rings.size(), 3u);
  EXPECT_EQ(box.rings[0].size(), 4u) << "not closed";
  EXPECT_EQ(box.rings[2][1], (std::array<double, 2>{300, 0}));
  EXPECT_EQ(box.max_x, 300);
  EXPECT_EQ(box.min_y, 0);
  EXPECT_NEAR(canonical->values.area_km2, (10'000 - 100 + 5'000) / 1e6, 1e-12);
  const auto again = canonical_inputs(kExport, canonical->json);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->json, canonical->json);
}

TEST(Inputs, APolygonIsCrs84UnlessItSaysSoAndThenInItsAxisOrder) {
  const auto degrees = canonical_inputs(
      kExport,
      R"({"polygon":{"type":"Polygon","coordinates":[[[13,52],[14,52],[14,53],[13,52]]]}})");
  ASSERT_TRUE(degrees) << degrees.error().message;
  EXPECT_EQ(degrees->values.query.bbox->crs.id, "OGC:CRS84");
  EXPECT_EQ(degrees->values.query.bbox->min_x, 13);
  const auto turned = canonical_inputs(
      kExport, R"({"polygon":{"type":"Polygon","coordinates":[[[52,13],[52,14],[53,14],[52,13]]],
               "coordRefSys":"EPSG:4326"}})");
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_EQ(turned->values.query.bbox->rings, degrees->values.query.bbox->rings);
  EXPECT_EQ(turned->values.area_km2, degrees->values.area_km2);
}

TEST(Inputs, WrongPolygonsAreNamed) {
  const auto message = [](const std::string& polygon) {
    return refused(R"({"polygon":)" + polygon + "}").message;
  };
  const auto of_ring = [&](const std::string& ring) {
    return message(R"({"type":"Polygon","coordinates":[)" + ring + "]}");
  };
  EXPECT_THAT(message("[1,2]"), HasSubstr("GeoJSON Polygon or MultiPolygon"));
  EXPECT_THAT(message(R"({"type":"Point","coordinates":[1,2]})"), HasSubstr("MultiPolygon"));
  EXPECT_THAT(message(R"({"type":"Polygon","coordinates":[]})"), HasSubstr("at least one ring"));
  EXPECT_THAT(message(R"({"type":"MultiPolygon","coordinates":7})"), HasSubstr("one polygon"));
  EXPECT_THAT(of_ring("[[0,0],[1,0],[0,0]]"), HasSubstr("four positions"));
  EXPECT_THAT(of_ring("[[0,0],[1,0],[1,1],[0,1]]"), HasSubstr("end where they begin"));
  EXPECT_THAT(of_ring(R"([[0,0],[1,"x"],[1,1],[0,0]])"), HasSubstr("finite numbers"));
  EXPECT_THAT(message(R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]],"bbox":[]})"),
              HasSubstr("`bbox`"));
  EXPECT_THAT(refused(R"({"bbox":{"bbox":[1,2,3,4]},
                "polygon":{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}})")
                  .message,
              HasSubstr("both given"));
  std::string many;
  for (int i = 0; i < 10'001; ++i) many += "[0,0],";
  many.pop_back();
  EXPECT_EQ(refused(R"({"polygon":{"type":"Polygon","coordinates":[[)" + many + "]]}}").code,
            ErrorCode::ResourceExhausted);
}

TEST(Inputs, WrongBoxesAreNamed) {
  EXPECT_THAT(refused(R"({"bbox":[1,2,3,4]})").message, HasSubstr("`bbox`"));
  EXPECT_THAT(refused(R"({"bbox":{"bbox":[1,2,3]}})").message, HasSubstr("6 numbers"));
  EXPECT_THAT(refused(R"({"bbox":{"bbox":[3,2,1,4]}})").message, HasSubstr("axis 1"));
  EXPECT_THAT(refused(R"({"bbox":{"bbox":[1,2,3,"x"]}})").message, HasSubstr("finite"));
  EXPECT_THAT(refused(R"({"bbox":{"bbox":[1,2,3,4],"crs":"nowhere"}})").message,
              HasSubstr("nowhere"));
}

TEST(Inputs, BrokenJsonIsRefusedWithItsPlace) {
  EXPECT_THAT(refused(R"({"formats":)").message, HasSubstr("not valid JSON"));
  EXPECT_THAT(refused("[1]").message, HasSubstr("JSON object"));
  EXPECT_EQ(refused("{\"a\":" + std::string(100000, '[')).code, ErrorCode::InvalidArgument);
  EXPECT_EQ(refused(std::string(9u << 20, ' ')).code, ErrorCode::ResourceExhausted);
}

TEST(Inputs, AnUnknownProcessIsNotFoundAndTheOthersAreNamed) {
  const auto canonical = canonical_inputs("melt", "{}");
  ASSERT_FALSE(canonical);
  EXPECT_EQ(canonical.error().code, ErrorCode::NotFound);
  EXPECT_THAT(canonical.error().message, HasSubstr(std::string(kExport)));
}

TEST(Inputs, WhatIsNotBuiltIsSaidSo) {
  EXPECT_EQ(refused(R"({"unite_neighbours":true})").code, ErrorCode::Unimplemented);
}

}  // namespace
}  // namespace citymesh
