-- A 3DCityDB of version 5.0 or 5.1 reduced to what buildings and TIN relief need: the documented tables, columns, types, indexes, sequences
-- and rows of NAMESPACE, OBJECTCLASS, DATATYPE and DATABASE_SRS; no other modules, foreign keys or functions. Variables as psql
-- has them; 5.0 has the JSON type json, 5.1 has jsonb:
--   psql -v schema=citydb -v srid=25832 -v srs_name=urn:ogc:def:crs:EPSG::25832 -v minor=1 -v revision=3 -v json=jsonb -f schema_v5.sql
CREATE EXTENSION IF NOT EXISTS postgis;
CREATE SCHEMA :"schema";
CREATE SCHEMA IF NOT EXISTS citydb_pkg;
SET search_path TO :"schema", public;

CREATE TABLE database_srs (
  srid integer PRIMARY KEY,
  srs_name text
);
INSERT INTO database_srs VALUES (:srid, :'srs_name');

CREATE TABLE namespace (
  id integer PRIMARY KEY,
  alias text,
  namespace text,
  ade_id integer
);
INSERT INTO namespace (id, alias, namespace) VALUES
  (1, 'core', 'http://3dcitydb.org/3dcitydb/core/5.0'),
  (3, 'gen', 'http://3dcitydb.org/3dcitydb/generics/5.0'),
  (6, 'dem', 'http://3dcitydb.org/3dcitydb/relief/5.0'),
  (8, 'con', 'http://3dcitydb.org/3dcitydb/construction/5.0'),
  (10, 'bldg', 'http://3dcitydb.org/3dcitydb/building/5.0'),
  (12, 'app', 'http://3dcitydb.org/3dcitydb/appearance/5.0'),
  (18, 'depr', 'http://3dcitydb.org/3dcitydb/deprecated/5.0');

CREATE TABLE objectclass (
  id integer PRIMARY KEY,
  superclass_id integer,
  classname text,
  is_abstract integer,
  is_toplevel integer,
  ade_id integer,
  namespace_id integer,
  schema :json
);
INSERT INTO objectclass (id, superclass_id, classname, is_abstract, is_toplevel, namespace_id) VALUES
  (1, NULL, 'Undefined', 1, 0, 1),
  (2, NULL, 'AbstractObject', 1, 0, 1),
  (3, 2, 'AbstractFeature', 1, 0, 1),
  (4, NULL, 'Address', 0, 0, 1),
  (6, 3, 'AbstractFeatureWithLifespan', 1, 0, 1),
  (7, 6, 'AbstractCityObject', 1, 0, 1),
  (8, 7, 'AbstractSpace', 1, 0, 1),
  (9, 8, 'AbstractLogicalSpace', 1, 0, 1),
  (10, 8, 'AbstractPhysicalSpace', 1, 0, 1),
  (11, 10, 'AbstractUnoccupiedSpace', 1, 0, 1),
  (12, 10, 'AbstractOccupiedSpace', 1, 0, 1),
  (13, 7, 'AbstractSpaceBoundary', 1, 0, 1),
  (14, 13, 'AbstractThematicSurface', 1, 0, 1),
  (15, 14, 'ClosureSurface', 0, 0, 1),
  (500, 13, 'ReliefFeature', 0, 1, 6),
  (501, 13, 'AbstractReliefComponent', 1, 0, 6),
  (502, 501, 'TINRelief', 0, 0, 6),
  (503, 501, 'MassPointRelief', 0, 0, 6),
  (504, 501, 'BreaklineRelief', 0, 0, 6),
  (505, 501, 'RasterRelief', 0, 0, 6),
  (700, 12, 'AbstractConstruction', 1, 0, 8),
  (701, 700, 'OtherConstruction', 0, 1, 8),
  (702, 12, 'AbstractConstructiveElement', 1, 0, 8),
  (703, 12, 'AbstractFillingElement', 1, 0, 8),
  (704, 703, 'Window', 0, 0, 8),
  (705, 703, 'Door', 0, 0, 8),
  (706, 12, 'AbstractFurniture', 1, 0, 8),
  (707, 12, 'AbstractInstallation', 1, 0, 8),
  (708, 14, 'AbstractConstructionSurface', 1, 0, 8),
  (709, 708, 'WallSurface', 0, 0, 8),
  (710, 708, 'GroundSurface', 0, 0, 8),
  (711, 708, 'InteriorWallSurface', 0, 0, 8),
  (712, 708, 'RoofSurface', 0, 0, 8),
  (713, 708, 'FloorSurface', 0, 0, 8),
  (714, 708, 'OuterFloorSurface', 0, 0, 8),
  (715, 708, 'CeilingSurface', 0, 0, 8),
  (716, 708, 'OuterCeilingSurface', 0, 0, 8),
  (717, 14, 'AbstractFillingSurface', 1, 0, 8),
  (718, 717, 'DoorSurface', 0, 0, 8),
  (719, 717, 'WindowSurface', 0, 0, 8),
  (900, 700, 'AbstractBuilding', 1, 0, 10),
  (901, 900, 'Building', 0, 1, 10),
  (902, 900, 'BuildingPart', 0, 0, 10),
  (903, 702, 'BuildingConstructiveElement', 0, 0, 10),
  (904, 11, 'BuildingRoom', 0, 0, 10),
  (905, 707, 'BuildingInstallation', 0, 0, 10),
  (906, 706, 'BuildingFurniture', 0, 0, 10),
  (907, 9, 'AbstractBuildingSubdivision', 1, 0, 10),
  (908, 907, 'BuildingUnit', 0, 0, 10),
  (909, 907, 'Storey', 0, 0, 10);

CREATE TABLE datatype (
  id integer PRIMARY KEY,
  supertype_id integer,
  typename text,
  is_abstract integer,
  ade_id integer,
  namespace_id integer,
  schema :json
);
INSERT INTO datatype (id, typename, is_abstract, namespace_id) VALUES
  (1, 'Undefined', 1, 1),
  (2, 'Boolean', 0, 1),
  (3, 'Integer', 0, 1),
  (4, 'Double', 0, 1),
  (5, 'String', 0, 1),
  (6, 'URI', 0, 1),
  (7, 'Timestamp', 0, 1),
  (8, 'AddressProperty', 0, 1),
  (9, 'AppearanceProperty', 0, 1),
  (10, 'FeatureProperty', 0, 1),
  (11, 'GeometryProperty', 0, 1),
  (12, 'Reference', 0, 1),
  (13, 'CityObjectRelation', 0, 1),
  (14, 'Code', 0, 1),
  (15, 'ExternalReference', 0, 1),
  (16, 'ImplicitGeometryProperty', 0, 1),
  (17, 'Measure', 0, 1),
  (18, 'MeasureOrNilReasonList', 0, 1),
  (19, 'Occupancy', 0, 1),
  (20, 'QualifiedArea', 0, 1),
  (21, 'QualifiedVolume', 0, 1),
  (22, 'StringOrRef', 0, 1),
  (23, 'TimePosition', 0, 1),
  (24, 'Duration', 0, 1),
  (200, 'GenericAttributeSet', 0, 3),
  (700, 'ConstructionEvent', 0, 8),
  (701, 'Elevation', 0, 8),
  (702, 'Height', 0, 8),
  (900, 'RoomHeight', 0, 10);

CREATE TABLE codelist (
  id bigint PRIMARY KEY,
  codelist_type text,
  url text,
  mime_type text
);
CREATE TABLE codelist_entry (
  id bigint PRIMARY KEY,
  codelist_id bigint NOT NULL,
  code text,
  definition text
);

CREATE SEQUENCE feature_seq;
CREATE TABLE feature (
  id bigint DEFAULT nextval('feature_seq') PRIMARY KEY,
  objectclass_id integer NOT NULL,
  objectid text,
  identifier text,
  identifier_codespace text,
  envelope geometry(GeometryZ, :srid),
  last_modification_date timestamptz,
  updating_person text,
  reason_for_update text,
  lineage text,
  creation_date timestamptz,
  termination_date timestamptz,
  valid_from timestamptz,
  valid_to timestamptz
);
CREATE INDEX feature_objectclass_inx ON feature (objectclass_id);
CREATE INDEX feature_objectid_inx ON feature (objectid);
CREATE INDEX feature_envelope_spx ON feature USING gist (envelope);
CREATE INDEX feature_termination_date_inx ON feature (termination_date);

CREATE SEQUENCE geometry_data_seq;
CREATE TABLE geometry_data (
  id bigint DEFAULT nextval('geometry_data_seq') PRIMARY KEY,
  geometry geometry(GeometryZ, :srid),
  implicit_geometry geometry(GeometryZ),
  geometry_properties :json,
  feature_id bigint
);
CREATE INDEX geometry_data_spx ON geometry_data USING gist (geometry);
CREATE INDEX geometry_data_feature_fkx ON geometry_data (feature_id);

CREATE TABLE implicit_geometry (
  id bigint PRIMARY KEY,
  objectid text,
  mime_type text,
  mime_type_codespace text,
  reference_to_library text,
  library_object bytea,
  relative_geometry_id bigint
);
CREATE INDEX implicit_geometry_fkx ON implicit_geometry (relative_geometry_id);

CREATE TABLE address (
  id bigint PRIMARY KEY,
  objectid text,
  identifier text,
  identifier_codespace text,
  street text,
  house_number text,
  po_box text,
  zip_code text,
  city text,
  state text,
  country text,
  free_text :json,
  multi_point geometry(MultiPointZ, :srid),
  content text,
  content_mime_type text
);

CREATE SEQUENCE property_seq;
CREATE TABLE property (
  id bigint DEFAULT nextval('property_seq') PRIMARY KEY,
  feature_id bigint,
  parent_id bigint,
  datatype_id integer NOT NULL,
  namespace_id integer,
  name text,
  val_int bigint,
  val_double double precision,
  val_string text,
  val_timestamp timestamptz,
  val_uri text,
  val_codespace text,
  val_uom text,
  val_array :json,
  val_lod text,
  val_geometry_id bigint,
  val_implicitgeom_id bigint,
  val_implicitgeom_refpoint geometry(PointZ, :srid),
  val_appearance_id bigint,
  val_address_id bigint,
  val_feature_id bigint,
  val_relation_type integer,
  val_content text,
  val_content_mime_type text
);
CREATE INDEX property_feature_fkx ON property (feature_id);
CREATE INDEX property_parent_fkx ON property (parent_id);
CREATE INDEX property_name_inx ON property (name);
CREATE INDEX property_val_lod_inx ON property (val_lod);
CREATE INDEX property_val_feature_fkx ON property (val_feature_id);
CREATE INDEX property_val_geometry_fkx ON property (val_geometry_id);

CREATE OR REPLACE FUNCTION citydb_pkg.citydb_version()
RETURNS TABLE (version text, major_version integer, minor_version integer, minor_revision integer) LANGUAGE sql IMMUTABLE
BEGIN ATOMIC
  SELECT '5.' || :minor::text || '.' || :revision::text, 5, :minor, :revision;
END;

CREATE OR REPLACE FUNCTION citydb_pkg.db_metadata(schema_name text DEFAULT 'citydb')
RETURNS TABLE (srid integer, srs_name text, coord_ref_sys_name text, coord_ref_sys_kind text, wktext text)
LANGUAGE plpgsql STABLE AS $$
BEGIN
  RETURN QUERY EXECUTE format('SELECT d.srid, d.srs_name, split_part(s.srtext, ''"'', 2), split_part(s.srtext, ''['', 1), '
                              's.srtext::text FROM %I.database_srs d LEFT JOIN spatial_ref_sys s ON s.srid = d.srid', schema_name);
END $$;
