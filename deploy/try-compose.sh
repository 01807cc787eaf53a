#!/usr/bin/env bash
# Builds the images, brings up the stack of docker-compose.yml with both versions of 3DCityDB, sample data and metrics, runs the tests
# of databases and of the whole against it, and takes everything down, also when something fails. Needs root on Debian 12, no Docker
# engine and no registry: podman runs the containers, debootstrap makes their base (packages: deploy/packages.txt, group try).
#   deploy/try-compose.sh [--programs BUILD] [--work DIR] [--ccache DIR] [--jobs N] [--mirror URL]
# --programs: takes citymesh, citymesh_citydb_load and integration_citydb out of this build folder, where otherwise the image builds
#             them from source (half an hour on two cores)
# --work:     keeps images and base there for the next time; default: a new folder that is removed
# --ccache:   a cache of compilations that outlives the image
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
programs='' work='' ccache='' jobs='' mirror=http://deb.debian.org/debian
while [ $# -gt 0 ]; do
  case $1 in
    --programs) programs=$(realpath "$2") ;;
    --work) mkdir -p "$2" && work=$(realpath "$2") ;;
    --ccache) mkdir -p "$2" && ccache=$(realpath "$2") ;;
    --jobs) jobs=$2 ;;
    --mirror) mirror=$2 ;;
    *) sed -n '2,/^set/{/^#/s/^# \?//p}' "$0" >&2; exit 2 ;;
  esac
  shift 2
done
for program in podman buildah runc docker-compose debootstrap; do
  command -v "$program" >/dev/null || { echo "$program is missing: scripts/install_packages.sh try" >&2; exit 2; }
done

kept=$work
[ -n "$work" ] || work=$(mktemp -d /tmp/citymesh-try-XXXXXX)
run=$(mktemp -d /tmp/citymesh-run-XXXXXX)  # of this run only; the path of a socket is short
step() { printf '\n== [%d s] %s\n' $SECONDS "$*"; }

# A store and settings of our own: nothing of the machine's containers is seen or touched.
cat >"$run/containers.conf" <<CONF
[containers]
default_ulimits = ["nofile=1024:1024", "nproc=4096:4096"]
log_driver = "k8s-file"
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
CONF
cat >"$run/storage.conf" <<CONF
[storage]
driver = "overlay"
graphroot = "$work/storage"
runroot = "$run/storage"
CONF
export CONTAINERS_CONF=$run/containers.conf CONTAINERS_STORAGE_CONF=$run/storage.conf DOCKER_HOST=unix://$run/podman.sock
export BUILDAH_ISOLATION=chroot BUILDAH_FORMAT=docker COMPOSE_PROJECT_NAME=citymesh-try
compose() { docker-compose -f "$run/compose.yml" "$@"; }

service=
clean() {
  status=$?
  trap - EXIT INT TERM
  step "down"
  if [ $status -ne 0 ] && [ -e "$run/compose.yml" ]; then
    for name in $(podman ps -a --format '{{.Names}}'); do echo "-- $name"; podman logs --tail 15 "$name" 2>&1 || true; done
  fi
  [ ! -e "$run/compose.yml" ] || compose down --volumes --timeout 30 || true
  podman rm -fa >/dev/null 2>&1 || true
  [ -z "$service" ] || { kill "$service" 2>/dev/null && wait "$service" 2>/dev/null; } || true
  sleep 1  # what ends with the containers still writes there
  umount "$work/storage/overlay" 2>/dev/null || true
  rm -rf "$run"
  [ -n "$kept" ] || rm -rf "$work"
  [ $status -eq 0 ] && echo "everything passed" || echo "failed with status $status"
  exit $status
}
trap clean EXIT
trap 'exit 130' INT TERM

step "base image"
if ! podman image exists localhost/citymesh-base; then
  [ -e "$work/base/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$work/base" "$mirror" >"$run/debootstrap.log" 2>&1 ||
    { tail -n 20 "$run/debootstrap.log" >&2; exit 1; }
  # As small as debian:bookworm-slim: no documents, no languages, no caches of packages.
  (cd "$work/base" && rm -rf var/cache/apt/archives/*.deb var/lib/apt/lists/* usr/share/{doc,man,locale,info}/*)
  printf 'path-exclude /usr/share/%s/*\n' doc man locale info >"$work/base/etc/dpkg/dpkg.cfg.d/slim"
  printf 'DPkg::Post-Invoke { "rm -f /var/cache/apt/archives/*.deb || true"; };\n' >"$work/base/etc/apt/apt.conf.d/slim"
  container=$(buildah from scratch)
  buildah add -q "$container" "$work/base" / >/dev/null
  buildah commit -q --rm "$container" localhost/citymesh-base >/dev/null
  rm -rf "$work/base"
fi
build() { nice buildah bud -q --layers --build-arg BASE=localhost/citymesh-base --build-arg JOBS="$jobs" "$@" "$root"; }
# The last stage of a Dockerfile, for which the stage `build` is an image that is there.
last_stage_of() { awk '/^ARG BASE/ || /^FROM .* AS run/ { on = 1 } /^FROM .* AS build/ { on = 0 } on' "$1"; }

if [ -n "$programs" ]; then
  step "images, with the programs of $programs"
  container=$(buildah from scratch)
  strip -o "$run/citymesh" "$programs/services/apps/citymesh"
  strip -o "$run/load" "$programs/tests/support/citydb/citymesh_citydb_load"
  buildah copy -q "$container" "$run/citymesh" /out/usr/bin/citymesh >/dev/null
  buildah copy -q "$container" "$run/load" /tools/usr/bin/citymesh_citydb_load >/dev/null
  buildah commit -q --rm "$container" localhost/citymesh-build >/dev/null
  tools=citymesh-build
else
  step "programs, from source"
  cache=()
  [ -z "$ccache" ] || cache=(--volume "$ccache:/ccache")
  build "${cache[@]}" -f deploy/Dockerfile --target build -t localhost/citymesh-build
  build "${cache[@]}" -f deploy/try/tools.Dockerfile --target build -t localhost/citymesh-tools-build
  tools=citymesh-tools-build
fi
step "images of the service and of its tests"
last_stage_of deploy/Dockerfile >"$run/Dockerfile"
last_stage_of deploy/try/tools.Dockerfile >"$run/tools.Dockerfile"
build --build-context build=container-image://localhost/citymesh-build -f "$run/Dockerfile" -t localhost/citymesh
build --build-context "build=container-image://localhost/$tools" -f "$run/tools.Dockerfile" -t localhost/citymesh-try-tools
step "images of databases and Prometheus"
build -f deploy/try/citydb.Dockerfile -t localhost/citymesh-try-citydb
build -f deploy/try/prometheus.Dockerfile -t localhost/citymesh-try-prometheus
podman images --format 'table {{.Repository}} {{.Tag}} {{.Size}}'

step "secrets and ports"
python3 - citydb citydb-v4 citymesh citymesh-grpc citymesh-v4 citymesh-v4-grpc prometheus >"$run/ports.json" <<'PYTHON'
import json, socket, sys
free = [socket.create_server(("127.0.0.1", 0)) for _ in sys.argv[1:]]
print(json.dumps({name: place.getsockname()[1] for name, place in zip(sys.argv[1:], free)}))
PYTHON
port() { python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$run/ports.json" "$1"; }
CITYMESH_KEY=$(deploy/make-secrets.sh --folder "$run/secrets" --port "$(port citydb)" --port-v4 "$(port citydb-v4)" \
  --citymesh podman run --rm --network none localhost/citymesh)
sed "s/citymesh:8080/127.0.0.1:$(port citymesh)/" deploy/prometheus/prometheus.yml >"$run/prometheus.yml"
CITYMESH_SECRETS=$run/secrets CITYMESH_IMAGE=localhost/citymesh docker-compose --profile v4 --profile load --profile metrics config |
  python3 deploy/try/host_network.py "$run/ports.json" "$run/prometheus.yml" >"$run/compose.yml"
cat "$run/ports.json"

step "databases"
podman system service --time 0 "$DOCKER_HOST" 2>"$run/service.log" &
service=$!
for _ in $(seq 100); do [ -S "$run/podman.sock" ] && break; sleep 0.1; done
container_of() { podman ps -a --filter "label=com.docker.compose.service=$1" --format '{{.Names}}' | head -n 1; }
# healthy SERVICE CHECK: the check of the compose file or the image, in the container, until it holds.
healthy() {
  for _ in $(seq 120); do
    podman exec "$(container_of "$1")" sh -c "$2" >/dev/null 2>&1 && { echo "$1 is healthy"; return; }
    sleep 0.5
  done
  echo "$1 is not healthy: $2" >&2
  return 1
}
check_of() {
  python3 - "$1" <<'PYTHON'
import subprocess, sys, yaml
text = open("docker-compose.yml", encoding="utf-8").read()
print(yaml.safe_load(text)["services"][sys.argv[1]]["healthcheck"]["test"][-1].replace("$$", "$"))
PYTHON
}
compose up -d citydb citydb-v4
for name in citydb citydb-v4; do healthy $name "$(check_of $name)"; done

step "sample data"
for name in load load-v4; do
  compose up -d $name
  [ "$(podman wait "$(container_of $name)")" = 0 ] || exit 1
  podman logs "$(container_of $name)"
done

step "service and metrics"
compose up -d citymesh citymesh-v4 prometheus
image_check=$(podman image inspect localhost/citymesh --format '{{index .HealthCheck.Test 3}}')
for name in citymesh citymesh-v4; do healthy $name "$image_check"; done
podman ps --format 'table {{.Names}} {{.Image}} {{.Status}}'

step "tests of the whole"
export CITYMESH_KEY CITYMESH_SECRETS=$run/secrets CITYMESH_STACK=$run/ports.json
PYTHONPATH=tests/e2e/jobs CITYMESH_ROOT=$root /usr/bin/python3 -B -m unittest discover -v -s tests/e2e/deployment -p 'stack_test.py'

step "tests of databases, by URL"
# They make databases of both versions for themselves.
CITYMESH_TEST_CITYDB="postgresql://postgres@127.0.0.1:$(port citydb)/postgres"
PGPASSWORD=$(cat "$run/secrets/citydb_password")
export CITYMESH_TEST_CITYDB PGPASSWORD
if [ -n "$programs" ]; then
  "$programs/tests/integration/citydb/integration_citydb" --gtest_brief=1
else
  podman run --rm --network host --env PGPASSWORD --env CITYMESH_TEST_CITYDB --volume "$root/tests:/src/tests:ro" \
    localhost/citymesh-try-tools integration_citydb --gtest_brief=1
fi

step "polite end"
compose stop --timeout 60 citymesh citymesh-v4
for name in citymesh citymesh-v4; do
  podman logs "$(container_of $name)" 2>&1 | tail -n 1
  [ "$(podman inspect "$(container_of $name)" --format '{{.State.ExitCode}}')" = 0 ] || exit 1
done
