#!/usr/bin/env bash
# run.sh BUILD FOLDER: installs BUILD into FOLDER, builds the consumer against it and runs it on 1 and 2 ranks.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ ${1:-} == --help || $# -ne 2 ]]; then
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
build=$1
folder=$2
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/installed" >/dev/null
cmake -S "$here" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$folder/build" >/dev/null
answers=()
for ranks in 1 2; do
  mkdir -p "$folder/mpi_$ranks" # a scratch folder of Open MPI each
  answers+=("$(OMPI_MCA_orte_tmpdir_base="$folder/mpi_$ranks" mpirun -n "$ranks" --oversubscribe --bind-to none "$folder/build/consumer")")
done
printf '%s\n' "${answers[@]}"
[[ ${answers[0]} == "${answers[1]}" ]]
# g (sin 30 - tan 15 cos 30)/2 = 1.3143 m after 1 s. The block lies on the plane without a force and sinks in, sliding
# freely for a moment: early by 6e-4 m, which falls with the root of the stiffness.
[[ ${answers[0]} =~ "moved by "1\.31[34][0-9]" m in 1.0000 s" ]]
