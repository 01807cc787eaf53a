#!/usr/bin/env bash
# Runs every libFuzzer program of a build directory for some seconds each, from its corpus.
#   scripts/fuzz.sh build/fuzz SECONDS
set -euo pipefail
build=$1 seconds=$2
[ -s "$build/fuzzers.txt" ] || { echo "no fuzzers in $build: configure with the preset fuzz" >&2; exit 2; }
while IFS=' ' read -r program corpus; do
  [ -n "$program" ] || continue
  name=$(basename "$program")
  work="$build/corpus/$name" seeds="$build/seeds/$name"
  mkdir -p "$work" "$seeds"
  IFS=';' read -ra places <<<"$corpus"
  for place in "${places[@]}"; do
    if [ -d "$place" ]; then find "$place" -type f -exec cp {} "$seeds" \; ; elif [ -f "$place" ]; then cp "$place" "$seeds"; fi
  done
  echo "== $name: $seconds s"
  "$program" -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$build/$name-" "$work" "$seeds" 2>"$build/$name.log" \
    || { tail -60 "$build/$name.log"; exit 1; }
  grep -E 'number_of_executed_units|peak_rss' "$build/$name.log"
done <"$build/fuzzers.txt"
