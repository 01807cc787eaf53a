#!/usr/bin/env bash
# Installs what is missing of the named groups of deploy/packages.txt; quick and silent when nothing is.
# Needs root or sudo only when something has to be installed.
#   scripts/install_packages.sh build test
set -euo pipefail
list="$(dirname "$0")/../deploy/packages.txt"

packages_of() {
  awk -v group="[$1]" '
    { sub(/#.*/, "") } NF == 0 { next }
    $1 ~ /^\[/ { on = ($1 == group); known = known || on; next }
    on { print $1 }
    END { exit !known }' "$list" || { echo "no group [$1] in $list" >&2; exit 2; }
}

if ! command -v dpkg-query >/dev/null; then
  echo "This is not Debian: install the packages of deploy/packages.txt by hand (groups: $*)." >&2
  exit 0
fi

wanted=$(for group in "$@"; do packages_of "$group"; done)
installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' $wanted 2>/dev/null | awk '$1 == "ii" { print $2 }' || true)
missing=$(comm -23 <(sort -u <<<"$wanted") <(sort -u <<<"$installed") | tr '\n' ' ')
[ -n "${missing// /}" ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "These packages are missing and neither root nor sudo is at hand: $missing" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing: $missing"
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Dpkg::Use-Pty=0 "$@" </dev/null; }
apt -qq update
# shellcheck disable=SC2086
apt -qq install -y --no-install-recommends $missing
