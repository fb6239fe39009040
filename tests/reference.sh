#!/usr/bin/env bash
# reference.sh FOLDER: builds the reference of the installed library by doxygen, into FOLDER/html. A function, type or
# enumeration of include/gcpdda without a description is an error, and so is every warning; fields may speak for themselves.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if [[ ${1:-} == --help || $# -ne 1 ]]; then
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
folder=$1
mkdir -p "$folder"

# run_doxygen SETTING...: prints what it warns of.
run_doxygen() {
  {
    printf '%s\n' "PROJECT_NAME = gcpdda" "INPUT = $top/include/gcpdda" "RECURSIVE = YES" "OUTPUT_DIRECTORY = $folder" \
      "GENERATE_LATEX = NO" "HAVE_DOT = NO" "QUIET = YES" "BUILTIN_STL_SUPPORT = YES" "JAVADOC_AUTOBRIEF = YES" \
      "STRIP_FROM_PATH = $top/include" "$@"
  } >"$folder/Doxyfile"
  doxygen "$folder/Doxyfile" 2>&1
}

undescribed=$(run_doxygen "GENERATE_HTML = NO" "GENERATE_XML = YES" "EXTRACT_ALL = NO" | grep -v '(variable) of' || true)
warnings=$(run_doxygen "GENERATE_HTML = YES" "EXTRACT_ALL = YES")
if [ -n "$undescribed$warnings" ]; then
  printf '%s\n' "$undescribed" "$warnings" >&2
  exit 1
fi
echo "the reference of $(find "$top/include/gcpdda" -name '*.hpp' | wc -l) headers is in $folder/html"
