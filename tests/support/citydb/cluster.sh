#!/usr/bin/env bash
# A private PostgreSQL with PostGIS on a unix socket in a folder of its own. Says `ready FOLDER`, `missing PACKAGES` or `failed WHY`,
# then obeys the lines of standard input: `stop`, `kill`, `start`; to each it says `done` or `failed WHY`. It takes the server and
# the folder away when standard input ends, so also when whoever started it dies.
set -u
trap '' INT HUP

bin=$(ls -d /usr/lib/postgresql/*/bin 2>/dev/null | sort -V | tail -n 1)
[ -n "$bin" ] || bin=$(dirname "$(command -v initdb || echo /nowhere/initdb)")
if [ ! -x "$bin/initdb" ] || [ ! -f "$("$bin/pg_config" --sharedir 2>/dev/null)/extension/postgis.control" ]; then
  echo "missing postgresql-15 postgresql-15-postgis-3"
  exit 0
fi

# Not below TMPDIR: the path of a socket has at most 107 characters, and another user has to reach it.
folder=$(mktemp -d /tmp/citymesh-pg-XXXXXX) || { echo "failed no folder can be made in /tmp"; exit 1; }
run() { "$@"; }
if [ "$(id -u)" -eq 0 ]; then  # the server refuses root
  chown postgres "$folder"
  run() { setpriv --reuid=postgres --regid=postgres --clear-groups env HOME="$folder" "$@"; }
fi
cd "$folder" || exit 1
control() { run "$bin/pg_ctl" -D "$folder/data" -l "$folder/log" -s -w "$@" </dev/null >>"$folder/control" 2>&1; }
clean() {
  [ -f "$folder/data/postmaster.pid" ] && control -m immediate stop
  cd / && rm -rf "$folder"
}
trap clean EXIT
answer() { if [ "$1" -eq 0 ]; then echo done; else echo "failed $(tail -qn 2 "$folder/control" "$folder/log" 2>/dev/null | tr '\n' ' ')"; fi; }

touch "$folder/control" && chmod a+rw "$folder/control"
run "$bin/initdb" -D "$folder/data" -U citymesh --auth=trust -E UTF8 --locale=C.UTF-8 --no-sync --no-instructions \
  </dev/null >>"$folder/control" 2>&1 || { echo "failed $(tail -n 2 "$folder/control" | tr '\n' ' ')"; exit 1; }
cat >>"$folder/data/postgresql.conf" <<CONF
listen_addresses = ''
unix_socket_directories = '$folder'
port = 5432
max_connections = 64
timezone = 'UTC'
# Nothing here has to survive a crash of the machine.
fsync = off
synchronous_commit = off
full_page_writes = off
wal_level = minimal
max_wal_senders = 0
max_wal_size = '4GB'
checkpoint_timeout = '1h'
shared_buffers = '128MB'
maintenance_work_mem = '128MB'
autovacuum = off
CONF
control start || { answer 1; exit 1; }
echo "ready $folder"

while read -r command; do
  case $command in
    stop) control -m fast stop; answer $? ;;
    kill)
      pid=$(head -n 1 "$folder/data/postmaster.pid")
      kill -KILL "$pid"
      while kill -0 "$pid" 2>/dev/null; do sleep 0.02; done
      answer 0
      ;;
    start)
      for _ in 1 2 3 4 5 6 7 8 9 10; do  # after a kill the memory of its children may still be in use
        control start
        status=$?
        [ $status -eq 0 ] && break
        sleep 0.2
      done
      answer $status
      ;;
    *) echo "failed unknown command $command" ;;
  esac
done
