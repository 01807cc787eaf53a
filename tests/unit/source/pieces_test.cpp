#include <filesystem>

#include "core/source/scan.h"
#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

bool same(const Geometry& a, const Geometry& b) {
  if (a.type != b.type || a.lod != b.lod || a.assembled != b.assembled || a.points != b.points ||
      a.polygons.size() != b.polygons.size() || a.solids.size() != b.solids.size())
    return false;
  for (std::size_t i = 0; i < a.polygons.size(); ++i)
    if (a.polygons[i].rings != b.polygons[i].rings || a.polygons[i].gml_id != b.polygons[i].gml_id)
      return false;
  return true;
}

bool same(const Building& a, const Building& b) {
  if (a.gml_id != b.gml_id || a.attributes != b.attributes || a.parts.size() != b.parts.size() ||
      a.surfaces.size() != b.surfaces.size() || a.geometries.size() != b.geometries.size() ||
      a.source_issues.size() != b.source_issues.size())
    return false;
  for (std::size_t i = 0; i < a.geometries.size(); ++i)
    if (!same(a.geometries[i], b.geometries[i])) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i)
    if (!same(a.parts[i], b.parts[i])) return false;
  return true;
}

/// A packed copy cannot be read in pieces.
std::filesystem::path packed_copy(const std::filesystem::path& file, const TempFolder& folder) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto path = folder / (file.filename().string() + ".gz");
  gzFile out = gzopen(path.c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  return path;
}

std::vector<Building> read_all(const std::filesystem::path& path, unsigned threads) {
  std::vector<Building> buildings;
  auto source = open_files({path}, {});
  EXPECT_TRUE(source);
  RunContext context;
  context.threads = threads;
  const auto selection = (*source)->select({}, context);
  EXPECT_TRUE(selection);
  const auto read = (*source)->read(
      {}, *selection,
      [&](Building&& building) -> Result<void> {
        buildings.push_back(std::move(building));
        return {};
      },
      context);
  EXPECT_TRUE(read) << read.error().message;
  return buildings;
}

TEST(Pieces, GiveTheSameBuildingsAsReadingFromTheFrontOnAnyNumberOfThreads) {
  const std::filesystem::path data = CITYMESH_TEST_DATA;
  const TempFolder folder;
  for (const char* file :
       {"berlin/3910_5817.gml", "berlin/3900_5819.gml", "citygml1/zurich_lod2.gml",
        "citygml2/building_and_garage_lod2.gml", "citygml2/delft_lod1.gml",
        "cityjson/lod2_buildings_as_CityJSON_features.jsonl", "fzk-haus/fzk_haus_lod3_v2.gml"}) {
    const auto front = read_all(packed_copy(data / file, folder), 1);
    ASSERT_FALSE(front.empty());
    for (const unsigned threads : {1u, 3u}) {
      const auto pieces = read_all(data / file, threads);
      ASSERT_EQ(pieces.size(), front.size()) << file;
      for (std::size_t i = 0; i < front.size(); ++i)
        EXPECT_TRUE(same(pieces[i], front[i])) << file << " " << front[i].gml_id;
    }
  }
}

TEST(Pieces, AreFoundInDocumentsOfAnyEncodingThatHasAByteForASign) {
  std::string text = city_model(simple_building("eins", 0, 0) + simple_building("zwei", 50, 0));
  text.replace(0, text.find("?>") + 2, "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>");
  text.insert(text.find("<bldg:Building"),
              "<!-- Stra\xDF"
              "e -->");
  const auto attribute = text.find("<bldg:boundedBy");
  text.insert(attribute,
              "<gen:stringAttribute name=\"Stra\xDF"
              "e\"><gen:value>M\xFChlweg</gen:value>"
              "</gen:stringAttribute>");
  Documents documents;
  documents.add("latin1.gml", text);
  BuildingQuery query;
  query.object_ids = {"zwei"};
  EXPECT_THAT(documents.read(query).ids(), ElementsAre("zwei"));
  const Reading all = documents.read();
  ASSERT_THAT(all.ids(), ElementsAre("eins", "zwei"));
  ASSERT_THAT(all.buildings[0].attributes, ::testing::SizeIs(1));
  EXPECT_EQ(all.buildings[0].attributes[0].first, "Straße");
  EXPECT_EQ(std::get<std::string>(all.buildings[0].attributes[0].second), "Mühlweg");
}

TEST(Pieces, InheritTheCrsOfWhatIsLeftOut) {
  Documents documents;
  documents.add("a.gml", city_model(envelope("EPSG:25833", "390000 5820000 0", "390100 5820100 9") +
                                    simple_building("a", 390000, 5820000) +
                                    simple_building("b", 390050, 5820000)));
  BuildingQuery query;
  query.object_ids = {"b"};
  const Reading reading = documents.read(query);
  EXPECT_EQ(reading.selection.crs.id, "EPSG:25833");
  ASSERT_THAT(reading.ids(), ElementsAre("b"));
  EXPECT_THAT(reading.buildings[0].source_issues, IsEmpty());
  EXPECT_EQ(reading.buildings[0].geometries.at(0).points.at(0).x, 50);
}

TEST(Pieces, ByteRangesHoldExactlyTheFeature) {
  const std::filesystem::path file =
      std::filesystem::path(CITYMESH_TEST_DATA) / "berlin/3900_5819.gml";
  const auto scan = source::scan_file(source::plain_file(file), {}, false, {});
  ASSERT_TRUE(scan);
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  ASSERT_FALSE(scan->records.empty());
  for (const source::BuildingRecord& building : scan->records) {
    ASSERT_TRUE(building.bytes.known());
    const std::string piece =
        text.substr(building.bytes.begin, building.bytes.end - building.bytes.begin);
    EXPECT_EQ(piece.substr(0, 14), "<bldg:Building");
    EXPECT_EQ(piece.substr(piece.size() - 16), "</bldg:Building>");
  }
}

}  // namespace
}  // namespace citymesh
