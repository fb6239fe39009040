#!/usr/bin/env bash
# All tests: installs what is missing, builds Release and runs CTest, then runs the unit tests under the sanitizers
# and the fuzz targets for a short while. With arguments only CTest, which gets them (-L parallel, -R ...).
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../run/set_up.sh"

install_packages tests
build_targets all
if [ $# -gt 0 ]; then
  ctest --test-dir "$build" --output-on-failure "$@"
  exit
fi
ctest --test-dir "$build" --output-on-failure -LE paraview # drawing needs a display server: tests/run.sh -L paraview
"$here/sanitizers/run.sh" unit
"$here/fuzz/run.sh" 20
