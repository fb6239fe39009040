#!/usr/bin/env bash
# draw_in_paraview.sh GCPDDA SOURCE_DIR WORK_DIR: a short run with a bolt opens in ParaView and gives a picture with content.
set -euo pipefail
if [ $# -ne 3 ]; then
  sed -n '2s/^# //p' "${BASH_SOURCE[0]}"
  case ${1:-} in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi
gcpdda=$1 source=$2 work=$3
"$gcpdda" run "$source/run/scenes/goodman_bray.toml" --out "$work" --overwrite --set run.duration=0.2 \
  --set 'support.cable={kind="anchored",axial_stiffness=1e7,pretension=1e5}' \
  --set 'bolt=[{support="cable",from=[3.83,3.37],to=[4.83,1.63]}]'
rm -f "$work/picture.png"
xvfb-run -a pvbatch --force-offscreen-rendering "$source/run/paraview.py" "$work" "$work/picture.png" | tee "$work/said.txt"
grep -q '^1 lines of bolts$' "$work/said.txt"
# An empty view compresses to far less than a drawing of 33 blocks with a colour bar.
[ "$(stat -c %s "$work/picture.png")" -gt 10000 ]
