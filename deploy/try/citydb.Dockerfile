# Stands for 3dcitydb/3dcitydb-pg where that cannot be pulled: PostgreSQL and PostGIS of Debian with the tests' reduced schema of
# 3DCityDB. Same variables, same user, same folders, and it runs what lies in /docker-entrypoint-initdb.d.
ARG BASE=debian:bookworm-slim
FROM ${BASE}
RUN apt-get -q update \
 && DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends postgresql-15 postgresql-15-postgis-3 \
 && rm -rf /var/lib/apt/lists/* /var/lib/postgresql/15 \
 && install -d -m 0700 -o postgres -g postgres /var/lib/postgresql/data \
 && install -d /docker-entrypoint-initdb.d
COPY tests/support/citydb/schema_v4.sql tests/support/citydb/schema_v5.sql /3dcitydb/
COPY deploy/try/citydb.sh /usr/local/bin/citydb-entrypoint
# CITYDB_MAJOR: 4 or 5. PGHOST: runc gives a tmpfs at /var/run/postgresql to root alone.
ENV CITYDB_MAJOR=5 PGHOST=/tmp PGDATA=/var/lib/postgresql/data PATH=/usr/lib/postgresql/15/bin:/usr/local/bin:/usr/bin:/bin
USER postgres
VOLUME /var/lib/postgresql/data
STOPSIGNAL SIGINT
ENTRYPOINT ["citydb-entrypoint"]
CMD ["postgres", "-c", "listen_addresses=*"]
