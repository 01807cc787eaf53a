#!/usr/bin/env bash
# clang-format over our C++ sources; with --check only says which files differ.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t sources < <(find core services tests -name '*.h' -o -name '*.cpp' | sort)
if [ "${1:-}" = --check ]; then
  exec clang-format --dry-run --Werror "${sources[@]}"
fi
clang-format -i "${sources[@]}"
