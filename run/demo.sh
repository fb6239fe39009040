#!/usr/bin/env bash
# demo.sh: the toppling slope of Goodman and Bray on two MPI ranks, at a friction angle where it stands and at one where it
# topples: results, pictures, and a sentence on each.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/set_up.sh"

if [ $# -gt 0 ]; then
  show_help
  case $1 in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi
install_packages ""
build_targets gcpdda

scene=$top/run/scenes/goodman_bray.toml
results=$top/run/results
stands=40
topples=36
for angle in $stands $topples; do
  echo
  echo "== friction angle $angle degrees =="
  mpirun -n 2 --oversubscribe --bind-to none "$build/gcpdda" run "$scene" --out "$results/goodman_bray_$angle" \
    --overwrite --set "joint.default.friction_angle_deg=$angle"
  /usr/bin/python3 "$top/run/plot.py" "$results/goodman_bray_$angle" --frame 0,last --field displacement \
    --title "Friction angle $angle degrees" --out "$results/goodman_bray_$angle.png"
done

echo
/usr/bin/python3 "$top/run/demo_report.py" "$results/goodman_bray_$stands" "$results/goodman_bray_$topples"
cat <<END

Pictures (before and after):   $results/goodman_bray_$stands.png
                               $results/goodman_bray_$topples.png
Histories of two columns:      $results/goodman_bray_*/history/*.csv
Frames (HDF5):                 $results/goodman_bray_*/frames/
In ParaView: File > Open > $results/goodman_bray_$topples/run.hdf.series, then Apply and colour by displacement.
An animation:                  run/plot.py $results/goodman_bray_$topples --frame all --out topple.gif
Another strength: copy $scene, change friction_angle_deg, and run
  mpirun -n 2 $build/gcpdda run YOUR_SCENE.toml
END
