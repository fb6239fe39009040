#!/usr/bin/env bash
# run.sh [unit|verification|regression|architecture|parallel ...]: builds these tests (all by default) with the
# address and undefined-behaviour sanitizers and runs them. The first finding ends a test with a report.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../../run/set_up.sh"

preset=sanitize
build=$top/build-sanitize
[ $# -gt 0 ] || set -- unit verification regression architecture parallel
echo "== sanitizers: $* =="
build_targets "${@/%/_tests}"
# What MPI and HDF5 keep until the end is theirs; walking their stacks needs the slow unwinder.
export ASAN_OPTIONS=fast_unwind_on_malloc=0 LSAN_OPTIONS=suppressions=$here/leaks.txt:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
ctest --test-dir "$build" --output-on-failure -L "^($(IFS='|' && echo "$*"))\$"
