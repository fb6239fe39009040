#!/usr/bin/env bash
# A long run under SLURM that stops before its time is over, requeues itself and goes on from its checkpoint:
#   sbatch --nodes=2 --ntasks-per-node=64 --time=24:00:00 run/cluster/job.sh SCENE.toml DIR [--set path=value ...]
# The --set arguments are those of the first start. GCPDDA names the program, GCPDDA_LAUNCH what starts it on all
# ranks ("srun --mpi=pmix" if not given).
#SBATCH --job-name=gcpdda
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x_%j.log
set -u

if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  sed -n '2,/^#SBATCH/s/^# //p' "${BASH_SOURCE[0]}"
  exit 0
fi
if [ $# -lt 2 ]; then
  echo "usage: sbatch job.sh SCENE.toml DIR [--set path=value ...]" >&2
  exit 2
fi
# A path that begins with a dash is no option.
case $1 in -*) scene=./$1 ;; *) scene=$1 ;; esac
case $2 in -*) out=./$2 ;; *) out=$2 ;; esac
shift 2
gcpdda=${GCPDDA:-gcpdda}
read -r -a launch <<<"${GCPDDA_LAUNCH:-srun --mpi=pmix}"

has_checkpoint() {
  local file
  for file in "$out"/checkpoints/checkpoint_*.h5; do # the pattern itself where no file matches
    [ -e "$file" ] && return 0
  done
  return 1
}
if has_checkpoint; then
  command=(restart "$out")
elif [ "${SLURM_RESTART_COUNT:-0}" -gt 0 ]; then
  command=(run "$scene" --out "$out" --overwrite "$@") # ended before its first checkpoint
else
  command=(run "$scene" --out "$out" "$@")
fi

asked_to_stop=no
# shellcheck disable=SC2317 # called by the trap
pass_on() {
  asked_to_stop=yes
  kill -USR1 "$child" 2>/dev/null
}
trap pass_on USR1
"${launch[@]}" "$gcpdda" "${command[@]}" &
child=$!
wait "$child"
code=$?
while kill -0 "$child" 2>/dev/null; do # a signal ends `wait`, not the run
  wait "$child"
  code=$?
done

# 6: stopped with a checkpoint. Where SLURM asked for it, time is over and the job goes to the queue again; where a
# person did (scancel --signal=USR1 JOB, which goes past this script), it is left.
if [ "$code" -eq 6 ] && [ "$asked_to_stop" = yes ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$code"
