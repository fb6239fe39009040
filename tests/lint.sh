#!/usr/bin/env bash
# lint.sh [--all | COMMIT]: checks the format of all C++ files with clang-format, and the sources of src/ and partition/
# that differ from a commit with clang-tidy (--all: every one of them). By default that is the commit where this branch left
# main, on main itself the commit before. Of a changed header one source is checked that includes it, by others or itself.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../run/set_up.sh"

case ${1:-} in
  -h | --help)
    show_help
    exit 0
    ;;
esac
cd "$top"
preset=tidy # no precompiled headers of g++, which clang does not read, and no unity sources
build=$top/build-tidy

state_before() {
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null || true)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
    base=$(git rev-parse --verify --quiet HEAD~1 || true)
  fi
  echo "$base"
}

# Files that include a header, which is named from src/ or include/.
includers_of() {
  local name=${1#include/}
  git grep -lF "#include \"${name#src/}\"" -- 'src/*' 'partition/*' 'include/*' || true
}

# A source that includes the header, if need be by other headers (of which none includes itself).
source_with() {
  local file found
  local -a files
  mapfile -t files < <(includers_of "$1")
  for file in "${files[@]}"; do
    if [[ $file == *.cpp ]]; then
      echo "$file"
      return
    fi
  done
  for file in "${files[@]}"; do
    found=$(source_with "$file")
    if [ -n "$found" ]; then
      echo "$found"
      return
    fi
  done
}

# sources_to_check --all | COMMIT
sources_to_check() {
  local file
  if [ "$1" = --all ]; then
    git ls-files 'src/*.cpp' 'partition/*.cpp'
    return
  fi
  git diff --name-only --diff-filter=d "$1" -- include src partition | while read -r file; do
    case $file in
      *.cpp) echo "$file" ;;
      *.hpp) source_with "$file" ;;
    esac
  done | sort -u
}

echo "== clang-format =="
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
before=${1:-$(state_before)}
if [ -z "$before" ]; then
  echo "clang-tidy is left out: there is no commit to compare with, see --all"
  exit 0
fi
mapfile -t sources < <(sources_to_check "$before")
echo "== clang-tidy: ${#sources[@]} sources =="
[ ${#sources[@]} -gt 0 ] || exit 0
cmake -S "$top" -B "$build" --preset "$preset" >/dev/null
printf '%s\n' "${sources[@]}" | xargs -n 1 -P 2 clang-tidy --quiet -p "$build" 2> >(grep -v 'warnings generated' >&2)
