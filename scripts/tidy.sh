#!/usr/bin/env bash
# clang-tidy on the sources changed since BASE (default: the merge base with main, or the last commit when on main), in the
# dev build. Headers are seen through the sources that include them.
#   scripts/tidy.sh [BASE]    TIDY_LIMIT=n: at most n files
set -euo pipefail
cd "$(dirname "$0")/.."
tidy=$(command -v clang-tidy-16 || command -v clang-tidy) || { echo "clang-tidy is not installed: make install-check" >&2; exit 2; }

base=${1:-}
if [ -z "$base" ]; then
  base=$(git merge-base HEAD origin/main 2>/dev/null || git merge-base HEAD main 2>/dev/null || true)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then base=HEAD~1; fi
fi
if ! git rev-parse --verify --quiet "$base^{commit}" >/dev/null; then
  echo "clang-tidy: there is no commit $base to compare with; nothing checked"
  exit 0
fi

mapfile -t sources < <(git diff --name-only --diff-filter=d "$base" -- 'core/*.cpp' 'services/*.cpp')
if [ ${#sources[@]} -eq 0 ]; then
  echo "clang-tidy: no source of core or services changed since $base"
  exit 0
fi
if [ -n "${TIDY_LIMIT:-}" ] && [ ${#sources[@]} -gt "$TIDY_LIMIT" ]; then
  echo "clang-tidy: ${#sources[@]} sources changed since $base, looking at the first $TIDY_LIMIT"
  sources=("${sources[@]:0:$TIDY_LIMIT}")
fi

# A database without precompiled headers: they are GCC's. Generated message headers come from the dev build.
cmake --preset dev -B build/tidy -DCITYMESH_PRECOMPILE=OFF -DCITYMESH_TESTS=OFF >build/.configure-tidy.log 2>&1 \
  || { cat build/.configure-tidy.log >&2; exit 1; }
if [ -d proto ]; then cmake --build build/tidy --target citymesh_proto >/dev/null; fi
echo "clang-tidy: ${#sources[@]} sources changed since $base"
# The database names GCC's warnings, and GCC's kind of coroutines is what Boost.Asio looks for.
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 "$tidy" -p build/tidy --quiet --warnings-as-errors='*' \
  --extra-arg=-Wno-unknown-warning-option --extra-arg=-DBOOST_ASIO_HAS_CO_AWAIT
