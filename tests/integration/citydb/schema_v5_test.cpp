#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "services/citydb/schema.h"
#include "tests/support/citydb/citydb_test.h"

namespace citymesh::citydb {
namespace {

using citydb_support::CityDbTest;
using citydb_support::Database;
using postgres::Connection;
using postgres::Statement;
using source::Feature;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Version 5 as its tables are written by hand.
class SchemaV5 : public CityDbTest {
 protected:
  /// The house of the fixture, then `more`.
  void open(int minor, const std::string& more = {}) {
    const auto url = server().create_citydb({.major = 5, .minor = minor});
    ASSERT_TRUE(url) << url.error().message;
    const auto sql = citydb_support::citydb_file("fixture_v5.sql");
    ASSERT_TRUE(sql) << sql.error().message;
    auto database = Database::open(*url);
    ASSERT_TRUE(database) << database.error().message;
    for (const auto& statements : {*sql, more})
      if (const auto done = database->run("SET search_path TO citydb, public;" + statements); !done)
        FAIL() << done.error().message;

    auto connection = Connection::open({.url = *url});
    ASSERT_TRUE(connection) << connection.error().message;
    connection_ = *std::move(connection);
    const Statement path{"SELECT set_config('search_path', 'citydb, public', false)"};
    ASSERT_TRUE(connection_->run(path, {}));
    auto instance = look_at(*connection_, "citydb", {});
    ASSERT_TRUE(instance) << instance.error().message;
    instance_ = *std::move(instance);
  }

  /// The values of a column, as text.
  std::vector<std::string> texts(const Statement& statement, int column) {
    const auto rows = connection_->run(statement, {});
    EXPECT_TRUE(rows) << rows.error().message;
    std::vector<std::string> found;
    for (int row = 0; rows && row < rows->size(); ++row)
      found.emplace_back(rows->text(row, column));
    return found;
  }

  std::vector<std::string> candidates(const std::optional<source::FlatBox>& box = {}) {
    return texts(schema_->candidates(instance_, box), 1);
  }

  std::vector<std::string> candidates_by_id(const std::vector<std::string>& ids) {
    return texts(schema_->candidates_by_id(instance_, ids), 1);
  }

  Result<std::vector<Feature>> read(const std::vector<std::int64_t>& ids) {
    const auto tables = schema_->fetch(*connection_, instance_, ids, {});
    if (!tables) return tables.error();
    source::DocumentFacts facts;
    facts.intern_srs(instance_.srs_name);
    FeatureBuilder builder(facts, 1, {});
    std::vector<Feature> features;
    auto built = schema_->build(*tables, instance_, builder, [&](Feature& feature) -> Result<void> {
      features.push_back(feature);
      return {};
    });
    if (!built) return built.error();
    return features;
  }

  Feature house() {
    auto read_ones = read({1});
    EXPECT_TRUE(read_ones) << read_ones.error().message;
    return read_ones && read_ones->size() == 1 ? read_ones->front() : Feature{};
  }

  std::unique_ptr<const Schema> schema_ = schema_v5();
  std::optional<Connection> connection_{};
  Instance instance_{};
};

std::string ids_of_objects(const Feature& feature) {
  std::string text;
  for (const auto& object : feature.objects)
    text += fmt::format("{} {} in {}\n", to_string(object.kind), object.gml_id, object.parent);
  return text;
}

std::string surfaces_of(const source::RawObject& object) {
  std::string text;
  for (const auto& surface : object.surfaces)
    text += fmt::format("{} {} in {}\n", to_string(surface.type), surface.gml_id, surface.parent);
  return text;
}

std::string attributes_of(const source::RawObject& object) {
  std::string text;
  for (const auto& [name, value] : object.attributes)
    text += name + std::visit(
                       [](const auto& held) {
                         using Held = std::decay_t<decltype(held)>;
                         if constexpr (std::is_same_v<Held, std::string>)
                           return fmt::format(" '{}'\n", held);
                         else if constexpr (std::is_same_v<Held, double>)
                           return fmt::format(" {:#}\n", held);
                         else
                           return fmt::format(" {}\n", held);
                       },
                       value);
  return text;
}

/// "Solid 2: p_south of walls, ...", a '-' before reversed uses.
std::string shapes_of(const Feature& feature, std::size_t index) {
  const auto& object = feature.objects[index];
  std::string text;
  for (const auto& shape : object.shapes) {
    constexpr std::array kNames{"MultiSurface", "CompositeSurface", "Solid", "MultiSolid",
                                "CompositeSolid"};
    text += fmt::format("{} {}{}{}:", kNames[static_cast<std::size_t>(shape.type)],
                        to_string(shape.lod), shape.assembled ? " assembled" : "",
                        shape.footprint ? " footprint" : "");
    for (const auto& use : shape.uses) {
      const auto& polygon = feature.polygons[use.polygon];
      const auto surface = use.surface >= 0 ? use.surface : polygon.surface;
      text += fmt::format(" {}{}", use.reversed ? "-" : "", polygon.gml_id);
      if (surface >= 0) text += "/" + object.surfaces[static_cast<std::size_t>(surface)].gml_id;
    }
    if (!shape.solids.empty()) text += fmt::format(" ({} solids)", shape.solids.size());
    text += '\n';
  }
  return text;
}

TEST_F(SchemaV5, HandsOverTheHouseOfTheFixtureAsAFileWouldHaveIt) {
  for (const int minor : {0, 1}) {  // json and jsonb
    ASSERT_NO_FATAL_FAILURE(open(minor));
    const auto feature = house();
    EXPECT_EQ(ids_of_objects(feature),
              "Building house in -1\n"
              "BuildingInstallation antenna in 0\n"
              "BuildingPart annex in 0\n");
    ASSERT_EQ(feature.objects.size(), 3u);
    EXPECT_EQ(surfaces_of(feature.objects[0]),
              "WallSurface walls in -1\n"
              "RoofSurface roof in -1\n"
              "GroundSurface ground in -1\n");
    EXPECT_EQ(surfaces_of(feature.objects[2]),
              "WallSurface annex_front in -1\n"
              "Window annex_window in 0\n"
              "WallSurface annex_walls in -1\n"
              "RoofSurface annex_roof in -1\n"
              "GroundSurface annex_ground in -1\n"
              "ClosureSurface annex_closure in -1\n");
    // Faces of the solid are the polygons of the surfaces, by their ids.
    EXPECT_EQ(shapes_of(feature, 0),
              "Solid 2: p_south/walls p_east/walls p_north/walls p_west/walls p_roof/roof"
              " p_ground/ground (1 solids)\n"
              "MultiSurface 2 assembled: p_south/walls p_east/walls p_north/walls p_west/walls"
              " p_roof/roof p_ground/ground\n");
    EXPECT_EQ(shapes_of(feature, 2),
              "MultiSurface 3 assembled: a_south/annex_front a_window/annex_window"
              " a_east/annex_walls a_north/annex_walls a_roof/annex_roof a_ground/annex_ground"
              " a_closure/annex_closure\n");
    for (const auto& object : feature.objects) EXPECT_THAT(object.issues, IsEmpty());
    const auto is_front = [](const auto& polygon) { return polygon.gml_id == "a_south"; };
    const auto front = std::ranges::find_if(feature.polygons, is_front);
    ASSERT_NE(front, feature.polygons.end());
    EXPECT_EQ(front->ring_count, 2u) << "the hole of the window";
    EXPECT_EQ(feature.rings[front->first_ring].count, 5u);
    EXPECT_EQ(feature.points[feature.rings[front->first_ring].first],
              (Point3{500010, 5700000, 100}));
  }
}

TEST_F(SchemaV5, PutsImplicitGeometryAtItsAnchor) {
  for (const int minor : {0, 1}) {
    ASSERT_NO_FATAL_FAILURE(open(minor));
    const auto feature = house();
    ASSERT_GE(feature.objects.size(), 2u);
    ASSERT_EQ(feature.objects[1].shapes.size(), 1u);
    const auto& shape = feature.objects[1].shapes.front();
    EXPECT_EQ(shape.lod, (Lod{2}));
    ASSERT_EQ(shape.uses.size(), 4u);
    Box3 box;
    for (const auto& use : shape.uses) {
      const auto& ring = feature.rings[feature.polygons[use.polygon].first_ring];
      for (std::uint32_t p = 0; p < ring.count; ++p) box.add(feature.points[ring.first + p]);
    }
    EXPECT_EQ(box.min, (Point3{500004, 5700004, 106}));
    EXPECT_EQ(box.max, (Point3{500005, 5700005, 108}));
  }
}

TEST_F(SchemaV5, NamesAttributesAsTheReadersOfFilesDo) {
  for (const int minor : {0, 1}) {
    ASSERT_NO_FATAL_FAILURE(open(minor));
    const auto feature = house();
    ASSERT_EQ(feature.objects.size(), 3u);
    EXPECT_EQ(attributes_of(feature.objects[0]),
              "creationDate '2024-05-06'\n"
              "description 'Made of five walls'\n"
              "name 'The house'\n"
              "relativeToTerrain 'entirelyAboveTerrain'\n"
              "owner 'C. Ampersand & Sons'\n"
              "flats 3\n"
              "share 0.125\n"
              "page 'https://example.org/house'\n"
              "inspected '2023-02-01'\n"
              "area 80.5\n"
              "heat.kWh 12500.0\n"
              "class '1000'\n"
              "function '1100;1200'\n"
              "dateOfConstruction '1950-01-01'\n"
              "roofType '1010'\n"
              "measuredHeight 6.0\n"
              "storeysAboveGround 2\n"
              "storeyHeightsAboveGround '3.5 2.5'\n");
    EXPECT_EQ(attributes_of(feature.objects[1]),
              "creationDate '2024-05-06'\n"
              "function '1020'\n");
    EXPECT_EQ(attributes_of(feature.objects[2]),
              "creationDate '2024-05-06'\n"
              "use 'shed'\n"
              "measuredHeight 3.0\n");
    const Address address{.street = "Turmstrasse",
                          .house_number = "7",
                          .zip_code = "10559",
                          .city = "Berlin",
                          .country = "Germany"};
    EXPECT_THAT(feature.objects[0].addresses, ElementsAre(address));
  }
}

TEST_F(SchemaV5, LeavesOutAttributesMadeOfPartsAndCountsThoseOfExtensions) {
  ASSERT_NO_FATAL_FAILURE(open(1,
                               "INSERT INTO namespace VALUES (10000, 'energy', 'urn:energy', 1);"
                               "INSERT INTO property (id, feature_id, parent_id, datatype_id,"
                               " namespace_id, name, val_int, val_string) VALUES"
                               " (200, 3, NULL, 19, 8, 'occupancy', NULL, NULL),"
                               " (201, 3, 200, 3, 8, 'numberOfOccupants', 4, NULL),"
                               " (202, 3, NULL, 5, 10000, 'boiler', NULL, 'old'),"
                               " (203, 3, NULL, 2, 3, 'listed', 1, NULL),"
                               " (204, 3, NULL, 200, 3, 'outer', NULL, NULL),"
                               " (205, 3, 204, 200, 3, 'inner', NULL, NULL),"
                               " (206, 3, 205, 5, 3, 'deep', NULL, 'x')"));
  const auto feature = house();
  ASSERT_GE(feature.objects.size(), 2u);
  EXPECT_EQ(attributes_of(feature.objects[1]),
            "creationDate '2024-05-06'\n"
            "function '1020'\n"
            "listed true\n"
            "outer.inner.deep 'x'\n");
  EXPECT_THAT(feature.objects[1].skipped_ade_elements, ElementsAre(testing::Pair("boiler", 1u)));
}

TEST_F(SchemaV5, FindsPresentBuildingsByBox) {
  ASSERT_NO_FATAL_FAILURE(open(1));
  EXPECT_THAT(candidates(), ElementsAre("house"));
  EXPECT_THAT(candidates(source::FlatBox{{500009, 5700001}, {500010, 5700002}}),
              ElementsAre("house"));
  EXPECT_THAT(candidates(source::FlatBox{{500020, 5700001}, {500030, 5700002}}), IsEmpty());
  const auto rows = connection_->run(schema_->candidates(instance_, {}), {});
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->integer(0, 0), 1);
  EXPECT_EQ(rows->number(0, 2), 500000);
  EXPECT_EQ(rows->number(0, 7), 108);
  const auto extent = connection_->run(schema_->extent(instance_), {});
  ASSERT_TRUE(extent) << extent.error().message;
  EXPECT_EQ(extent->integer(0, 0), 1);
  EXPECT_EQ(extent->number(0, 1), 500000);
  EXPECT_EQ(extent->number(0, 6), 108);
}

TEST_F(SchemaV5, FindsABuildingByTheIdsOfItsParts) {
  ASSERT_NO_FATAL_FAILURE(open(1));
  for (const auto* id : {"house", "annex", "antenna"})
    EXPECT_THAT(candidates_by_id({id}), ElementsAre("house")) << id;
  EXPECT_THAT(candidates_by_id({"house", "annex", "nobody \"\\{}"}), ElementsAre("house"));
  EXPECT_THAT(candidates_by_id({"walls"}), IsEmpty()) << "a surface is no part";
  EXPECT_THAT(candidates_by_id({}), IsEmpty());
  const std::vector<std::int64_t> house{1};
  EXPECT_THAT(texts(schema_->members(instance_, house), 1), ElementsAre("annex", "antenna"));
}

TEST_F(SchemaV5, LeavesOutWhatWasTerminatedAtEveryLevel) {
  ASSERT_NO_FATAL_FAILURE(
      open(1, "UPDATE feature SET termination_date = now() WHERE objectid IN ('annex', 'roof')"));
  const auto feature = house();
  EXPECT_EQ(ids_of_objects(feature),
            "Building house in -1\n"
            "BuildingInstallation antenna in 0\n");
  ASSERT_FALSE(feature.objects.empty());
  EXPECT_EQ(surfaces_of(feature.objects[0]),
            "WallSurface walls in -1\n"
            "GroundSurface ground in -1\n");
  EXPECT_THAT(candidates_by_id({"annex"}), IsEmpty());
  const std::vector<std::int64_t> house{1};
  EXPECT_THAT(texts(schema_->members(instance_, house), 1), ElementsAre("antenna"));
}

TEST_F(SchemaV5, ComesToAnEndWhereThePartsFormACycle) {
  // The annex has the house for a part, itself, and the walls of the house.
  ASSERT_NO_FATAL_FAILURE(
      open(1,
           "INSERT INTO property (id, feature_id, datatype_id, namespace_id, name,"
           " val_feature_id, val_relation_type) VALUES (200, 2, 10, 10, 'buildingPart', 1, 1),"
           " (201, 2, 10, 10, 'buildingPart', 2, 1), (202, 2, 10, 1, 'boundary', 4, 1),"
           " (203, 12, 10, 8, 'fillingSurface', 7, 1)"));
  const auto feature = house();
  EXPECT_EQ(ids_of_objects(feature),
            "Building house in -1\n"
            "BuildingInstallation antenna in 0\n"
            "BuildingPart annex in 0\n");
  ASSERT_EQ(feature.objects.size(), 3u);
  EXPECT_EQ(feature.objects[0].surfaces.size(), 3u);
  EXPECT_EQ(feature.objects[2].surfaces.size(), 6u);
  EXPECT_THAT(candidates_by_id({"annex"}), ElementsAre("house"));
  const std::vector<std::int64_t> house{1};
  EXPECT_THAT(texts(schema_->members(instance_, house), 1), ElementsAre("annex", "antenna"));
}

TEST_F(SchemaV5, MarksInstallationsInside) {
  ASSERT_NO_FATAL_FAILURE(
      open(1,
           "INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_string)"
           " VALUES (200, 3, 5, 8, 'relationToConstruction', 'inside')"));
  const auto feature = house();
  ASSERT_EQ(feature.objects.size(), 3u);
  EXPECT_TRUE(feature.objects[1].inside);
  EXPECT_FALSE(feature.objects[2].inside);
  const std::vector<std::int64_t> house{1};
  EXPECT_THAT(texts(schema_->members(instance_, house), 1), ElementsAre("annex"));
}

TEST_F(SchemaV5, ReadsEveryTypeOfGeometry) {
  // Two solids in one collection, a footprint, a composite surface, and the old solid without any
  // description; a curve beside them is not ours.
  const std::string face = "((0 0 0, 1 0 0, 1 1 0, 0 0 0))",
                    other = "((5 5 0, 6 5 0, 6 6 0, 5 5 0))";
  ASSERT_NO_FATAL_FAILURE(open(
      1, fmt::format(
             "INSERT INTO geometry_data (id, geometry, geometry_properties) VALUES"
             " (100, 'SRID=25832;GEOMETRYCOLLECTION Z (POLYHEDRALSURFACE Z ({0}, {1}),"
             " POLYHEDRALSURFACE Z ({1}))', '{{\"type\": 11, \"objectId\": \"m\", \"children\": ["
             "{{\"type\": 9, \"objectId\": \"s1\"}}, {{\"type\": 6, \"parent\": 0}},"
             " {{\"type\": 5, \"objectId\": \"f1\", \"parent\": 1, \"geometryIndex\": 0}},"
             " {{\"type\": 5, \"objectId\": \"f2\", \"parent\": 1, \"geometryIndex\": 1}},"
             " {{\"type\": 9, \"objectId\": \"s2\"}}, {{\"type\": 6, \"parent\": 4}},"
             " {{\"type\": 5, \"objectId\": \"f2\", \"parent\": 5, \"geometryIndex\": 2}}]}}'),"
             " (101, 'SRID=25832;MULTIPOLYGON Z ({0})', '{{\"type\": 8, \"objectId\": \"g\","
             " \"children\": [{{\"type\": 5, \"objectId\": \"g1\", \"geometryIndex\": 0}}]}}'),"
             " (102, 'SRID=25832;MULTIPOLYGON Z ({0})', '{{\"type\": 7, \"objectId\": \"t\","
             " \"children\": [{{\"type\": 5, \"objectId\": \"t1\", \"geometryIndex\": 0}}]}}'),"
             " (103, 'SRID=25832;MULTILINESTRING Z ((0 0 0, 1 1 1))', '{{\"type\": 4}}'),"
             " (104, 'SRID=25832;LINESTRING Z (0 0 0, 1 1 1)', '{{\"type\": 3}}');"
             "UPDATE geometry_data SET geometry_properties = NULL WHERE id = 1;"
             "INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_lod,"
             " val_geometry_id) VALUES (200, 1, 11, 1, 'lod3Solid', '3', 100),"
             " (201, 1, 11, 1, 'lod0MultiSurface', '0', 101),"
             " (202, 1, 11, 18, 'lod1MultiSurface', NULL, 102),"
             " (203, 1, 11, 1, 'lod2MultiCurve', '2', 103), (204, 3, 11, 18, 'lod3Geometry', '3', "
             "104)",
             face, other)));
  const auto feature = house();
  ASSERT_EQ(feature.objects.size(), 3u);
  EXPECT_THAT(shapes_of(feature, 0), HasSubstr("Solid 2:       (1 solids)\n"
                                               "MultiSolid 3: f1 f2 f2 (2 solids)\n"
                                               "MultiSurface 0 footprint: g1\n"
                                               "CompositeSurface 1: t1\n"));
  EXPECT_EQ(feature.objects[1].shapes.size(), 1u) << "a line is no surface";
}

TEST_F(SchemaV5, TellsOfGeometryThatIsNotThere) {
  ASSERT_NO_FATAL_FAILURE(open(1,
                               "UPDATE property SET val_geometry_id = 999 WHERE id = 4;"
                               "UPDATE implicit_geometry SET relative_geometry_id = NULL"));
  const auto feature = house();
  ASSERT_EQ(feature.objects.size(), 3u);
  ASSERT_EQ(feature.objects[0].issues.size(), 1u);
  EXPECT_THAT(feature.objects[0].issues[0].where, HasSubstr("999"));
  ASSERT_EQ(feature.objects[1].issues.size(), 1u);
  EXPECT_THAT(feature.objects[1].issues[0].where, HasSubstr("implicit geometry of LoD 2"));
}

TEST_F(SchemaV5, NamesTheGeometryWhoseDescriptionIsDamaged) {
  ASSERT_NO_FATAL_FAILURE(open(1));
  const std::vector<std::pair<std::string, std::string>> damages{
      {"[]", "no JSON object"},
      {R"({"objectId": "x"})", "'type'"},
      {R"({"type": 99})", "'type'"},
      {R"({"type": 9, "children": 5})", "'children'"},
      {R"({"type": 9, "children": [5]})", "child 0"},
      {R"({"type": 9, "children": [{"type": 6}, {"type": 5, "parent": 0}]})", "'geometryIndex'"},
      {R"({"type": 9, "children": [{"type": 6, "parent": 0}]})", "'parent'"},
      {R"({"type": 9, "children": [{"type": 6, "parent": -3}]})", "'parent'"},
      {R"({"type": 9, "children": [{"type": 5, "geometryIndex": 0}, {"type": 5, "parent": 0, "geometryIndex": 1}]})",
       "child 1"},
      {R"({"type": 9, "children": [{"type": 5, "geometryIndex": 6}]})", "polygon 6 of 6"},
      {R"({"type": 9, "children": [{"type": 5, "geometryIndex": -1}]})", "polygon -1 of 6"}};
  for (const auto& [json, what] : damages) {
    const Statement damage{
        "UPDATE geometry_data SET geometry_properties = $1::jsonb WHERE id = 1"
        " RETURNING id",
        {json}};
    const auto done = connection_->run(damage, {});
    ASSERT_TRUE(done) << json << ": " << done.error().message;
    const auto features = read({1});
    ASSERT_FALSE(features) << json;
    EXPECT_EQ(features.error().code, ErrorCode::DataLoss);
    EXPECT_THAT(features.error().message,
                testing::AllOf(HasSubstr("geometry_data 1: "), HasSubstr(what)))
        << json;
  }
}

TEST_F(SchemaV5, HandsOverTheBuildingsOfAChunkInItsOrder) {
  ASSERT_NO_FATAL_FAILURE(
      open(1, "UPDATE feature SET termination_date = NULL, objectid = 'old' WHERE id = 13"));
  const auto features = read({1, 13});
  ASSERT_TRUE(features) << features.error().message;
  ASSERT_EQ(features->size(), 2u);
  EXPECT_EQ(features->at(0).objects[0].gml_id, "house");
  EXPECT_EQ(features->at(1).objects[0].gml_id, "old");
  EXPECT_THAT(shapes_of(features->at(1), 0), HasSubstr("Solid 1: old_south"));
  const auto none = read({1, 77});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("77"));
}

}  // namespace
}  // namespace citymesh::citydb
