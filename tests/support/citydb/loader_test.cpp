#include "tests/support/citydb/loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/citydb/citydb_test.h"
#include "tests/support/temp_folder.h"

namespace citymesh::citydb_support {
namespace {

namespace fs = std::filesystem;

// A cube of one wall and a roof that a solid refers to, two more polygons of the solid's own, an
// installation, and attributes of every kind. North 5800000 and east 300000 are of zone 33.
constexpr const char* kHouse = R"(<?xml version="1.0"?>
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:gml="http://www.opengis.net/gml"
  xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gen="http://www.opengis.net/citygml/generics/2.0"
  xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:xAL="urn:oasis:names:tc:ciq:xsdschema:xAL:2.0">
<gml:boundedBy><gml:Envelope srsName="EPSG:25833" srsDimension="3"><gml:lowerCorner>300000 5800000 0</gml:lowerCorner>
<gml:upperCorner>300010 5800010 10</gml:upperCorner></gml:Envelope></gml:boundedBy>
<core:cityObjectMember><bldg:Building gml:id="b">
 <gml:name>One	house</gml:name>
 <core:creationDate>2008-10-15</core:creationDate>
 <core:relativeToTerrain>entirelyAboveTerrain</core:relativeToTerrain>
 <gen:stringAttribute name="owner"><gen:value>C:\x</gen:value></gen:stringAttribute>
 <gen:intAttribute name="flats"><gen:value>3</gen:value></gen:intAttribute>
 <gen:genericAttributeSet name="heat"><gen:doubleAttribute name="kWh"><gen:value>12.5</gen:value></gen:doubleAttribute></gen:genericAttributeSet>
 <bldg:class>1000</bldg:class><bldg:function>1100</bldg:function><bldg:function>1200</bldg:function>
 <bldg:yearOfConstruction>1950</bldg:yearOfConstruction><bldg:roofType>1010</bldg:roofType>
 <bldg:measuredHeight uom="m">9.75</bldg:measuredHeight><bldg:storeysAboveGround>2</bldg:storeysAboveGround>
 <bldg:storeyHeightsAboveGround uom="m">3.5 3</bldg:storeyHeightsAboveGround>
 <bldg:lod2Solid><gml:Solid gml:id="s"><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember xlink:href="#p_wall"/>
  <gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface xlink:href="#p_roof"/></gml:OrientableSurface></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon gml:id="p_own"><gml:exterior><gml:LinearRing>
   <gml:posList>300000 5800000 0 300010 5800010 10 300010 5800000 0 300000 5800000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing>
   <gml:posList>300000 5800000 0 300000 5800010 0 300010 5800010 10 300000 5800000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
 </gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>
 <bldg:outerBuildingInstallation><bldg:BuildingInstallation gml:id="i"><bldg:lod2Geometry><gml:MultiSurface><gml:surfaceMember>
  <gml:Polygon gml:id="p_inst"><gml:exterior><gml:LinearRing><gml:posList>300020 5800000 0 300021 5800000 0 300021 5800001 2 300020 5800000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
 </gml:surfaceMember></gml:MultiSurface></bldg:lod2Geometry></bldg:BuildingInstallation></bldg:outerBuildingInstallation>
 <bldg:boundedBy><bldg:WallSurface gml:id="w"><bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember>
  <gml:Polygon gml:id="p_wall"><gml:exterior><gml:LinearRing><gml:posList>300000 5800000 0 300010 5800000 0 300010 5800000 8 300000 5800000 8 300000 5800000 0</gml:posList></gml:LinearRing></gml:exterior>
  <gml:interior><gml:LinearRing><gml:posList>300002 5800000 2 300002 5800000 4 300004 5800000 4 300004 5800000 2 300002 5800000 2</gml:posList></gml:LinearRing></gml:interior></gml:Polygon>
 </gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface>
 <bldg:opening><bldg:Window gml:id="win"><bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember>
  <gml:Polygon gml:id="p_win"><gml:exterior><gml:LinearRing><gml:posList>300002 5800000 2 300004 5800000 2 300004 5800000 4 300002 5800000 4 300002 5800000 2</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
 </gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface></bldg:Window></bldg:opening></bldg:WallSurface></bldg:boundedBy>
 <bldg:boundedBy><bldg:RoofSurface><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
  <gml:Polygon gml:id="p_roof"><gml:exterior><gml:LinearRing><gml:posList>300000 5800000 8 300010 5800000 8 300010 5800010 10 300000 5800000 8</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
 </gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy>
 <bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id="part"><bldg:lod1MultiSurface><gml:MultiSurface><gml:surfaceMember>
  <gml:Polygon gml:id="p_part"><gml:exterior><gml:LinearRing><gml:posList>300030 5800000 0 300031 5800000 0 300031 5800001 0 300030 5800000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
 </gml:surfaceMember></gml:MultiSurface></bldg:lod1MultiSurface></bldg:BuildingPart></bldg:consistsOfBuildingPart>
 <bldg:address><core:Address><core:xalAddress><xAL:AddressDetails><xAL:Country><xAL:CountryName>Germany</xAL:CountryName>
  <xAL:Locality Type="Town"><xAL:LocalityName>Berlin</xAL:LocalityName><xAL:Thoroughfare Type="Street"><xAL:ThoroughfareNumber>7</xAL:ThoroughfareNumber>
  <xAL:ThoroughfareName>Turmstrasse</xAL:ThoroughfareName></xAL:Thoroughfare></xAL:Locality></xAL:Country></xAL:AddressDetails></core:xalAddress></core:Address></bldg:address>
</bldg:Building></core:cityObjectMember></core:CityModel>)";

class Loaders : public CityDbTest {
 protected:
  /// The result as lines of values between '|'; "" for NULL.
  static std::string lines(const std::string& url, const std::string& sql) {
    auto database = Database::open(url);
    if (!database) return database.error().message;
    const auto rows = database->rows(sql);
    if (!rows) return rows.error().message;
    std::string text;
    for (const Database::Row& row : *rows) {
      for (std::size_t c = 0; c < row.size(); ++c) text += (c ? "|" : "") + row[c].value_or("");
      text += '\n';
    }
    return text;
  }

  std::string loaded(const Schema& schema, const fs::path& file, std::uint32_t copies = 1) {
    const auto url = server().create_citydb(schema);
    EXPECT_TRUE(url) << url.error().message;
    if (!url) return "";
    const auto report = load(*url, {.schema = schema, .copies = copies}, file);
    EXPECT_TRUE(report) << file << ": " << report.error().message;
    if (report) report_ = *report;
    return *url;
  }

  std::string loaded_house(const Schema& schema) {
    std::ofstream(folder_ / "house.gml") << kHouse;
    return loaded(schema, folder_ / "house.gml");
  }

  TempFolder folder_{};
  LoadReport report_{};
};

TEST_F(Loaders, Version4HasTreesOfPolygonsWithCopiesOfSharedOnes) {
  const std::string url = loaded_house({.major = 4, .srid = 25833});
  EXPECT_EQ(lines(url,
                  "SELECT s.gmlid LIKE 'ID_%', s.parent_id - s.root_id, s.is_solid, s.is_composite,"
                  " s.is_triangulated, ST_AsText(s.geometry) FROM surface_geometry s"
                  " JOIN building b ON b.lod2_solid_id = s.root_id WHERE geometry IS NULL"
                  " ORDER BY s.id"),
            "t||1|0|0|\n"
            "t|0|0|1|0|\n");
  EXPECT_EQ(
      lines(
          url,
          "SELECT CASE WHEN s.gmlid LIKE 'ID_%' THEN 'made' ELSE s.gmlid END, o.gmlid,"
          " s.parent_id - s.root_id, is_solid, is_composite, is_xlink, is_reverse,"
          " ST_AsText(geometry), ST_SRID(geometry) FROM surface_geometry s"
          " JOIN building b ON b.lod2_solid_id = s.root_id"
          " JOIN cityobject o ON o.id = s.cityobject_id WHERE geometry IS NOT NULL ORDER BY s.id"),
      "p_own|b|1|0|0|0|0|POLYGON Z ((300000 5800000 0,300010 5800010 10,300010 5800000 0,"
      "300000 5800000 0))|25833\n"
      "made|b|1|0|0|0|0|POLYGON Z ((300000 5800000 0,300000 5800010 0,300010 5800010 10,"
      "300000 5800000 0))|25833\n"
      "p_wall|b|1|0|0|2|0|POLYGON Z ((300000 5800000 0,300010 5800000 0,300010 5800000 8,"
      "300000 5800000 8,300000 5800000 0),(300002 5800000 2,300002 5800000 4,300004 5800000 4,"
      "300004 5800000 2,300002 5800000 2))|25833\n"
      "p_roof|b|1|0|0|2|1|POLYGON Z ((300000 5800000 8,300010 5800010 10,300010 5800000 8,"
      "300000 5800000 8))|25833\n");
  EXPECT_EQ(lines(url,
                  "SELECT o.objectclass_id, o.gmlid LIKE 'ID_%', b.gmlid,"
                  " t.lod2_multi_surface_id IS NOT NULL, t.lod3_multi_surface_id IS NOT NULL"
                  " FROM thematic_surface t JOIN cityobject o ON o.id = t.id"
                  " JOIN cityobject b ON b.id = t.building_id ORDER BY 1 DESC"),
            "34|f|b|f|t\n"
            "33|t|b|t|f\n");
  EXPECT_EQ(lines(url,
                  "SELECT w.gmlid, o.objectclass_id, s.gmlid, s.is_xlink, s.parent_id = s.root_id"
                  " FROM opening o JOIN opening_to_them_surface l ON l.opening_id = o.id"
                  " JOIN cityobject w ON w.id = l.thematic_surface_id"
                  " JOIN surface_geometry s ON s.root_id = o.lod3_multi_surface_id"
                  " AND s.geometry IS NOT NULL"),
            "w|38|p_win|0|t\n");
  EXPECT_EQ(lines(url,
                  "SELECT i.objectclass_id, s.gmlid FROM building_installation i"
                  " JOIN building b ON b.id = i.building_id"
                  " JOIN surface_geometry s ON s.root_id = i.lod2_brep_id"
                  " AND s.geometry IS NOT NULL"),
            "27|p_inst\n");
}

TEST_F(Loaders, Version4HasAttributesWhereTheyBelong) {
  const std::string url = loaded_house({.major = 4, .srid = 25833});
  EXPECT_EQ(lines(url,
                  "SELECT gmlid, name, creation_date AT TIME ZONE 'UTC', termination_date,"
                  " relative_to_terrain, ST_AsText(envelope) FROM cityobject"
                  " WHERE objectclass_id IN (25, 26) ORDER BY objectclass_id DESC"),
            "b|One\thouse|2008-10-15 00:00:00||entirelyAboveTerrain|POLYGON Z ((300000 5800000 0,"
            "300031 5800000 0,300031 5800010 10,300000 5800010 10,300000 5800000 0))\n"
            "part||2026-01-02 03:04:05|||POLYGON Z ((300030 5800000 0,300031 5800000 0,"
            "300031 5800001 0,300030 5800001 0,300030 5800000 0))\n");
  EXPECT_EQ(lines(url,
                  "SELECT objectclass_id, building_parent_id = building_root_id, class, function,"
                  " year_of_construction, roof_type, measured_height, storeys_above_ground,"
                  " storey_heights_above_ground, lod1_multi_surface_id IS NOT NULL FROM building"
                  " ORDER BY objectclass_id DESC"),
            "26||1000|1100--/\\--1200|1950-01-01|1010|9.75|2|3.5 3|f\n"
            "25|t||||||||t\n");
  EXPECT_EQ(lines(url,
                  "SELECT g.attrname, g.datatype, g.strval, g.intval, g.realval, p.attrname,"
                  " r.attrname FROM cityobject_genericattrib g"
                  " JOIN cityobject_genericattrib r ON r.id = g.root_genattrib_id"
                  " LEFT JOIN cityobject_genericattrib p ON p.id = g.parent_genattrib_id"
                  " ORDER BY g.id"),
            "owner|1|C:\\x||||owner\n"
            "flats|2||3|||flats\n"
            "heat|7|||||heat\n"
            "kWh|3|||12.5|heat|heat\n");
  EXPECT_EQ(lines(url,
                  "SELECT o.gmlid, street, house_number, zip_code, city, country FROM address a"
                  " JOIN address_to_building l ON l.address_id = a.id"
                  " JOIN cityobject o ON o.id = l.building_id"),
            "b|Turmstrasse|7||Berlin|Germany\n");
}

TEST_F(Loaders, Version5HasGeometriesWithTheirPolygonsNamed) {
  for (const int minor : {0, 1}) {
    const std::string url = loaded_house({.major = 5, .minor = minor, .srid = 25833});
    EXPECT_EQ(lines(url,
                    "SELECT f.objectclass_id, p.name, n.alias, p.val_lod, g.feature_id = f.id,"
                    " GeometryType(g.geometry), ST_NumGeometries(g.geometry), ST_SRID(g.geometry),"
                    " g.geometry_properties->>'type', (SELECT string_agg(concat_ws(' ', c->>'type',"
                    " regexp_replace(c->>'objectId', '^ID_.*', 'made'), c->>'parent',"
                    " c->>'geometryIndex', c->>'isReversed'), ',' ORDER BY at)"
                    " FROM jsonb_array_elements(g.geometry_properties::jsonb->'children')"
                    " WITH ORDINALITY AS t(c, at))"
                    " FROM property p JOIN feature f ON f.id = p.feature_id"
                    " JOIN namespace n ON n.id = p.namespace_id"
                    " JOIN geometry_data g ON g.id = p.val_geometry_id ORDER BY 1, 2, 4"),
              "709|lod3MultiSurface|core|3|t|MULTIPOLYGON|1|25833|8|5 p_wall 0\n"
              "712|lod2MultiSurface|core|2|t|MULTIPOLYGON|1|25833|8|5 p_roof 0\n"
              "719|lod3MultiSurface|core|3|t|MULTIPOLYGON|1|25833|8|5 p_win 0\n"
              "901|lod2Solid|core|2|t|POLYHEDRALSURFACE|4|25833|9|6 made,5 p_wall 0 0,"
              "5 p_roof 0 1 true,5 p_own 0 2,5 made 0 3\n"
              "902|lod1MultiSurface|depr|1|t|MULTIPOLYGON|1|25833|8|5 p_part 0\n"
              "905|lod2Geometry|depr|2|t|MULTIPOLYGON|1|25833|8|5 p_inst 0\n");
    EXPECT_EQ(lines(url,
                    "SELECT ST_AsText(ST_GeometryN(g.geometry, 2)) FROM geometry_data g"
                    " WHERE GeometryType(g.geometry) = 'POLYHEDRALSURFACE'"),
              "POLYGON Z ((300000 5800000 8,300010 5800010 10,300010 5800000 8,"
              "300000 5800000 8))\n");
  }
}

TEST_F(Loaders, Version5RelatesFeaturesAndNamesAttributesAsCityGml3Does) {
  const std::string url = loaded_house({.major = 5, .srid = 25833});
  EXPECT_EQ(lines(url,
                  "SELECT a.objectclass_id, p.name, n.alias, d.typename, p.val_relation_type,"
                  " b.objectclass_id FROM property p JOIN feature a ON a.id = p.feature_id"
                  " JOIN feature b ON b.id = p.val_feature_id"
                  " JOIN namespace n ON n.id = p.namespace_id"
                  " JOIN datatype d ON d.id = p.datatype_id ORDER BY 1, 2, 6"),
            "709|fillingSurface|con|FeatureProperty|1|719\n"
            "901|boundary|core|FeatureProperty|1|709\n"
            "901|boundary|core|FeatureProperty|1|712\n"
            "901|buildingInstallation|bldg|FeatureProperty|1|905\n"
            "901|buildingPart|bldg|FeatureProperty|1|902\n");
  EXPECT_EQ(lines(url,
                  "SELECT m.name, p.name, n.alias, d.typename, p.val_int, p.val_double,"
                  " p.val_string, p.val_timestamp AT TIME ZONE 'UTC', p.val_uom, p.val_array"
                  " FROM property p JOIN feature f ON f.id = p.feature_id"
                  " JOIN namespace n ON n.id = p.namespace_id"
                  " JOIN datatype d ON d.id = p.datatype_id"
                  " LEFT JOIN property m ON m.id = p.parent_id"
                  " WHERE f.objectid = 'b' AND p.val_feature_id IS NULL"
                  " AND p.val_geometry_id IS NULL ORDER BY p.id"),
            "|name|core|Code|||One\thouse|||\n"
            "|relativeToTerrain|core|String|||entirelyAboveTerrain|||\n"
            "|owner|gen|String|||C:\\x|||\n"
            "|flats|gen|Integer|3|||||\n"
            "|heat|gen|GenericAttributeSet||||||\n"
            "heat|kWh|gen|Double||12.5||||\n"
            "|class|bldg|Code|||1000|||\n"
            "|function|bldg|Code|||1100|||\n"
            "|function|bldg|Code|||1200|||\n"
            "|dateOfConstruction|con|Timestamp||||1950-01-01 00:00:00||\n"
            "|roofType|bldg|Code|||1010|||\n"
            "|height|con|Height||||||\n"
            "height|value|con|Measure||9.75|||m|\n"
            "height|status|con|String|||measured|||\n"
            "height|lowReference|con|Code|||lowestGroundPoint|||\n"
            "height|highReference|con|Code|||highestRoofEdge|||\n"
            "|storeysAboveGround|bldg|Integer|2|||||\n"
            "|storeyHeightsAboveGround|bldg|MeasureOrNilReasonList|||||m|[3.5, 3]\n"
            "|address|bldg|AddressProperty||||||\n");
  EXPECT_EQ(lines(url,
                  "SELECT objectid, creation_date AT TIME ZONE 'UTC', ST_AsText(envelope)"
                  " FROM feature WHERE objectclass_id = 901"),
            "b|2008-10-15 00:00:00|POLYGON Z ((300000 5800000 0,300031 5800000 0,"
            "300031 5800010 10,300000 5800010 10,300000 5800000 0))\n");
  EXPECT_EQ(lines(url, "SELECT street, house_number, city, country FROM address"),
            "Turmstrasse|7|Berlin|Germany\n");
}

TEST_F(Loaders, SecondFilesAndCopiesGetNewIdsAndPlaces) {
  for (const int major : {4, 5}) {
    const Schema schema{.major = major, .srid = 25833};
    const std::string url = loaded_house(schema);
    const auto again = load(url, {.schema = schema, .copies = 3}, folder_ / "house.gml");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->buildings, 3u);
    const std::string id = major == 4 ? "gmlid" : "objectid";
    EXPECT_EQ(lines(url, "SELECT " + id + ", ST_XMin(envelope), ST_YMin(envelope) FROM " +
                             (major == 4 ? "cityobject" : "feature") +
                             " WHERE objectclass_id IN (26, 901) ORDER BY id"),
              "b|300000|5800000\n"
              "b|300000|5800000\n"
              "b_c1|300033|5800000\n"
              "b_c2|300000|5800011\n");
  }
}

TEST_F(Loaders, NorthBeforeEastIsSwapped) {
  const std::string v4 =
      loaded({.major = 4, .srid = 6697}, CITYMESH_TEST_DATA "/plateau/53404336_tako.gml.gz");
  EXPECT_EQ(lines(v4,
                  "SELECT round(ST_XMin(ST_Extent(envelope))), "
                  "round(ST_YMin(ST_Extent(envelope))) FROM cityobject"),
            "140|36\n");
  const auto srid = srid_of(CITYMESH_TEST_DATA "/plateau/53404336_tako.gml.gz");
  ASSERT_TRUE(srid) << srid.error().message;
  EXPECT_EQ(*srid, 6697);
}

TEST_F(Loaders, WhatDoesNotFitLeavesNothingBehind) {
  const Schema schema{.major = 4, .srid = 25833};
  const auto url = server().create_citydb(schema);
  ASSERT_TRUE(url);
  std::ofstream(folder_ / "bad.gml") << std::string(kHouse).replace(
      std::string(kHouse).find("<bldg:class>1000"), 16, "<bldg:class>" + std::string(300, 'x'));
  EXPECT_FALSE(load(*url, {.schema = schema}, folder_ / "bad.gml"));
  EXPECT_EQ(lines(*url, "SELECT count(*) FROM cityobject"), "0\n");
  EXPECT_FALSE(load(*url, {.schema = schema}, folder_ / "missing.gml"));
}

// ---- the loader and what was written by hand ---------------------------------------------------

class Fixtures : public Loaders {
 protected:
  /// The house of the fixture as it was written by hand, and as the loader stores it.
  void make(const Schema& schema) {
    const auto url = server().create_citydb(schema);
    ASSERT_TRUE(url) << url.error().message;
    by_hand_ = *url;
    const auto sql = citydb_file(schema.major == 4 ? "fixture_v4.sql" : "fixture_v5.sql");
    ASSERT_TRUE(sql) << sql.error().message;
    auto database = Database::open(by_hand_);
    ASSERT_TRUE(database) << database.error().message;
    const auto stored = database->run(*sql);
    ASSERT_TRUE(stored) << stored.error().message;
    by_loader_ = loaded(schema, CITYMESH_CITYDB_FIXTURE);
  }

  void expect_the_same(const std::string& sql, std::size_t rows) {
    const std::string expected = lines(by_hand_, sql);
    EXPECT_EQ(lines(by_loader_, sql), expected) << sql;
    EXPECT_EQ(static_cast<std::size_t>(std::count(expected.begin(), expected.end(), '\n')), rows)
        << expected;
  }

 private:
  std::string by_hand_{}, by_loader_{};
};

TEST_F(Fixtures, OfVersion4AreWhatTheLoaderMakesOfTheFile) {
  ASSERT_NO_FATAL_FAILURE(make({.major = 4}));
  const std::string current = " termination_date IS NULL AND objectclass_id NOT IN (14, 16) ";
  expect_the_same(
      "SELECT gmlid, objectclass_id, name, description, ST_AsText(envelope),"
      " relative_to_terrain FROM cityobject WHERE" +
          current + "ORDER BY 1",
      12);
  expect_the_same("SELECT gmlid, creation_date FROM cityobject WHERE" + current +
                      "AND objectclass_id IN (25, 26, 27) ORDER BY 1",
                  3);
  expect_the_same(
      "SELECT o.gmlid, s.gmlid, coalesce(is_xlink, 0), coalesce(is_reverse, 0),"
      " ST_AsText(geometry), ST_SRID(geometry) FROM surface_geometry s"
      " JOIN cityobject o ON o.id = s.cityobject_id WHERE" +
          current + "AND objectclass_id <> 27 AND geometry IS NOT NULL ORDER BY 1, 2",
      19);
  expect_the_same(
      "SELECT o.gmlid, parent_id IS NULL, is_solid, is_composite, is_triangulated,"
      " is_xlink, is_reverse FROM surface_geometry s"
      " JOIN cityobject o ON o.id = s.cityobject_id WHERE" +
          current +
          "AND objectclass_id <> 27 AND geometry IS NULL AND o.gmlid <> 'roof'"
          " ORDER BY 1, 2",
      10);
  expect_the_same(
      "SELECT o.gmlid, p.gmlid, r.gmlid, b.class, b.function, year_of_construction,"
      " roof_type, measured_height, measured_height_unit, storeys_above_ground,"
      " storey_heights_above_ground, storey_heights_ag_unit, lod1_solid_id,"
      " lod2_solid_id IS NOT NULL FROM building b JOIN cityobject o ON o.id = b.id"
      " LEFT JOIN cityobject p ON p.id = building_parent_id"
      " JOIN cityobject r ON r.id = building_root_id"
      " WHERE o.termination_date IS NULL ORDER BY 1",
      2);
  expect_the_same(
      "SELECT o.gmlid, b.gmlid, room_id, building_installation_id,"
      " lod2_multi_surface_id IS NULL, lod3_multi_surface_id IS NULL,"
      " lod4_multi_surface_id IS NULL FROM thematic_surface t"
      " JOIN cityobject o ON o.id = t.id JOIN cityobject b ON b.id = building_id"
      " ORDER BY 1",
      8);
  expect_the_same(
      "SELECT o.gmlid, w.gmlid, address_id, lod3_multi_surface_id IS NULL"
      " FROM opening p JOIN cityobject o ON o.id = p.id"
      " JOIN opening_to_them_surface l ON l.opening_id = p.id"
      " JOIN cityobject w ON w.id = l.thematic_surface_id",
      1);
  expect_the_same(
      "SELECT o.gmlid, b.gmlid, function FROM building_installation i"
      " JOIN cityobject o ON o.id = i.id JOIN cityobject b ON b.id = building_id",
      1);
  expect_the_same(
      "SELECT b.gmlid, street, house_number, po_box, zip_code, city, state, country"
      " FROM address a JOIN address_to_building l ON l.address_id = a.id"
      " JOIN cityobject b ON b.id = l.building_id",
      1);
  expect_the_same(
      "SELECT o.gmlid, g.attrname, g.datatype, g.strval, g.intval, g.realval,"
      " p.attrname, r.attrname FROM cityobject_genericattrib g"
      " JOIN cityobject o ON o.id = g.cityobject_id"
      " LEFT JOIN cityobject_genericattrib p ON p.id = g.parent_genattrib_id"
      " JOIN cityobject_genericattrib r ON r.id = g.root_genattrib_id"
      " WHERE g.attrname NOT IN ('page', 'inspected', 'area') ORDER BY o.gmlid, g.id",
      6);
}

TEST_F(Fixtures, OfVersion5AreWhatTheLoaderMakesOfTheFile) {
  for (const int minor : {0, 1}) {
    ASSERT_NO_FATAL_FAILURE(make({.major = 5, .minor = minor}));
    const std::string current =
        " f.termination_date IS NULL AND f.objectclass_id NOT IN (500, 502) ";
    expect_the_same("SELECT objectid, objectclass_id, ST_AsText(envelope) FROM feature f WHERE" +
                        current + "ORDER BY 1",
                    12);
    expect_the_same(
        "SELECT f.objectid, p.name, p.namespace_id, p.datatype_id, p.val_lod,"
        " g.feature_id = f.id, ST_AsText(g.geometry), ST_SRID(g.geometry),"
        " g.geometry_properties->>'type', (SELECT string_agg(concat_ws(' ', c->>'type',"
        " CASE WHEN c->>'type' = '5' THEN c->>'objectId' END, c->>'parent',"
        " c->>'geometryIndex', c->>'isReversed'), ',' ORDER BY at)"
        " FROM jsonb_array_elements(g.geometry_properties::jsonb->'children')"
        " WITH ORDINALITY AS t(c, at)) FROM property p"
        " JOIN feature f ON f.id = p.feature_id"
        " JOIN geometry_data g ON g.id = p.val_geometry_id WHERE" +
            current + "AND f.objectid NOT IN ('roof', 'antenna') ORDER BY 1, 2",
        9);
    expect_the_same(
        "SELECT f.objectid, p.name, p.namespace_id, p.datatype_id, p.val_relation_type,"
        " m.objectid FROM property p JOIN feature f ON f.id = p.feature_id"
        " JOIN feature m ON m.id = p.val_feature_id WHERE" +
            current + "ORDER BY 1, 2, 6",
        11);
    expect_the_same(
        "SELECT p.name, p.namespace_id, p.datatype_id, m.name, p.val_int, p.val_double,"
        " p.val_string, p.val_timestamp, p.val_uom, p.val_array::jsonb FROM property p"
        " LEFT JOIN property m ON m.id = p.parent_id"
        " JOIN feature f ON f.id = p.feature_id WHERE" +
            current +
            "AND f.objectid = 'house' AND p.val_feature_id IS NULL AND p.val_geometry_id"
            " IS NULL AND p.name NOT IN ('page', 'inspected', 'area', 'address')"
            " ORDER BY p.name, p.val_string",
        20);
    expect_the_same(
        "SELECT f.objectid, p.name, p.namespace_id, p.datatype_id, street,"
        " house_number, po_box, zip_code, city, state, country FROM property p"
        " JOIN feature f ON f.id = p.feature_id"
        " JOIN address a ON a.id = p.val_address_id",
        1);
  }
}

}  // namespace
}  // namespace citymesh::citydb_support
