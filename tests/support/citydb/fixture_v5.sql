-- One small house in a 3DCityDB of version 5 (SRID 25832), written by hand from what is known of how citydb-tool stores buildings;
-- the loader of the tests had no part in it. fixture.gml is the same house, fixture_v4.sql the same in version 4. Comments name
-- the sections of the description of the schema: 2.1 tables and classes, 2.2 names of properties, 2.3 geometry.
SET search_path TO citydb, public;

-- 2.1: features of all levels are rows here.
INSERT INTO feature (id, objectclass_id, objectid, envelope, lineage, creation_date, termination_date) VALUES
  -- 901 Building, 902 BuildingPart, 905 BuildingInstallation, 709 Wall, 712 Roof, 710 Ground, 15 Closure, 719 WindowSurface
  (1, 901, 'house', 'SRID=25832;POLYGON Z ((500000 5700000 100, 500013 5700000 100, 500013 5700008 108, 500000 5700008 108, 500000 5700000 100))', 'survey 7', '2024-05-06T00:00:00Z', NULL),
  (2, 902, 'annex', 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 103, 500010 5700008 103, 500010 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (3, 905, 'antenna', 'SRID=25832;POLYGON Z ((500004 5700004 106, 500005 5700004 106, 500005 5700005 108, 500004 5700005 108, 500004 5700004 106))', NULL, '2024-05-06T00:00:00Z', NULL),
  (4, 709, 'walls', 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 106, 500000 5700008 106, 500000 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (5, 712, 'roof', 'SRID=25832;POLYGON Z ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106))', NULL, '2024-05-06T00:00:00Z', NULL),
  (6, 710, 'ground', 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 100, 500000 5700008 100, 500000 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (7, 709, 'annex_front', 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700000 103, 500010 5700000 103, 500010 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (8, 709, 'annex_walls', 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 103, 500010 5700008 103, 500010 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (9, 712, 'annex_roof', 'SRID=25832;POLYGON Z ((500010 5700000 103, 500013 5700000 103, 500013 5700008 103, 500010 5700008 103, 500010 5700000 103))', NULL, '2024-05-06T00:00:00Z', NULL),
  (10, 710, 'annex_ground', 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 100, 500010 5700008 100, 500010 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (11, 15, 'annex_closure', 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700000 100, 500010 5700008 103, 500010 5700008 103, 500010 5700000 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (12, 719, 'annex_window', 'SRID=25832;POLYGON Z ((500011 5700000 101, 500012 5700000 101, 500012 5700000 102, 500011 5700000 102, 500011 5700000 101))', NULL, '2024-05-06T00:00:00Z', NULL),
  -- 2.4: the current version of an objectid has no termination_date.
  (13, 901, 'house', 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 104, 500000 5700008 104, 500000 5700000 100))', NULL, '2020-01-01T00:00:00Z', '2024-05-06T00:00:00Z'),
  -- 2.1: 500 ReliefFeature, 502 TINRelief
  (14, 500, 'relief', 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100))', NULL, '2024-05-06T00:00:00Z', NULL),
  (15, 502, 'tin', 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100))', NULL, '2024-05-06T00:00:00Z', NULL);

-- 2.3: types 5 Polygon, 7 TriangulatedSurface, 8 MultiSurface, 9 Solid. Children without parent are children of the root;
-- geometryIndex counts polygons from 0.
INSERT INTO geometry_data (id, geometry, geometry_properties, feature_id) VALUES
  -- Every row is self-contained: the solid has copies of the polygons of the surfaces, with their objectIds. isReversed: the order
  -- stored is the effective one.
  (1, 'SRID=25832;POLYHEDRALSURFACE Z (((500000 5700000 100, 500010 5700000 100, 500010 5700000 106, 500000 5700000 106, 500000 5700000 100)), ((500010 5700000 100, 500010 5700008 100, 500010 5700008 106, 500010 5700000 106, 500010 5700000 100)), ((500010 5700008 100, 500000 5700008 100, 500000 5700008 106, 500010 5700008 106, 500010 5700008 100)), ((500000 5700008 100, 500000 5700000 100, 500000 5700000 106, 500000 5700008 106, 500000 5700008 100)), ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106)), ((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100)))',
   '{"type": 9, "objectId": "house_solid", "children": [{"type": 6, "objectId": "house_shell"}, {"type": 5, "objectId": "p_south", "parent": 0, "geometryIndex": 0}, {"type": 5, "objectId": "p_east", "parent": 0, "geometryIndex": 1}, {"type": 5, "objectId": "p_north", "parent": 0, "geometryIndex": 2}, {"type": 5, "objectId": "p_west", "parent": 0, "geometryIndex": 3}, {"type": 5, "objectId": "p_roof", "parent": 0, "geometryIndex": 4}, {"type": 5, "objectId": "p_ground", "parent": 0, "geometryIndex": 5, "isReversed": true}]}', 1),
  (2, 'SRID=25832;MULTIPOLYGON Z (((500000 5700000 100, 500010 5700000 100, 500010 5700000 106, 500000 5700000 106, 500000 5700000 100)), ((500010 5700000 100, 500010 5700008 100, 500010 5700008 106, 500010 5700000 106, 500010 5700000 100)), ((500010 5700008 100, 500000 5700008 100, 500000 5700008 106, 500010 5700008 106, 500010 5700008 100)), ((500000 5700008 100, 500000 5700000 100, 500000 5700000 106, 500000 5700008 106, 500000 5700008 100)))',
   '{"type": 8, "objectId": "walls_geometry", "children": [{"type": 5, "objectId": "p_south", "geometryIndex": 0}, {"type": 5, "objectId": "p_east", "geometryIndex": 1}, {"type": 5, "objectId": "p_north", "geometryIndex": 2}, {"type": 5, "objectId": "p_west", "geometryIndex": 3}]}', 4),
  -- A geometry may be a single polygon.
  (3, 'SRID=25832;POLYGON Z ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106))', '{"type": 5, "objectId": "p_roof"}', 5),
  (4, 'SRID=25832;MULTIPOLYGON Z (((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100)))', '{"type": 8, "objectId": "ground_geometry", "children": [{"type": 5, "objectId": "p_ground", "geometryIndex": 0, "isReversed": true}]}', 6),
  -- The annex has boundary surfaces only, in LoD3; its front has a hole where the window is.
  (5, 'SRID=25832;MULTIPOLYGON Z (((500010 5700000 100, 500013 5700000 100, 500013 5700000 103, 500010 5700000 103, 500010 5700000 100), (500011 5700000 101, 500011 5700000 102, 500012 5700000 102, 500012 5700000 101, 500011 5700000 101)))',
   '{"type": 8, "objectId": "annex_front_geometry", "children": [{"type": 5, "objectId": "a_south", "geometryIndex": 0}]}', 7),
  (6, 'SRID=25832;MULTIPOLYGON Z (((500013 5700000 100, 500013 5700008 100, 500013 5700008 103, 500013 5700000 103, 500013 5700000 100)), ((500013 5700008 100, 500010 5700008 100, 500010 5700008 103, 500013 5700008 103, 500013 5700008 100)))',
   '{"type": 8, "objectId": "annex_walls_geometry", "children": [{"type": 5, "objectId": "a_east", "geometryIndex": 0}, {"type": 5, "objectId": "a_north", "geometryIndex": 1}]}', 8),
  (7, 'SRID=25832;MULTIPOLYGON Z (((500010 5700000 103, 500013 5700000 103, 500013 5700008 103, 500010 5700008 103, 500010 5700000 103)))', '{"type": 8, "objectId": "annex_roof_geometry", "children": [{"type": 5, "objectId": "a_roof", "geometryIndex": 0}]}', 9),
  (8, 'SRID=25832;MULTIPOLYGON Z (((500010 5700000 100, 500010 5700008 100, 500013 5700008 100, 500013 5700000 100, 500010 5700000 100)))', '{"type": 8, "objectId": "annex_ground_geometry", "children": [{"type": 5, "objectId": "a_ground", "geometryIndex": 0}]}', 10),
  (9, 'SRID=25832;MULTIPOLYGON Z (((500010 5700008 100, 500010 5700000 100, 500010 5700000 103, 500010 5700008 103, 500010 5700008 100)))', '{"type": 8, "objectId": "annex_closure_geometry", "children": [{"type": 5, "objectId": "a_closure", "geometryIndex": 0}]}', 11),
  (10, 'SRID=25832;MULTIPOLYGON Z (((500011 5700000 101, 500012 5700000 101, 500012 5700000 102, 500011 5700000 102, 500011 5700000 101)))', '{"type": 8, "objectId": "annex_window_geometry", "children": [{"type": 5, "objectId": "a_window", "geometryIndex": 0}]}', 12),
  (11, 'SRID=25832;POLYHEDRALSURFACE Z (((500000 5700000 100, 500010 5700000 100, 500010 5700000 104, 500000 5700000 104, 500000 5700000 100)), ((500010 5700000 100, 500010 5700008 100, 500010 5700008 104, 500010 5700000 104, 500010 5700000 100)), ((500010 5700008 100, 500000 5700008 100, 500000 5700008 104, 500010 5700008 104, 500010 5700008 100)), ((500000 5700008 100, 500000 5700000 100, 500000 5700000 104, 500000 5700008 104, 500000 5700008 100)), ((500000 5700000 104, 500010 5700000 104, 500010 5700008 104, 500000 5700008 104, 500000 5700000 104)), ((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100)))',
   '{"type": 9, "objectId": "old_solid", "children": [{"type": 6, "objectId": "old_shell"}, {"type": 5, "objectId": "old_south", "parent": 0, "geometryIndex": 0}, {"type": 5, "objectId": "old_east", "parent": 0, "geometryIndex": 1}, {"type": 5, "objectId": "old_north", "parent": 0, "geometryIndex": 2}, {"type": 5, "objectId": "old_west", "parent": 0, "geometryIndex": 3}, {"type": 5, "objectId": "old_roof", "parent": 0, "geometryIndex": 4}, {"type": 5, "objectId": "old_ground", "parent": 0, "geometryIndex": 5}]}', 13),
  (12, 'SRID=25832;MULTIPOLYGON Z (((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5699980 100)), ((499980 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100)))',
   '{"type": 7, "objectId": "tin_geometry", "children": [{"type": 5, "objectId": "t_1", "geometryIndex": 0}, {"type": 5, "objectId": "t_2", "geometryIndex": 1}]}', 15);

-- 2.1: implicit_geometry holds local coordinates. They belong to no feature: a template may serve many.
INSERT INTO geometry_data (id, implicit_geometry, geometry_properties) VALUES
  (13, 'MULTIPOLYGON Z (((0 0 2, 1 0 0, 0 1 0, 0 0 2)), ((0 0 2, 0 1 0, 0 0 0, 0 0 2)), ((0 0 2, 0 0 0, 1 0 0, 0 0 2)), ((0 0 0, 0 1 0, 1 0 0, 0 0 0)))',
   '{"type": 8, "objectId": "antenna_geometry", "children": [{"type": 5, "objectId": "ant_1", "geometryIndex": 0}, {"type": 5, "objectId": "ant_2", "geometryIndex": 1}, {"type": 5, "objectId": "ant_3", "geometryIndex": 2}, {"type": 5, "objectId": "ant_4", "geometryIndex": 3}]}');
INSERT INTO implicit_geometry (id, objectid, relative_geometry_id) VALUES (1, 'antenna_template', 13);

INSERT INTO address (id, objectid, street, house_number, zip_code, city, country) VALUES
  (1, 'house_address', 'Turmstrasse', '7', '10559', 'Berlin', 'Germany');

-- 2.2: val_relation_type 1 contains. Namespaces (2.1): 1 core, 3 gen, 6 dem, 8 con, 10 bldg, 18 depr. Data types: 10 FeatureProperty,
-- 11 GeometryProperty, 16 ImplicitGeometryProperty, 8 AddressProperty.
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_lod, val_geometry_id) VALUES
  (1, 1, 11, 1, 'lod2Solid', '2', 1),
  (2, 4, 11, 1, 'lod2MultiSurface', '2', 2),
  (3, 5, 11, 1, 'lod2MultiSurface', '2', 3),
  (4, 6, 11, 1, 'lod2MultiSurface', '2', 4),
  (5, 7, 11, 1, 'lod3MultiSurface', '3', 5),
  (6, 8, 11, 1, 'lod3MultiSurface', '3', 6),
  (7, 9, 11, 1, 'lod3MultiSurface', '3', 7),
  (8, 10, 11, 1, 'lod3MultiSurface', '3', 8),
  (9, 11, 11, 1, 'lod3MultiSurface', '3', 9),
  (10, 12, 11, 1, 'lod3MultiSurface', '3', 10),
  (11, 13, 11, 1, 'lod1Solid', '1', 11),
  (12, 15, 11, 6, 'tin', NULL, 12);
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_feature_id, val_relation_type) VALUES
  (20, 1, 10, 1, 'boundary', 4, 1),
  (21, 1, 10, 1, 'boundary', 5, 1),
  (22, 1, 10, 1, 'boundary', 6, 1),
  (23, 1, 10, 10, 'buildingInstallation', 3, 1),
  (24, 1, 10, 10, 'buildingPart', 2, 1),
  (25, 2, 10, 1, 'boundary', 7, 1),
  (26, 2, 10, 1, 'boundary', 8, 1),
  (27, 2, 10, 1, 'boundary', 9, 1),
  (28, 2, 10, 1, 'boundary', 10, 1),
  (29, 2, 10, 1, 'boundary', 11, 1),
  (30, 7, 10, 8, 'fillingSurface', 12, 1),
  (31, 14, 10, 6, 'reliefComponent', 15, 1);

-- 2.1: the matrix stands in val_array, the anchor in val_implicitgeom_refpoint. It turns by 90 degrees: x becomes north, y west.
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_lod, val_implicitgeom_id, val_implicitgeom_refpoint, val_array) VALUES
  (40, 3, 16, 1, 'lod2ImplicitRepresentation', '2', 1, 'SRID=25832;POINT Z (500005 5700004 106)', '[0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]');
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_address_id) VALUES
  (41, 1, 8, 10, 'address', 1);

-- Attributes (data types: 3 Integer, 4 Double, 5 String, 6 URI, 7 Timestamp, 14 Code, 17 Measure, 18 MeasureOrNilReasonList,
-- 22 StringOrRef, 200 GenericAttributeSet, 702 Height). 2.2: measuredHeight is the nested property height; generic attributes are
-- those of the namespace 3.
INSERT INTO property (id, feature_id, parent_id, datatype_id, namespace_id, name, val_int, val_double, val_string, val_timestamp, val_uri, val_codespace, val_uom, val_array) VALUES
  (50, 1, NULL, 22, 1, 'description', NULL, NULL, 'Made of five walls', NULL, NULL, NULL, NULL, NULL),
  (51, 1, NULL, 14, 1, 'name', NULL, NULL, 'The house', NULL, NULL, NULL, NULL, NULL),
  (52, 1, NULL, 5, 1, 'relativeToTerrain', NULL, NULL, 'entirelyAboveTerrain', NULL, NULL, NULL, NULL, NULL),
  (53, 1, NULL, 5, 3, 'owner', NULL, NULL, 'C. Ampersand & Sons', NULL, NULL, NULL, NULL, NULL),
  (54, 1, NULL, 3, 3, 'flats', 3, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (55, 1, NULL, 4, 3, 'share', NULL, 0.125, NULL, NULL, NULL, NULL, NULL, NULL),
  (56, 1, NULL, 6, 3, 'page', NULL, NULL, NULL, NULL, 'https://example.org/house', NULL, NULL, NULL),
  (57, 1, NULL, 7, 3, 'inspected', NULL, NULL, NULL, '2023-02-01T00:00:00Z', NULL, NULL, NULL, NULL),
  (58, 1, NULL, 17, 3, 'area', NULL, 80.5, NULL, NULL, NULL, NULL, 'm2', NULL),
  (59, 1, NULL, 200, 3, 'heat', NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (60, 1, 59, 4, 3, 'kWh', NULL, 12500, NULL, NULL, NULL, NULL, NULL, NULL),
  (61, 1, NULL, 14, 10, 'class', NULL, NULL, '1000', NULL, NULL, 'classes.xml', NULL, NULL),
  (62, 1, NULL, 14, 10, 'function', NULL, NULL, '1100', NULL, NULL, 'functions.xml', NULL, NULL),
  (63, 1, NULL, 14, 10, 'function', NULL, NULL, '1200', NULL, NULL, 'functions.xml', NULL, NULL),
  (64, 1, NULL, 7, 8, 'dateOfConstruction', NULL, NULL, NULL, '1950-01-01T00:00:00Z', NULL, NULL, NULL, NULL),
  (65, 1, NULL, 14, 10, 'roofType', NULL, NULL, '1010', NULL, NULL, NULL, NULL, NULL),
  (66, 1, NULL, 702, 8, 'height', NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (67, 1, 66, 17, 8, 'value', NULL, 6, NULL, NULL, NULL, NULL, 'm', NULL),
  (68, 1, 66, 5, 8, 'status', NULL, NULL, 'measured', NULL, NULL, NULL, NULL, NULL),
  (69, 1, 66, 14, 8, 'lowReference', NULL, NULL, 'lowestGroundPoint', NULL, NULL, NULL, NULL, NULL),
  (70, 1, 66, 14, 8, 'highReference', NULL, NULL, 'highestRoofEdge', NULL, NULL, NULL, NULL, NULL),
  (71, 1, NULL, 3, 10, 'storeysAboveGround', 2, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (72, 1, NULL, 18, 10, 'storeyHeightsAboveGround', NULL, NULL, NULL, NULL, NULL, NULL, 'm', '[3.5, 2.5]'),
  (73, 2, NULL, 5, 3, 'use', NULL, NULL, 'shed', NULL, NULL, NULL, NULL, NULL),
  (74, 2, NULL, 702, 8, 'height', NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (75, 2, 74, 17, 8, 'value', NULL, 3, NULL, NULL, NULL, NULL, 'm', NULL),
  (76, 3, NULL, 14, 10, 'function', NULL, NULL, '1020', NULL, NULL, NULL, NULL, NULL),
  (77, 13, NULL, 14, 1, 'name', NULL, NULL, 'The house before', NULL, NULL, NULL, NULL, NULL),
  (78, 14, NULL, 3, 6, 'lod', 2, NULL, NULL, NULL, NULL, NULL, NULL, NULL),
  (79, 15, NULL, 3, 6, 'lod', 2, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
