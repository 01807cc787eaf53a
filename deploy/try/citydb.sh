#!/bin/sh
# The entry point of the image that stands for 3dcitydb/3dcitydb-pg: makes the database at the first start, listening on the socket
# only, then becomes the server. Connections over TCP show a password, those of this machine too.
set -eu
if [ ! -s "$PGDATA/PG_VERSION" ]; then
  initdb -U postgres --pwfile="$POSTGRES_PASSWORD_FILE" --auth-local=trust --auth-host=scram-sha-256 -E UTF8 --locale=C.UTF-8 >/dev/null
  echo "host all all all scram-sha-256" >>"$PGDATA/pg_hba.conf"
  echo "unix_socket_directories = '$PGHOST'" >>"$PGDATA/postgresql.conf"
  pg_ctl -s -w start -o "-c listen_addresses=''" >/dev/null
  export POSTGRES_USER=postgres
  make() { psql -v ON_ERROR_STOP=1 --no-psqlrc -q -U postgres -d "$POSTGRES_DB" "$@"; }
  createdb -U postgres "$POSTGRES_DB"
  make -v schema=citydb -v srid="$SRID" -v srs_name="urn:ogc:def:crs:EPSG::$SRID" -v json=jsonb -v minor=1 -v revision=3 \
    -f "/3dcitydb/schema_v$CITYDB_MAJOR.sql" >/dev/null
  make -c "ALTER DATABASE \"$POSTGRES_DB\" SET search_path TO citydb, citydb_pkg, public"
  for script in /docker-entrypoint-initdb.d/*.sh; do
    [ -e "$script" ] && "$script"
  done
  pg_ctl -s -m fast -w stop
fi
exec "$@"
