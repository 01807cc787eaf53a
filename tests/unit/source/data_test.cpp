// Reads the real data that README.md of CITYMESH_EXTRA_DATA describes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/source/source.h"

namespace citymesh {
namespace {

struct KnownFile {
  const char* path;
  const char* format;
  std::uint64_t buildings;
  std::uint64_t parts;
  const char* crs;  // working CRS
};

constexpr KnownFile kKnownFiles[] = {
    {"berlin-lod2/3910_5817.gml", "CityGML 2.0", 166, 15, "EPSG:25833"},
    {"berlin-lod2/3900_5820.gml.gz", "CityGML 2.0", 75, 0, "EPSG:25833"},
    {"berlin-lod2/3920_5818.gml", "CityGML 2.0", 72, 0, "EPSG:25833"},
    {"berlin-lod2/3910_5819.gml", "CityGML 2.0", 35, 0, "EPSG:25833"},
    {"berlin-lod2/3910_5820.gml.gz", "CityGML 2.0", 56, 0, "EPSG:25833"},
    {"berlin-lod2/3900_5819.gml", "CityGML 2.0", 4, 0, "EPSG:25833"},
    {"berlin-lod2/3920_5820.gml", "CityGML 2.0", 6, 0, "EPSG:25833"},
    {"berlin-gasometer-lod2/Gasometer_tile_0_0.gml.gz", "CityGML 1.0", 118, 0, "EPSG:3068+5783"},
    {"potsdam-lod1/Potsdam_LoD1.gml", "CityGML 1.0", 97, 0, "EPSG:25833+5783"},
    {"nrw-lod2/LoD2_32_280_5659_1_NW.gml", "CityGML 1.0", 109, 55, "EPSG:25832+7837"},
    {"saxony-lod2/LoD2_33_416_5656_2_SN_14_buildings.gml", "CityGML 1.0", 14, 7, "EPSG:25833+7837"},
    {"vienna-lod2/Karl-Marx-Hof.gml.gz", "CityGML 2.0", 1, 218, "EPSG:31256"},
    {"vienna-lod2/Fichtegasse.gml", "CityGML 2.0", 1, 12, "EPSG:31256"},
    {"vienna-lod2/vienna.city.jsonl", "CityJSONSeq 1.1", 149, 443, ""},
    {"helsinki-lod2/2549_6674.gml", "CityGML 2.0", 61, 0, "EPSG:3879"},
    {"lyon-opera-curved/Opera-Lyon_CityGML3.0_LOD2.gml", "CityGML 3.0", 1, 0, "EPSG:3946"},
    {"plateau/53395404_bldg_6697_op.gml.gz", "CityGML 2.0", 657, 0, "EPSG:6691+6695"},
    {"plateau/51311568_bldg_6697_op.gml.gz", "CityGML 2.0", 225, 0, "EPSG:6689+6695"},
    {"plateau/54363371_bldg_6697_komatsu_lod1_lod2.gml.gz", "CityGML 2.0", 192, 0,
     "EPSG:6690+6695"},
    {"plateau/53404336_bldg_6697_tako.gml", "CityGML 2.0", 98, 0, "EPSG:6691+6695"},
    {"plateau/13101-bldg-365_lod2_highrise.gml", "CityGML 2.0", 1, 0, "EPSG:6691+6695"},
    {"plateau/53394517_bldg_6697_2_op_CityGML2.gml", "CityGML 2.0", 1, 0, "EPSG:6691+6695"},
    {"plateau/53394517_bldg_6697_2_op_CityGML3.gml", "CityGML 3.0", 1, 0, "EPSG:6691+6695"},
    {"plateau/yokosuka/52397519_bldg_6697_op.gml", "CityGML 2.0", 13, 2, "EPSG:6691+6695"},
    {"ingolstadt-lod3/4018106.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018133.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018147.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018148.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018152a.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018155.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018193.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018204c.xml", "CityGML 2.0", 1, 1, "EPSG:32632"},
    {"ingolstadt-lod3/4018207.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018213.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018259.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018264.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/4018302.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"ingolstadt-lod3/0000000.xml", "CityGML 2.0", 1, 0, "EPSG:32632"},
    {"fzk-haus/fzk_haus_lod0_v2.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"fzk-haus/fzk_haus_lod1_v2.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"fzk-haus/fzk_haus_lod2_v2.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"fzk-haus/fzk_haus_lod3_v2.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_LOD0-EPSG25832.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_LOD1-EPSG25832.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_LOD1-LocalEngineeringCRS.gml", "CityGML 2.0", 1, 0, "LOCAL"},
    {"ogc-examples/v2/Building_LOD2-EPSG25832.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_LOD3-EPSG25832.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_LOD4-EPSG25832.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v2/Building_and_garage_LOD2-EPSG25832.gml", "CityGML 2.0", 1, 1,
     "EPSG:25832+5783"},
    {"ogc-examples/v3/Building_LOD0-EPSG25832.gml", "CityGML 3.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v3/Building_LOD1-EPSG25832.gml", "CityGML 3.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v3/Building_LOD2-EPSG25832.gml", "CityGML 3.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v3/Building_LOD3-EPSG25832.gml", "CityGML 3.0", 1, 0, "EPSG:25832+5783"},
    {"ogc-examples/v3/Building_and_garage_LOD2-EPSG25832.gml", "CityGML 3.0", 1, 1,
     "EPSG:25832+5783"},
    {"ogc-examples/v3/JeffersonBuilding_CityGML3.0_LOD1_with_xAL3_CommonTypes.gml", "CityGML 3.0",
     1, 0, "EPSG:32618"},
    {"citygml4j-samples/lod2_buildings_v3.gml", "CityGML 3.0", 100, 0, "EPSG:3068+5783"},
    {"citygml4j-samples/lod2_buildings_v2.json", "CityJSON 2.0", 100, 0, "EPSG:3068"},
    {"citygml4j-samples/lod2_buildings_as_CityJSON_features.jsonl", "CityJSONSeq 2.0", 100, 0, ""},
    {"citygml4j-samples/lod4_building_v2.gml", "CityGML 2.0", 1, 0, "EPSG:25832+5783"},
    {"small-cities/zurich-lod2-citygml1.gml", "CityGML 1.0", 4, 6, "EPSG:21781"},
    {"small-cities/delft-lod1-citygml2.gml", "CityGML 2.0", 3, 0, "EPSG:7415"},
    {"small-lod4/su_building_lod4.gml", "CityGML 1.0", 1, 0, ""},
    {"cityjson/3-20-DELFSHAVEN.city.json", "CityJSON 2.0", 853, 0, "EPSG:28992"},
    {"cityjson/rotterdam_subset.json", "CityJSON 2.0", 16, 0, ""},
    {"cityjson/3dbag_delft_noise_extension.city.jsonl", "CityJSONSeq 1.1", 99, 100, "EPSG:7415"},
    {"cityjson/3dbag_tile_901.city.jsonl", "CityJSONSeq 1.1", 52, 52, "EPSG:7415"},
    {"cityjson/multi_lod.json", "CityJSON 2.0", 10, 0, ""},
    {"cityjson/building_with_innerring.city.json", "CityJSON 1.0", 1, 0, "EPSG:2056"},
    {"delft-3dfier-area/testarea.city.json", "CityJSON 1.0", 160, 0, "EPSG:7415"},
    {"delft-3dfier-area/delft.city.json", "CityJSON 2.0", 160, 0, "EPSG:7415"},
};

void PrintTo(const KnownFile& file, std::ostream* out) { *out << file.path; }

class RealData : public ::testing::TestWithParam<KnownFile> {};

TEST_P(RealData, IsReadWithAllBuildingsPartsAndItsCrs) {
  const char* folder = std::getenv("CITYMESH_EXTRA_DATA");
  if (!folder) GTEST_SKIP() << "CITYMESH_EXTRA_DATA is not set: no data outside of the repository";
  const KnownFile& known = GetParam();
  const auto path = std::filesystem::path(folder) / known.path;

  auto source = open_files({path}, {});
  ASSERT_TRUE(source) << source.error().message;
  const auto selection = (*source)->select({}, {});
  ASSERT_TRUE(selection) << selection.error().message;
  ASSERT_EQ(selection->inputs.size(), 1u);
  EXPECT_EQ(selection->inputs[0].state, "read") << selection->inputs[0].message;
  EXPECT_EQ(selection->inputs[0].format, known.format);
  EXPECT_EQ(selection->inputs[0].buildings, known.buildings);
  EXPECT_EQ(selection->buildings, known.buildings);
  EXPECT_EQ(selection->crs.id, known.crs);

  std::uint64_t buildings = 0, parts = 0, installations = 0, empty = 0, issues = 0;
  Box3 whole;
  const auto done = (*source)->read({}, *selection,
                                    [&](Building&& building) -> Result<void> {
                                      ++buildings;
                                      parts += building.parts.size();
                                      installations += building.installations.size();
                                      for (const Building& part : building.parts)
                                        installations += part.installations.size();
                                      issues += building.source_issues.size();
                                      for (const Building& part : building.parts)
                                        issues += part.source_issues.size();
                                      const Box3 box = extent(building);
                                      if (box.is_empty()) ++empty;
                                      whole.add(box);
                                      return {};
                                    },
                                    {});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(buildings, known.buildings);
  EXPECT_EQ(parts, known.parts);
  EXPECT_EQ(selection->object_ids.size(), buildings + parts + installations);
  EXPECT_EQ(empty, 0u);
  EXPECT_EQ(issues, 0u);
  // Relative to an origin at the lower corner of what the file declares or holds.
  EXPECT_GT(whole.min.x, -5000);
  EXPECT_LT(whole.max.x, 20000);
  EXPECT_GT(whole.min.y, -5000);
  EXPECT_LT(whole.max.y, 20000);
}

INSTANTIATE_TEST_SUITE_P(Known, RealData, ::testing::ValuesIn(kKnownFiles), [](const auto& known) {
  std::string name = known.param.path;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace citymesh
