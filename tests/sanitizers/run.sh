#!/usr/bin/env bash
# run.sh [unit|verification|regression|architecture|parallel ...]: builds these tests (all by default) with the
# address and undefined-behaviour sanitizers and runs them, parallel on 1 and 3 ranks. The first finding ends a test
# with a report.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../../run/set_up.sh"

case ${1:-} in
  -h | --help)
    show_help
    exit 0
    ;;
esac
preset=sanitize
build=$top/build-sanitize
[ $# -gt 0 ] || set -- unit verification regression architecture parallel
echo "== sanitizers: $* =="
build_targets "${@/%/_tests}"
# Leaks are looked for with ASAN_OPTIONS=fast_unwind_on_malloc=0, which takes five times as long: only the slow unwinder
# sees the libraries of MPI, whose leaks are theirs.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0}
export LSAN_OPTIONS=suppressions=$here/leaks.txt:print_suppressions=0 UBSAN_OPTIONS=print_stacktrace=1
ctest --test-dir "$build" --output-on-failure -j 2 -E 'parallel_[257]' -L "^($(IFS='|' && echo "$*"))\$"
