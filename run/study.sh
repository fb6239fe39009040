#!/usr/bin/env bash
# study.sh verify|stability|accuracy|fidelity|flutter|scenes|stiffness|statics|speed|scaling|all [--quick]: one of the studies, or
# the first five; tables, charts and pages go to run/results/studies. --quick: fewer points, into run/results/studies_quick,
# without pages. statics, speed and scaling need a quiet machine.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/set_up.sh"

studies=(verify stability accuracy fidelity flutter)
case "${1:-}" in
  -h | --help)
    show_help
    exit 0
    ;;
  all) ;;
  verify | stability | accuracy | fidelity | flutter | scenes | stiffness | statics | speed | scaling) studies=("$1") ;;
  *)
    show_help >&2
    exit 2
    ;;
esac
quick=("${@:2}") # --quick or nothing
if [ ${#quick[@]} -gt 0 ] && [ "${quick[*]}" != --quick ]; then
  echo "study.sh: ${quick[*]} is not --quick" >&2
  exit 2
fi
results=$here/results/studies${quick:+_quick}
install_packages tests
build_targets gcpdda gcpdda-study verification_tests
mkdir -p "$results"
run_study() {
  local study=$1 start=$SECONDS
  if [ "$study" = verify ]; then
    "$here/study/verify.sh" "$build" "$results" "${quick[@]}"
  elif [ "$study" = scaling ]; then
    "$here/study/scaling.py" "$build" "$results" "${quick[@]}"
    "$here/study/plot_scaling.py" "$results"
  elif [ "$study" = scenes ]; then
    "$here/study/scenes.py" "$build" "$results" "${quick[@]}"
  elif [ "$study" = stiffness ]; then
    "$here/study/fos_stiffness.py" "$build" "$results" "${quick[@]}"
  elif [ "$study" = statics ]; then
    "$here/study/statics.py" "$build" "$results" "${quick[@]}"
    "$here/study/plot_statics.py" "$results"
  elif [ "$study" = speed ]; then
    "$here/study/speed.py" "$build" "$results" "${quick[@]}"
    "$here/study/plot_speed.py" "$results"
  else
    "$build/gcpdda-study" "$study" "$results" "${quick[@]}"
    "$here/study/plot_$study.py" "$results"
  fi
  [ ${#quick[@]} -gt 0 ] || flock "$results/recorded.csv" "$here/study/pages.py" --record "$study"
  echo "== $study${quick:+, quick}: $((SECONDS - start)) s =="
}

# The verification takes as long as the others together, and the second core.
verification=
for study in "${studies[@]}"; do
  if [ "$study" = verify ] && [ ${#studies[@]} -gt 1 ]; then
    run_study verify >"$results/verify.log" 2>&1 &
    verification=$!
  else
    run_study "$study"
  fi
done
if [ -n "$verification" ]; then
  wait "$verification" || {
    cat "$results/verify.log"
    exit 1
  }
  tail -n 2 "$results/verify.log"
fi
