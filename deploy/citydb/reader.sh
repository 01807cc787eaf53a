#!/bin/sh
# Runs once, when the database is made: the role citymesh, which may read the city model and nothing else.
set -eu
psql -v ON_ERROR_STOP=1 --no-psqlrc -q -U "${POSTGRES_USER:-postgres}" -d "$POSTGRES_DB" <<'SQL'
\set password `cat /run/secrets/citydb_reader_password`
CREATE ROLE citymesh LOGIN PASSWORD :'password';
GRANT CONNECT ON DATABASE :"DBNAME" TO citymesh;
GRANT USAGE ON SCHEMA citydb, citydb_pkg TO citymesh;
GRANT SELECT ON ALL TABLES IN SCHEMA citydb, citydb_pkg TO citymesh;
ALTER DEFAULT PRIVILEGES IN SCHEMA citydb GRANT SELECT ON TABLES TO citymesh;
SQL
