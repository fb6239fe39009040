#!/usr/bin/env bash
# All tests: installs what is missing, builds Release and runs CTest, which gets the arguments (-L parallel, -R ...).
# With --thorough as the only argument also the unit tests under the sanitizers and the fuzz targets for a short while.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../run/set_up.sh"

thorough=
if [ "${1:-}" = --thorough ]; then
  thorough=tests
  shift
fi
install_packages $thorough
build_targets all
[ $# -gt 0 ] || set -- -LE paraview # drawing needs a display server: tests/run.sh -L paraview
ctest --test-dir "$build" --output-on-failure "$@"
if [ -n "$thorough" ]; then
  "$here/sanitizers/run.sh" unit
  "$here/fuzz/run.sh" 20
fi
