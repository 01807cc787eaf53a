#!/bin/sh
# Called as the loaders of 3DCityDB are, `citydb import citygml … DIR` and `impexp import DIR`: stores the files of the folder with
# ours. The variables are theirs.
set -eu
case $(basename "$0") in
  citydb) version=5.1 ;;
  impexp) version=4 ;;
esac
for folder in "$@"; do :; done
export PGHOST="$CITYDB_HOST" PGPORT="${CITYDB_PORT:-5432}" PGDATABASE="$CITYDB_NAME" PGUSER="$CITYDB_USERNAME" PGPASSWORD="$CITYDB_PASSWORD"
exec citymesh_citydb_load postgresql:// "$version" "$SRID" 1 "$folder"/*.gml*
