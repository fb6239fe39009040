#!/usr/bin/env bash
# All tests, through CTest: installs what is missing, builds Release, runs. Arguments go to ctest (-L parallel, -R ...).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../run/set_up.sh"

install_packages
build_targets all
[ $# -gt 0 ] || set -- -LE paraview # drawing needs a display server: tests/run.sh -L paraview
ctest --test-dir "$build" --output-on-failure "$@"
