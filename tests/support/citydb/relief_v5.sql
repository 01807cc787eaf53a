-- Terrain in a 3DCityDB of version 5 (SRID 25832), written from what is known of how citydb-tool stores relief, without the loader of
-- the tests; relief_v4.sql is the same in version 4. A hill of four triangles (and two whose corners lie on a line) beside a field of
-- two, both of LoD2, on a country of LoD1; relief that is no TIN, has no geometry or another face than triangles; what has ended, or
-- belongs to what has; a TIN that belongs to nothing. Comments name the sections of the description of the schema:
-- 2.1 tables and classes, 2.2 names of properties, 2.3 geometry.
SET search_path TO citydb, public;

-- 2.1: 500 ReliefFeature, 502 TINRelief, 503 MassPointRelief, 504 BreaklineRelief, 505 RasterRelief
INSERT INTO feature (id, objectclass_id, objectid, envelope, creation_date, termination_date) VALUES
  (1, 500, 'relief', 'SRID=25832;POLYGON Z ((499900 5699900 90, 500200 5699900 90, 500200 5700200 105, 499900 5700200 105, 499900 5699900 90))', '2020-01-01T00:00:00Z', NULL),
  (2, 502, 'hill', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (3, 502, 'field', 'SRID=25832;POLYGON Z ((500020 5700000 90, 500040 5700000 90, 500040 5700020 105, 500020 5700020 105, 500020 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (4, 502, 'country', 'SRID=25832;POLYGON Z ((499900 5699900 90, 500200 5699900 90, 500200 5700200 105, 499900 5700200 105, 499900 5699900 90))', '2020-01-01T00:00:00Z', NULL),
  (5, 503, 'survey', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (6, 504, 'ditch', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (7, 505, 'scan', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (8, 502, 'hill', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', '2024-05-06T00:00:00Z'),
  (9, 500, 'old_relief', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', '2024-05-06T00:00:00Z'),
  (10, 502, 'left_behind', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (11, 502, 'quads', 'SRID=25832;POLYGON Z ((500060 5700000 90, 500080 5700000 90, 500080 5700020 105, 500060 5700020 105, 500060 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (12, 502, 'hollow', 'SRID=25832;POLYGON Z ((500000 5700000 90, 500020 5700000 90, 500020 5700020 105, 500000 5700020 105, 500000 5700000 90))', '2020-01-01T00:00:00Z', NULL),
  (13, 502, 'alone', 'SRID=25832;POLYGON Z ((500040 5700000 90, 500060 5700000 90, 500060 5700020 105, 500040 5700020 105, 500040 5700000 90))', '2020-01-01T00:00:00Z', NULL);

-- 2.3: type 7 TriangulatedSurface is a MultiPolygon; geometryIndex counts polygons from 0.
INSERT INTO geometry_data (id, geometry, geometry_properties, feature_id) VALUES
  (200, 'SRID=25832;MULTIPOLYGON Z (((500000 5700000 100, 500020 5700000 100, 500010 5700010 105, 500000 5700000 100)), ((500020 5700000 100, 500020 5700020 100, 500010 5700010 105, 500020 5700000 100)), ((500020 5700020 100, 500000 5700020 100, 500010 5700010 105, 500020 5700020 100)), ((500000 5700020 100, 500000 5700000 100, 500010 5700010 105, 500000 5700020 100)), ((500000 5700000 100, 500020 5700000 100, 500020 5700000 100, 500000 5700000 100)), ((500000 5700000 100, 500010 5700000 100, 500020 5700000 100, 500000 5700000 100)))',
   '{"type": 7, "objectId": "hill_tin", "children": [{"type": 5, "objectId": "hill_tin_1", "geometryIndex": 0}, {"type": 5, "objectId": "hill_tin_2", "geometryIndex": 1}, {"type": 5, "objectId": "hill_tin_3", "geometryIndex": 2}, {"type": 5, "objectId": "hill_tin_4", "geometryIndex": 3}, {"type": 5, "objectId": "hill_tin_5", "geometryIndex": 4}, {"type": 5, "objectId": "hill_tin_6", "geometryIndex": 5}]}', 2),
  (300, 'SRID=25832;MULTIPOLYGON Z (((500020 5700000 100, 500040 5700000 100, 500040 5700020 100, 500020 5700000 100)), ((500020 5700000 100, 500040 5700020 100, 500020 5700020 100, 500020 5700000 100)))',
   '{"type": 7, "objectId": "field_tin", "children": [{"type": 5, "objectId": "field_tin_1", "geometryIndex": 0}, {"type": 5, "objectId": "field_tin_2", "geometryIndex": 1}]}', 3),
  (400, 'SRID=25832;MULTIPOLYGON Z (((499900 5699900 100, 500200 5699900 100, 500200 5700200 100, 499900 5699900 100)), ((499900 5699900 100, 500200 5700200 100, 499900 5700200 100, 499900 5699900 100)))',
   '{"type": 7, "objectId": "country_tin", "children": [{"type": 5, "objectId": "country_tin_1", "geometryIndex": 0}, {"type": 5, "objectId": "country_tin_2", "geometryIndex": 1}]}', 4),
  (800, 'SRID=25832;MULTIPOLYGON Z (((500000 5700000 90, 500020 5700000 90, 500020 5700020 90, 500000 5700000 90)))',
   '{"type": 7, "objectId": "old_hill_tin", "children": [{"type": 5, "objectId": "old_hill_tin_1", "geometryIndex": 0}]}', 8),
  (1000, 'SRID=25832;MULTIPOLYGON Z (((500000 5700000 90, 500020 5700000 90, 500020 5700020 90, 500000 5700000 90)))',
   '{"type": 7, "objectId": "left_behind_tin", "children": [{"type": 5, "objectId": "left_behind_tin_1", "geometryIndex": 0}]}', 10),
  (1100, 'SRID=25832;MULTIPOLYGON Z (((500060 5700000 100, 500080 5700000 100, 500080 5700020 100, 500060 5700000 100)), ((500060 5700000 100, 500080 5700020 100, 500070 5700020 100, 500060 5700020 100, 500060 5700000 100)))',
   '{"type": 7, "objectId": "quads_tin", "children": [{"type": 5, "objectId": "quads_tin_1", "geometryIndex": 0}, {"type": 5, "objectId": "quads_tin_2", "geometryIndex": 1}]}', 11),
  (1300, 'SRID=25832;MULTIPOLYGON Z (((500040 5700000 100, 500060 5700000 100, 500040 5700020 100, 500040 5700000 100)))',
   '{"type": 7, "objectId": "alone_tin", "children": [{"type": 5, "objectId": "alone_tin_1", "geometryIndex": 0}]}', 13);

-- 2.2: val_relation_type 1 contains; namespace 6 dem, 3 gen. Data types: 3 Integer, 10 FeatureProperty, 11 GeometryProperty. The
-- geometry of a TIN has no LoD of its own; a generic attribute may have the name of any other.
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_int) VALUES
  (1, 1, 3, 6, 'lod', 2),
  (2, 2, 3, 6, 'lod', 2),
  (3, 3, 3, 6, 'lod', 2),
  (4, 4, 3, 6, 'lod', 1),
  (5, 5, 3, 6, 'lod', 2),
  (6, 6, 3, 6, 'lod', 2),
  (7, 7, 3, 6, 'lod', 2),
  (8, 8, 3, 6, 'lod', 2),
  (9, 9, 3, 6, 'lod', 2),
  (10, 10, 3, 6, 'lod', 2),
  (11, 11, 3, 6, 'lod', 2),
  (12, 12, 3, 6, 'lod', 2),
  (13, 13, 3, 6, 'lod', 2),
  (14, 4, 3, 3, 'lod', 3);
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_geometry_id) VALUES
  (15, 2, 11, 6, 'tin', 200),
  (16, 3, 11, 6, 'tin', 300),
  (17, 4, 11, 6, 'tin', 400),
  (18, 8, 11, 6, 'tin', 800),
  (19, 10, 11, 6, 'tin', 1000),
  (20, 11, 11, 6, 'tin', 1100),
  (21, 13, 11, 6, 'tin', 1300);
INSERT INTO property (id, feature_id, datatype_id, namespace_id, name, val_feature_id, val_relation_type) VALUES
  (22, 1, 10, 6, 'reliefComponent', 2, 1),
  (23, 1, 10, 6, 'reliefComponent', 3, 1),
  (24, 1, 10, 6, 'reliefComponent', 4, 1),
  (25, 1, 10, 6, 'reliefComponent', 5, 1),
  (26, 1, 10, 6, 'reliefComponent', 6, 1),
  (27, 1, 10, 6, 'reliefComponent', 7, 1),
  (28, 1, 10, 6, 'reliefComponent', 8, 1),
  (29, 9, 10, 6, 'reliefComponent', 10, 1),
  (30, 1, 10, 6, 'reliefComponent', 11, 1),
  (31, 1, 10, 6, 'reliefComponent', 12, 1);
