# shellcheck shell=bash
# Sourced by the scripts of run/ and tests/: install what is missing, configure, build.

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Containers forbid the kernel calls behind Open MPI's single-copy messages; more ranks than cores must not spin.
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1 OMP_NUM_THREADS=1

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=release # of CMakePresets.json
build=$top/build

# show_help: the comment that the calling script begins with.
show_help() {
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "${BASH_SOURCE[1]}"
}

# missing_packages [tests]: packages of run/packages.txt that are not installed. Those that only the tests need have
# the word tests behind them.
missing_packages() {
  local package purpose
  while read -r package purpose; do
    if [ -z "$package" ] || [[ -n "$purpose" && "$purpose" != "${1:-}" ]]; then
      continue
    fi
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed$' || echo "$package"
  done <"$top/run/packages.txt"
}

# install_packages [tests]
install_packages() {
  local missing=() as_root=()
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "these packages are missing and need root or sudo to install: ${missing[*]}" >&2
      return 1
    }
    as_root=(sudo)
  fi
  echo "installing: ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    >/dev/null
}

# build_targets TARGET...: of $preset into $build; only what changed is built again.
build_targets() {
  [ -f "$build/build.ninja" ] || cmake -S "$top" -B "$build" --preset "$preset"
  cmake --build "$build" --target "$@"
}
