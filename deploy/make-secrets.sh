#!/usr/bin/env bash
# Makes the passwords and API keys of docker-compose.yml, once: deploy/secrets. What is there stays as it is.
#   deploy/make-secrets.sh [--folder DIR] [--port P] [--port-v4 P] [--citymesh COMMAND...]
# --citymesh: how to call the program; default: in the image of docker-compose.yml, which is built if it is missing.
# The ports are those that the databases listen on.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${CITYMESH_SECRETS:-$root/deploy/secrets}
port=5432
port_v4=5432
image=${CITYMESH_IMAGE:-citymesh}
citymesh=()
while [ $# -gt 0 ]; do
  case $1 in
    --folder) folder=$2; shift 2 ;;
    --port) port=$2; shift 2 ;;
    --port-v4) port_v4=$2; shift 2 ;;
    --citymesh) shift; citymesh=("$@"); break ;;
    *) echo "'$1' is no option; expected --folder, --port, --port-v4 or --citymesh" >&2; exit 2 ;;
  esac
done
if [ -e "$folder/api_keys" ]; then
  echo "$folder has secrets already; new ones would lock everybody out. Remove it first if that is meant." >&2
  exit 1
fi
if [ ${#citymesh[@]} -eq 0 ]; then
  docker image inspect "$image" >/dev/null 2>&1 || docker build -f "$root/deploy/Dockerfile" -t "$image" "$root" >&2
  citymesh=(docker run --rm --network none "$image")
fi

# The folder is closed to other users of this machine; the files are open to those of the containers, into which they are mounted
# one by one.
install -d -m 0700 "$folder"
umask 022
password() { od -An -N24 -tx1 /dev/urandom | tr -d ' \n'; }
# make_key NAME ROLE: its line goes into the file of keys, the key to standard output.
make_key() {
  "${citymesh[@]}" make-key "$1" "$2" 2>"$folder/.shown" >>"$folder/.api_keys"
  grep -o 'citymesh_[^[:space:]]*' "$folder/.shown"
  rm "$folder/.shown"
}
rm -f "$folder/.api_keys"
operator_key=$(make_key operator admin)
make_key prometheus read-own >"$folder/prometheus_key"
password >"$folder/citydb_password"
password >"$folder/grafana_password"
password >"$folder/citydb_reader_password"
source_of() { printf '[serve]\nsource = "postgresql://citymesh:%s@%s:%s/citydb"\n' "$(cat "$folder/citydb_reader_password")" "$1" "$2"; }
source_of citydb "$port" >"$folder/citymesh.toml"
source_of citydb-v4 "$port_v4" >"$folder/citymesh-v4.toml"
mv "$folder/.api_keys" "$folder/api_keys"  # last: now they are complete

echo "Passwords and keys are in $folder. The key of the operator, shown only now:" >&2
echo "$operator_key"
