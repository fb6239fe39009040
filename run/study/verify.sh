#!/usr/bin/env bash
# verify.sh BUILD RESULTS [--quick]: all verification problems; each check makes a row of RESULTS/verification.csv.
# Without --quick the long problems have their full size. Called by run/study.sh and CTest, which set the environment.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -lt 2 ]; then
  sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}"
  case ${1:-} in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi
build=$1 results=$2 quick=${3:-}
rows=$results/verification_rows.csv

mkdir -p "$results"
rm -f "$rows" "$results/goodman_bray.csv" "$results/safety_limits.csv"
export GCPDDA_VERIFICATION_TABLE=$rows
[ -n "$quick" ] || export GCPDDA_VERIFICATION_FULL=1
verdict=0
"$build/verification_tests" | tee "$results/verification.log" || verdict=$?
"$here/verify_table.py" "$results"
exit "$verdict"
