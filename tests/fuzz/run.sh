#!/usr/bin/env bash
# run.sh [SECONDS [TARGET ...]]: builds the fuzz targets with clang and feeds each of them changed inputs for so many
# seconds (20 by default), all at once. What makes new ways through the program is kept in build-sanitize/corpus and is where the next
# run starts; an input that breaks something in build-sanitize/findings.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../../run/set_up.sh"

case ${1:-} in
  -h | --help)
    show_help
    exit 0
    ;;
esac
seconds=${1:-20}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(scene_fuzz block_file_fuzz checkpoint_fuzz)
preset=sanitize
build=$top/build-sanitize
build_targets "${targets[@]}"

TMPDIR=$(mktemp -d)
export TMPDIR # the block files and checkpoints
trap 'rm -rf "$TMPDIR"' EXIT
mkdir -p "$build/findings"
# A string of a dictionary has its quotes and backslashes escaped.
{
  cat "$here/scene.dict"
  # shellcheck disable=SC2016
  grep -o '`[^`]*`' "$top/run/scene_keys.md" | tr -d '`' | sort -u | sed 's/[\"]/\\&/g; s/.*/"&"/'
  sed -n 's/^## \(\[.*\]\)$/"\\x0A\1\\x0A"/p' "$top/run/scene_keys.md"
} >"$build/scene.dict"
declare -A options=(
  [scene_fuzz]="-max_len=10000 -malloc_limit_mb=256 -dict=$build/scene.dict $here/corpus/scene $top/run/scenes"
  [block_file_fuzz]="-max_len=300 -len_control=0 $here/corpus/block_file"
  [checkpoint_fuzz]="-max_len=1200 -len_control=0"
)
fuzz() {
  local target=$1 corpus=$build/corpus/$1 log=$build/$1.log
  mkdir -p "$corpus"
  # shellcheck disable=SC2086
  if ! "$build/$target" "$corpus" ${options[$target]} -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 \
    -artifact_prefix="$build/findings/$target-" >"$log" 2>&1; then
    grep -av '^#' "$log" | tail -n 60
    echo "$target found something: $build/$target FILE runs the input again (FILE: see 'Test unit written to')"
    return 1
  fi
  echo "$target: $(tail -n 1 "$log")"
}
echo "== fuzzing ${targets[*]}, $seconds s =="
jobs=()
for target in "${targets[@]}"; do
  fuzz "$target" &
  jobs+=($!)
done
failed=0
for job in "${jobs[@]}"; do
  wait "$job" || failed=1 # the others still need their files
done
exit $failed
