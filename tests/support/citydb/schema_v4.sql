-- A 3DCityDB of version 4.4 reduced to what buildings and TIN relief need: the documented tables, columns, types, indexes, sequences and
-- rows of OBJECTCLASS and DATABASE_SRS; no other modules, foreign keys or functions. Variables as psql has them:
--   psql -v schema=citydb -v srid=25832 -v srs_name=urn:ogc:def:crs:EPSG::25832 -f schema_v4.sql
CREATE EXTENSION IF NOT EXISTS postgis;
CREATE SCHEMA :"schema";
CREATE SCHEMA IF NOT EXISTS citydb_pkg;
SET search_path TO :"schema", public;

CREATE TABLE database_srs (
  srid integer PRIMARY KEY,
  gml_srs_name varchar(1000)
);
INSERT INTO database_srs VALUES (:srid, :'srs_name');

CREATE TABLE objectclass (
  id integer PRIMARY KEY,
  is_ade_class numeric,
  is_toplevel numeric,
  classname varchar(256),
  tablename varchar(30),
  superclass_id integer,
  baseclass_id integer,
  ade_id integer
);
INSERT INTO objectclass (id, is_ade_class, is_toplevel, classname, tablename, superclass_id, baseclass_id) VALUES
  (0, 0, 0, 'Undefined', NULL, NULL, NULL),
  (1, 0, 0, '_GML', 'cityobject', NULL, NULL),
  (2, 0, 0, '_Feature', 'cityobject', 1, 1),
  (3, 0, 0, '_CityObject', 'cityobject', 2, 2),
  (4, 0, 1, 'LandUse', 'land_use', 3, 3),
  (5, 0, 1, 'GenericCityObject', 'generic_cityobject', 3, 3),
  (14, 0, 1, 'ReliefFeature', 'relief_feature', 3, 3),
  (15, 0, 0, '_ReliefComponent', 'relief_component', 3, 3),
  (16, 0, 0, 'TINRelief', 'tin_relief', 15, 3),
  (17, 0, 0, 'MassPointRelief', 'masspoint_relief', 15, 3),
  (18, 0, 0, 'BreaklineRelief', 'breakline_relief', 15, 3),
  (19, 0, 0, 'RasterRelief', 'raster_relief', 15, 3),
  (20, 0, 0, '_Site', 'cityobject', 3, 3),
  (24, 0, 0, '_AbstractBuilding', 'building', 20, 3),
  (25, 0, 0, 'BuildingPart', 'building', 24, 3),
  (26, 0, 1, 'Building', 'building', 24, 3),
  (27, 0, 0, 'BuildingInstallation', 'building_installation', 3, 3),
  (28, 0, 0, 'IntBuildingInstallation', 'building_installation', 3, 3),
  (29, 0, 0, '_BuildingBoundarySurface', 'thematic_surface', 3, 3),
  (30, 0, 0, 'BuildingCeilingSurface', 'thematic_surface', 29, 3),
  (31, 0, 0, 'InteriorBuildingWallSurface', 'thematic_surface', 29, 3),
  (32, 0, 0, 'BuildingFloorSurface', 'thematic_surface', 29, 3),
  (33, 0, 0, 'BuildingRoofSurface', 'thematic_surface', 29, 3),
  (34, 0, 0, 'BuildingWallSurface', 'thematic_surface', 29, 3),
  (35, 0, 0, 'BuildingGroundSurface', 'thematic_surface', 29, 3),
  (36, 0, 0, 'BuildingClosureSurface', 'thematic_surface', 29, 3),
  (37, 0, 0, '_BuildingOpening', 'opening', 3, 3),
  (38, 0, 0, 'BuildingWindow', 'opening', 37, 3),
  (39, 0, 0, 'BuildingDoor', 'opening', 37, 3),
  (40, 0, 0, 'BuildingFurniture', 'building_furniture', 3, 3),
  (41, 0, 0, 'BuildingRoom', 'room', 3, 3),
  (60, 0, 0, 'OuterBuildingCeilingSurface', 'thematic_surface', 29, 3),
  (61, 0, 0, 'OuterBuildingFloorSurface', 'thematic_surface', 29, 3);

CREATE SEQUENCE cityobject_seq;
CREATE TABLE cityobject (
  id bigint DEFAULT nextval('cityobject_seq') PRIMARY KEY,
  objectclass_id integer NOT NULL,
  gmlid varchar(256),
  gmlid_codespace varchar(1000),
  name varchar(1000),
  name_codespace varchar(4000),
  description varchar(4000),
  envelope geometry(PolygonZ, :srid),
  creation_date timestamptz,
  termination_date timestamptz,
  relative_to_terrain varchar(256),
  relative_to_water varchar(256),
  last_modification_date timestamptz,
  updating_person varchar(256),
  reason_for_update varchar(4000),
  lineage varchar(256),
  xml_source text
);
CREATE INDEX cityobject_inx ON cityobject (gmlid, gmlid_codespace);
CREATE INDEX cityobject_objectclass_fkx ON cityobject (objectclass_id);
CREATE INDEX cityobject_envelope_spx ON cityobject USING gist (envelope);
CREATE INDEX cityobj_creation_date_inx ON cityobject (creation_date);
CREATE INDEX cityobj_term_date_inx ON cityobject (termination_date);
CREATE INDEX cityobj_last_mod_date_inx ON cityobject (last_modification_date);
CREATE INDEX cityobject_lineage_inx ON cityobject (lineage);

CREATE SEQUENCE surface_geometry_seq;
CREATE TABLE surface_geometry (
  id bigint DEFAULT nextval('surface_geometry_seq') PRIMARY KEY,
  gmlid varchar(256),
  gmlid_codespace varchar(1000),
  parent_id bigint,
  root_id bigint,
  is_solid numeric,
  is_composite numeric,
  is_triangulated numeric,
  is_xlink numeric,
  is_reverse numeric,
  solid_geometry geometry(PolyhedralSurfaceZ, :srid),
  geometry geometry(PolygonZ, :srid),
  implicit_geometry geometry(PolygonZ),
  cityobject_id bigint
);
CREATE INDEX surface_geom_inx ON surface_geometry (gmlid, gmlid_codespace);
CREATE INDEX surface_geom_parent_fkx ON surface_geometry (parent_id);
CREATE INDEX surface_geom_root_fkx ON surface_geometry (root_id);
CREATE INDEX surface_geom_cityobj_fkx ON surface_geometry (cityobject_id);
CREATE INDEX surface_geom_spx ON surface_geometry USING gist (geometry);
CREATE INDEX surface_geom_solid_spx ON surface_geometry USING gist (solid_geometry);

CREATE TABLE building (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  building_parent_id bigint,
  building_root_id bigint,
  class varchar(256),
  class_codespace varchar(4000),
  function varchar(1000),
  function_codespace varchar(4000),
  usage varchar(1000),
  usage_codespace varchar(4000),
  year_of_construction date,
  year_of_demolition date,
  roof_type varchar(256),
  roof_type_codespace varchar(4000),
  measured_height double precision,
  measured_height_unit varchar(4000),
  storeys_above_ground numeric(8, 0),
  storeys_below_ground numeric(8, 0),
  storey_heights_above_ground varchar(4000),
  storey_heights_ag_unit varchar(4000),
  storey_heights_below_ground varchar(4000),
  storey_heights_bg_unit varchar(4000),
  lod1_terrain_intersection geometry(MultiLineStringZ, :srid),
  lod2_terrain_intersection geometry(MultiLineStringZ, :srid),
  lod3_terrain_intersection geometry(MultiLineStringZ, :srid),
  lod4_terrain_intersection geometry(MultiLineStringZ, :srid),
  lod2_multi_curve geometry(MultiLineStringZ, :srid),
  lod3_multi_curve geometry(MultiLineStringZ, :srid),
  lod4_multi_curve geometry(MultiLineStringZ, :srid),
  lod0_footprint_id bigint,
  lod0_roofprint_id bigint,
  lod1_multi_surface_id bigint,
  lod2_multi_surface_id bigint,
  lod3_multi_surface_id bigint,
  lod4_multi_surface_id bigint,
  lod1_solid_id bigint,
  lod2_solid_id bigint,
  lod3_solid_id bigint,
  lod4_solid_id bigint
);
CREATE INDEX building_parent_fkx ON building (building_parent_id);
CREATE INDEX building_root_fkx ON building (building_root_id);
CREATE INDEX building_lod0footprint_fkx ON building (lod0_footprint_id);
CREATE INDEX building_lod0roofprint_fkx ON building (lod0_roofprint_id);
CREATE INDEX building_lod1msrf_fkx ON building (lod1_multi_surface_id);
CREATE INDEX building_lod2msrf_fkx ON building (lod2_multi_surface_id);
CREATE INDEX building_lod3msrf_fkx ON building (lod3_multi_surface_id);
CREATE INDEX building_lod4msrf_fkx ON building (lod4_multi_surface_id);
CREATE INDEX building_lod1solid_fkx ON building (lod1_solid_id);
CREATE INDEX building_lod2solid_fkx ON building (lod2_solid_id);
CREATE INDEX building_lod3solid_fkx ON building (lod3_solid_id);
CREATE INDEX building_lod4solid_fkx ON building (lod4_solid_id);

CREATE TABLE thematic_surface (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  building_id bigint,
  room_id bigint,
  building_installation_id bigint,
  lod2_multi_surface_id bigint,
  lod3_multi_surface_id bigint,
  lod4_multi_surface_id bigint
);
CREATE INDEX them_surface_building_fkx ON thematic_surface (building_id);
CREATE INDEX them_surface_room_fkx ON thematic_surface (room_id);
CREATE INDEX them_surface_bldg_inst_fkx ON thematic_surface (building_installation_id);
CREATE INDEX them_surface_objclass_fkx ON thematic_surface (objectclass_id);
CREATE INDEX them_surface_lod2msrf_fkx ON thematic_surface (lod2_multi_surface_id);
CREATE INDEX them_surface_lod3msrf_fkx ON thematic_surface (lod3_multi_surface_id);
CREATE INDEX them_surface_lod4msrf_fkx ON thematic_surface (lod4_multi_surface_id);

CREATE TABLE opening (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  address_id bigint,
  lod3_multi_surface_id bigint,
  lod4_multi_surface_id bigint,
  lod3_implicit_rep_id bigint,
  lod4_implicit_rep_id bigint,
  lod3_implicit_ref_point geometry(PointZ, :srid),
  lod4_implicit_ref_point geometry(PointZ, :srid),
  lod3_implicit_transformation varchar(1000),
  lod4_implicit_transformation varchar(1000)
);
CREATE TABLE opening_to_them_surface (
  opening_id bigint,
  thematic_surface_id bigint,
  PRIMARY KEY (opening_id, thematic_surface_id)
);
CREATE INDEX open_to_them_surface_fkx ON opening_to_them_surface (opening_id);
CREATE INDEX open_to_them_surface_fkx1 ON opening_to_them_surface (thematic_surface_id);

CREATE TABLE building_installation (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  class varchar(256),
  class_codespace varchar(4000),
  function varchar(1000),
  function_codespace varchar(4000),
  usage varchar(1000),
  usage_codespace varchar(4000),
  building_id bigint,
  room_id bigint,
  lod2_brep_id bigint,
  lod3_brep_id bigint,
  lod4_brep_id bigint,
  lod2_other_geom geometry(GeometryZ, :srid),
  lod3_other_geom geometry(GeometryZ, :srid),
  lod4_other_geom geometry(GeometryZ, :srid),
  lod2_implicit_rep_id bigint,
  lod3_implicit_rep_id bigint,
  lod4_implicit_rep_id bigint,
  lod2_implicit_ref_point geometry(PointZ, :srid),
  lod3_implicit_ref_point geometry(PointZ, :srid),
  lod4_implicit_ref_point geometry(PointZ, :srid),
  lod2_implicit_transformation varchar(1000),
  lod3_implicit_transformation varchar(1000),
  lod4_implicit_transformation varchar(1000)
);
CREATE INDEX bldg_inst_building_fkx ON building_installation (building_id);

CREATE TABLE room (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  class varchar(256),
  class_codespace varchar(4000),
  function varchar(1000),
  function_codespace varchar(4000),
  usage varchar(1000),
  usage_codespace varchar(4000),
  building_id bigint,
  lod4_multi_surface_id bigint,
  lod4_solid_id bigint
);
CREATE TABLE building_furniture (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  class varchar(256),
  class_codespace varchar(4000),
  function varchar(1000),
  function_codespace varchar(4000),
  usage varchar(1000),
  usage_codespace varchar(4000),
  room_id bigint,
  lod4_brep_id bigint,
  lod4_other_geom geometry(GeometryZ, :srid),
  lod4_implicit_rep_id bigint,
  lod4_implicit_ref_point geometry(PointZ, :srid),
  lod4_implicit_transformation varchar(1000)
);

CREATE TABLE implicit_geometry (
  id bigint PRIMARY KEY,
  gmlid varchar(256),
  gmlid_codespace varchar(1000),
  mime_type varchar(256),
  reference_to_library varchar(4000),
  library_object bytea,
  relative_brep_id bigint,
  relative_other_geom geometry(GeometryZ)
);

CREATE TABLE address (
  id bigint PRIMARY KEY,
  gmlid varchar(256),
  gmlid_codespace varchar(1000),
  street varchar(1000),
  house_number varchar(256),
  po_box varchar(256),
  zip_code varchar(256),
  city varchar(256),
  state varchar(256),
  country varchar(256),
  multi_point geometry(MultiPointZ, :srid),
  xal_source text
);
CREATE TABLE address_to_building (
  building_id bigint,
  address_id bigint,
  PRIMARY KEY (building_id, address_id)
);

CREATE TABLE cityobject_genericattrib (
  id bigint PRIMARY KEY,
  parent_genattrib_id bigint,
  root_genattrib_id bigint,
  attrname varchar(256) NOT NULL,
  datatype integer,
  strval varchar(4000),
  intval integer,
  realval double precision,
  urival varchar(4000),
  dateval timestamptz,
  unit varchar(4000),
  genattribset_codespace varchar(4000),
  blobval bytea,
  geomval geometry(GeometryZ, :srid),
  surface_geometry_id bigint,
  cityobject_id bigint
);
CREATE INDEX genericattrib_parent_fkx ON cityobject_genericattrib (parent_genattrib_id);
CREATE INDEX genericattrib_root_fkx ON cityobject_genericattrib (root_genattrib_id);
CREATE INDEX genericattrib_geom_fkx ON cityobject_genericattrib (surface_geometry_id);
CREATE INDEX genericattrib_cityobj_fkx ON cityobject_genericattrib (cityobject_id);

CREATE TABLE external_reference (
  id bigint PRIMARY KEY,
  infosys varchar(4000),
  name varchar(4000),
  uri varchar(4000),
  cityobject_id bigint
);
CREATE INDEX ext_ref_cityobject_fkx ON external_reference (cityobject_id);

CREATE TABLE relief_feature (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  lod numeric
);
CREATE TABLE relief_component (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  lod numeric,
  extent geometry(Polygon, :srid)
);
CREATE TABLE relief_feat_to_rel_comp (
  relief_component_id bigint,
  relief_feature_id bigint,
  PRIMARY KEY (relief_component_id, relief_feature_id)
);
CREATE TABLE tin_relief (
  id bigint PRIMARY KEY,
  objectclass_id integer NOT NULL,
  max_length double precision,
  max_length_unit varchar(4000),
  stop_lines geometry(MultiLineStringZ, :srid),
  break_lines geometry(MultiLineStringZ, :srid),
  control_points geometry(MultiPointZ, :srid),
  surface_geometry_id bigint
);

CREATE OR REPLACE FUNCTION citydb_pkg.citydb_version(OUT version text, OUT major_version integer, OUT minor_version integer,
                                          OUT minor_revision integer)
LANGUAGE sql IMMUTABLE AS $$ SELECT '4.4.2'::text, 4, 4, 2 $$;

CREATE OR REPLACE FUNCTION citydb_pkg.db_metadata(schema_name text DEFAULT 'citydb', OUT schema_srid integer, OUT schema_gml_srs_name text,
                                       OUT coord_ref_sys_name text, OUT coord_ref_sys_kind text, OUT wktext text,
                                       OUT versioning text)
LANGUAGE plpgsql STABLE AS $$
BEGIN
  EXECUTE format('SELECT d.srid, d.gml_srs_name, split_part(s.srtext, ''"'', 2), split_part(s.srtext, ''['', 1), s.srtext, ''OFF'' '
                 'FROM %I.database_srs d LEFT JOIN spatial_ref_sys s ON s.srid = d.srid', schema_name)
    INTO schema_srid, schema_gml_srs_name, coord_ref_sys_name, coord_ref_sys_kind, wktext, versioning;
END $$;
