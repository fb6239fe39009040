#!/usr/bin/env bash
# All tests: installs what is missing, builds Release and runs CTest, checks that sources compile alone, then runs clang-format
# and clang-tidy on what changed, the unit tests under the sanitizers and the fuzz targets for a short while. Arguments go to CTest and mean just that:
# tests/run.sh -L parallel, -R ...
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../run/set_up.sh"

case ${1:-} in
  -h | --help)
    show_help
    exit 0
    ;;
esac
install_packages tests
build_targets all
if [ $# -gt 0 ]; then
  exec ctest --test-dir "$build" --output-on-failure "$@"
fi
ctest --test-dir "$build" --output-on-failure -j 2 -LE paraview # drawing needs a display server
"$here/compile_alone.py"
"$here/lint.sh"
"$here/sanitizers/run.sh" unit
"$here/fuzz/run.sh" 10
