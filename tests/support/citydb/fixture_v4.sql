-- One small house in a 3DCityDB of version 4 (SRID 25832), written by hand from what is known of how importers store buildings;
-- the loader of the tests had no part in it. fixture.gml is the same house, fixture_v5.sql the same in version 5. Comments name
-- the sections of the description of the schema: 1.2 tables, 1.3 classes, 1.4 geometry, 1.7 terrain.
SET search_path TO citydb, public;

-- 1.2: every feature has a row in cityobject; the row of its class has the same id. Envelopes are tilted rectangles of five points.
INSERT INTO cityobject (id, objectclass_id, gmlid, name, description, envelope, creation_date, termination_date, relative_to_terrain, lineage) VALUES
  -- 1.3: 26 Building, 25 BuildingPart, 27 BuildingInstallation, 34 Wall, 33 Roof, 35 Ground, 36 Closure, 38 Window
  (1, 26, 'house', 'The house', 'Made of five walls', 'SRID=25832;POLYGON Z ((500000 5700000 100, 500013 5700000 100, 500013 5700008 108, 500000 5700008 108, 500000 5700000 100))', '2024-05-06T00:00:00Z', NULL, 'entirelyAboveTerrain', 'survey 7'),
  (2, 25, 'annex', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 103, 500010 5700008 103, 500010 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (3, 27, 'antenna', NULL, NULL, 'SRID=25832;POLYGON Z ((500004 5700004 106, 500005 5700004 106, 500005 5700005 108, 500004 5700005 108, 500004 5700004 106))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (4, 34, 'walls', NULL, NULL, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 106, 500000 5700008 106, 500000 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (5, 33, 'roof', NULL, NULL, 'SRID=25832;POLYGON Z ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (6, 35, 'ground', NULL, NULL, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 100, 500000 5700008 100, 500000 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (7, 34, 'annex_front', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700000 103, 500010 5700000 103, 500010 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (8, 34, 'annex_walls', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 103, 500010 5700008 103, 500010 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (9, 33, 'annex_roof', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 103, 500013 5700000 103, 500013 5700008 103, 500010 5700008 103, 500010 5700000 103))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (10, 35, 'annex_ground', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700008 100, 500010 5700008 100, 500010 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (11, 36, 'annex_closure', NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700000 100, 500010 5700008 103, 500010 5700008 103, 500010 5700000 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (12, 38, 'annex_window', NULL, NULL, 'SRID=25832;POLYGON Z ((500011 5700000 101, 500012 5700000 101, 500012 5700000 102, 500011 5700000 102, 500011 5700000 101))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  -- 1.2: the gmlid repeats once per version; the current one has no termination_date.
  (13, 26, 'house', 'The house before', NULL, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700008 104, 500000 5700008 104, 500000 5700000 100))', '2020-01-01T00:00:00Z', '2024-05-06T00:00:00Z', NULL, NULL),
  -- 1.3: 14 ReliefFeature, 16 TINRelief
  (14, 14, 'relief', NULL, NULL, 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL),
  (15, 16, 'tin', NULL, NULL, 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100))', '2024-05-06T00:00:00Z', NULL, NULL, NULL);

-- 1.4: rows form trees by parent_id, every row has root_id, only leaves have geometry. Flags are numeric and may be NULL.
INSERT INTO surface_geometry (id, gmlid, parent_id, root_id, is_solid, is_composite, is_triangulated, is_xlink, is_reverse, geometry, cityobject_id) VALUES
  -- The solid has one child, its shell; its polygons are copies of those of the surfaces, with the same gmlid (is_xlink 2: within one
  -- feature). They belong to the building. is_reverse: the order stored is the effective one.
  (100, 'house_solid', NULL, 100, 1, 0, 0, 0, 0, NULL, 1),
  (101, 'house_shell', 100, 100, 0, 1, 0, 0, 0, NULL, 1),
  (102, 'p_south', 101, 100, 0, 0, 0, 2, 0, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700000 106, 500000 5700000 106, 500000 5700000 100))', 1),
  (103, 'p_east', 101, 100, 0, 0, 0, 2, 0, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700008 100, 500010 5700008 106, 500010 5700000 106, 500010 5700000 100))', 1),
  (104, 'p_north', 101, 100, 0, 0, 0, 2, 0, 'SRID=25832;POLYGON Z ((500010 5700008 100, 500000 5700008 100, 500000 5700008 106, 500010 5700008 106, 500010 5700008 100))', 1),
  (105, 'p_west', 101, 100, 0, 0, 0, 2, 0, 'SRID=25832;POLYGON Z ((500000 5700008 100, 500000 5700000 100, 500000 5700000 106, 500000 5700008 106, 500000 5700008 100))', 1),
  (106, 'p_roof', 101, 100, 0, 0, 0, 2, 0, 'SRID=25832;POLYGON Z ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106))', 1),
  (107, 'p_ground', 101, 100, 0, 0, 0, 2, 1, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100))', 1),
  -- The polygons of the surfaces, which belong to them.
  (110, 'walls_geometry', NULL, 110, 0, 0, 0, 0, 0, NULL, 4),
  (111, 'p_south', 110, 110, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700000 106, 500000 5700000 106, 500000 5700000 100))', 4),
  (112, 'p_east', 110, 110, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700008 100, 500010 5700008 106, 500010 5700000 106, 500010 5700000 100))', 4),
  (113, 'p_north', 110, 110, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500010 5700008 100, 500000 5700008 100, 500000 5700008 106, 500010 5700008 106, 500010 5700008 100))', 4),
  (114, 'p_west', 110, 110, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700008 100, 500000 5700000 100, 500000 5700000 106, 500000 5700008 106, 500000 5700008 100))', 4),
  -- A root may itself be a polygon.
  (120, 'p_roof', NULL, 120, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700000 106, 500010 5700000 106, 500010 5700008 106, 500000 5700008 106, 500000 5700000 106))', 5),
  (130, 'ground_geometry', NULL, 130, 0, 0, 0, 0, 0, NULL, 6),
  (131, 'p_ground', 130, 130, 0, 0, 0, 0, 1, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100))', 6),
  -- The annex has boundary surfaces only, in LoD3; its front has a hole where the window is.
  (140, 'annex_front_geometry', NULL, 140, 0, 0, 0, 0, 0, NULL, 7),
  (141, 'a_south', 140, 140, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500013 5700000 100, 500013 5700000 103, 500010 5700000 103, 500010 5700000 100), (500011 5700000 101, 500011 5700000 102, 500012 5700000 102, 500012 5700000 101, 500011 5700000 101))', 7),
  (150, 'annex_walls_geometry', NULL, 150, 0, 0, 0, 0, 0, NULL, 8),
  (151, 'a_east', 150, 150, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500013 5700000 100, 500013 5700008 100, 500013 5700008 103, 500013 5700000 103, 500013 5700000 100))', 8),
  (152, 'a_north', 150, 150, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500013 5700008 100, 500010 5700008 100, 500010 5700008 103, 500013 5700008 103, 500013 5700008 100))', 8),
  (160, 'annex_roof_geometry', NULL, 160, 0, 0, 0, 0, 0, NULL, 9),
  (161, 'a_roof', 160, 160, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 103, 500013 5700000 103, 500013 5700008 103, 500010 5700008 103, 500010 5700000 103))', 9),
  (170, 'annex_ground_geometry', NULL, 170, 0, 0, 0, 0, 0, NULL, 10),
  (171, 'a_ground', 170, 170, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700008 100, 500013 5700008 100, 500013 5700000 100, 500010 5700000 100))', 10),
  (180, 'annex_closure_geometry', NULL, 180, 0, 0, 0, 0, 0, NULL, 11),
  (181, 'a_closure', 180, 180, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500010 5700008 100, 500010 5700000 100, 500010 5700000 103, 500010 5700008 103, 500010 5700008 100))', 11),
  (190, 'annex_window_geometry', NULL, 190, 0, 0, 0, 0, 0, NULL, 12),
  (191, 'a_window', 190, 190, NULL, NULL, NULL, NULL, NULL, 'SRID=25832;POLYGON Z ((500011 5700000 101, 500012 5700000 101, 500012 5700000 102, 500011 5700000 102, 500011 5700000 101))', 12),
  -- The solid of the version before, LoD1, on its own.
  (210, 'old_solid', NULL, 210, 1, 0, 0, 0, 0, NULL, 13),
  (211, 'old_shell', 210, 210, 0, 1, 0, 0, 0, NULL, 13),
  (212, 'old_south', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500010 5700000 100, 500010 5700000 104, 500000 5700000 104, 500000 5700000 100))', 13),
  (213, 'old_east', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500010 5700000 100, 500010 5700008 100, 500010 5700008 104, 500010 5700000 104, 500010 5700000 100))', 13),
  (214, 'old_north', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500010 5700008 100, 500000 5700008 100, 500000 5700008 104, 500010 5700008 104, 500010 5700008 100))', 13),
  (215, 'old_west', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700008 100, 500000 5700000 100, 500000 5700000 104, 500000 5700008 104, 500000 5700008 100))', 13),
  (216, 'old_roof', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700000 104, 500010 5700000 104, 500010 5700008 104, 500000 5700008 104, 500000 5700000 104))', 13),
  (217, 'old_ground', 211, 210, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((500000 5700000 100, 500000 5700008 100, 500010 5700008 100, 500010 5700000 100, 500000 5700000 100))', 13),
  -- 1.7: a TriangulatedSurface with one leaf per triangle
  (220, 'tin_geometry', NULL, 220, 0, 0, 1, 0, 0, NULL, 15),
  (221, 't_1', 220, 220, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5699980 100, 500040 5700040 101, 499980 5699980 100))', 15),
  (222, 't_2', 220, 220, 0, 0, 0, 0, 0, 'SRID=25832;POLYGON Z ((499980 5699980 100, 500040 5700040 101, 499980 5700040 101, 499980 5699980 100))', 15);

-- 1.1: implicit_geometry holds local coordinates. They belong to no feature: a template may serve many.
INSERT INTO surface_geometry (id, gmlid, parent_id, root_id, is_solid, is_composite, is_triangulated, is_xlink, is_reverse, implicit_geometry) VALUES
  (200, 'antenna_geometry', NULL, 200, 0, 0, 0, 1, 0, NULL),
  (201, 'ant_1', 200, 200, 0, 0, 0, 1, 0, 'POLYGON Z ((0 0 2, 1 0 0, 0 1 0, 0 0 2))'),
  (202, 'ant_2', 200, 200, 0, 0, 0, 1, 0, 'POLYGON Z ((0 0 2, 0 1 0, 0 0 0, 0 0 2))'),
  (203, 'ant_3', 200, 200, 0, 0, 0, 1, 0, 'POLYGON Z ((0 0 2, 0 0 0, 1 0 0, 0 0 2))'),
  (204, 'ant_4', 200, 200, 0, 0, 0, 1, 0, 'POLYGON Z ((0 0 0, 0 1 0, 1 0 0, 0 0 0))');
INSERT INTO implicit_geometry (id, gmlid, relative_brep_id) VALUES (1, 'antenna_template', 200);

-- 1.2: building_root_id is the top-level building, for itself and for its parts. Codelist values that repeat share a column.
INSERT INTO building (id, objectclass_id, building_parent_id, building_root_id, class, class_codespace, function, function_codespace,
                      year_of_construction, roof_type, measured_height, measured_height_unit, storeys_above_ground,
                      storey_heights_above_ground, storey_heights_ag_unit, lod1_solid_id, lod2_solid_id) VALUES
  (1, 26, NULL, 1, '1000', 'classes.xml', '1100--/\--1200', 'functions.xml--/\--functions.xml', '1950-01-01', '1010', 6, 'm', 2, '3.5 2.5', 'm', NULL, 100),
  (2, 25, 1, 1, NULL, NULL, NULL, NULL, NULL, NULL, 3, 'm', NULL, NULL, NULL, NULL, NULL),
  (13, 26, NULL, 13, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 210, NULL);

-- 1.2: exactly one of building_id, room_id, building_installation_id is set.
INSERT INTO thematic_surface (id, objectclass_id, building_id, lod2_multi_surface_id, lod3_multi_surface_id) VALUES
  (4, 34, 1, 110, NULL),
  (5, 33, 1, 120, NULL),
  (6, 35, 1, 130, NULL),
  (7, 34, 2, NULL, 140),
  (8, 34, 2, NULL, 150),
  (9, 33, 2, NULL, 160),
  (10, 35, 2, NULL, 170),
  (11, 36, 2, NULL, 180);
INSERT INTO opening (id, objectclass_id, lod3_multi_surface_id) VALUES (12, 38, 190);
INSERT INTO opening_to_them_surface (opening_id, thematic_surface_id) VALUES (12, 7);

-- The matrix turns by 90 degrees: x becomes north, y west.
INSERT INTO building_installation (id, objectclass_id, function, building_id, lod2_implicit_rep_id, lod2_implicit_ref_point, lod2_implicit_transformation) VALUES
  (3, 27, '1020', 1, 1, 'SRID=25832;POINT Z (500005 5700004 106)', '0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1');

INSERT INTO address (id, gmlid, street, house_number, zip_code, city, country) VALUES
  (1, 'house_address', 'Turmstrasse', '7', '10559', 'Berlin', 'Germany');
INSERT INTO address_to_building (building_id, address_id) VALUES (1, 1);

-- 1.2: datatype 1 text, 2 whole number, 3 number, 4 URI, 5 date, 6 measure, 7 set; members of a set name it as parent and root.
INSERT INTO cityobject_genericattrib (id, parent_genattrib_id, root_genattrib_id, attrname, datatype, strval, intval, realval, urival, dateval, unit, cityobject_id) VALUES
  (1, NULL, 1, 'owner', 1, 'C. Ampersand & Sons', NULL, NULL, NULL, NULL, NULL, 1),
  (2, NULL, 2, 'flats', 2, NULL, 3, NULL, NULL, NULL, NULL, 1),
  (3, NULL, 3, 'share', 3, NULL, NULL, 0.125, NULL, NULL, NULL, 1),
  (4, NULL, 4, 'page', 4, NULL, NULL, NULL, 'https://example.org/house', NULL, NULL, 1),
  (5, NULL, 5, 'inspected', 5, NULL, NULL, NULL, NULL, '2023-02-01T00:00:00Z', NULL, 1),
  (6, NULL, 6, 'area', 6, NULL, NULL, 80.5, NULL, NULL, 'm2', 1),
  (7, NULL, 7, 'heat', 7, NULL, NULL, NULL, NULL, NULL, NULL, 1),
  (8, 7, 7, 'kWh', 3, NULL, NULL, 12500, NULL, NULL, NULL, 1),
  (9, NULL, 9, 'use', 1, 'shed', NULL, NULL, NULL, NULL, NULL, 2);
INSERT INTO external_reference (id, infosys, name, uri, cityobject_id) VALUES (1, 'cadastre', 'DE-7', NULL, 1);

-- 1.7: relief_feature - relief_feat_to_rel_comp - relief_component, with the row of its class
INSERT INTO relief_feature (id, objectclass_id, lod) VALUES (14, 14, 2);
INSERT INTO relief_component (id, objectclass_id, lod) VALUES (15, 16, 2);
INSERT INTO relief_feat_to_rel_comp (relief_component_id, relief_feature_id) VALUES (15, 14);
INSERT INTO tin_relief (id, objectclass_id, surface_geometry_id) VALUES (15, 16, 220);
