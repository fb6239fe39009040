#!/bin/sh
# Joint traces from a DXF drawing, as a map for [[joint_map]]: run/dxf_to_geojson.sh IN.dxf OUT.geojson [LAYER]
# Lines, polylines, arcs and splines (the curves as chords) of all layers or of one; units stay those of the
# drawing, which must be m. Needs ogr2ogr (Debian package gdal-bin); where that is installed, [[joint_map]] reads .dxf itself.
# A drawing without such lines ends with exit code 4, and OUT.geojson stays as it was.
set -eu
case ${1:-} in
  -h | --help)
    sed -n '2,5s/^# //p' "$0"
    exit 0
    ;;
esac
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
  sed -n '2,5s/^# //p' "$0" >&2
  exit 2
fi
if ! command -v ogr2ogr > /dev/null; then
  echo "error: ogr2ogr is missing, it reads the drawing, install the package gdal-bin" >&2
  exit 4
fi
where="OGR_GEOMETRY LIKE '%LINESTRING%'"
if [ $# -eq 3 ]; then
  where="$where AND Layer = '$(printf '%s' "$3" | sed "s/'/''/g")'"
fi
case $1 in -*) in=./$1 ;; *) in=$1 ;; esac
case $2 in -*) out=./$2 ;; *) out=$2 ;; esac
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 4' HUP INT TERM
# RFC7946=NO: coordinates are metres of the drawing, not degrees.
if ! ogr2ogr -f GeoJSON "$folder/lines.geojson" "$in" entities -dim XY -where "$where" -lco RFC7946=NO \
  -lco COORDINATE_PRECISION=12; then
  echo "$1: error: ogr2ogr cannot read it, see above, check that it is a DXF drawing" >&2
  exit 4
fi
if ! grep -q '"coordinates": *\[' "$folder/lines.geojson"; then
  echo "$1: error: no line in the ${3+layer $3 of the }drawing, a map without traces cuts nothing, check the name of the layer" \
    "(ogrinfo lists them: -sql 'SELECT DISTINCT Layer FROM entities')" >&2
  exit 4
fi
cp "$folder/lines.geojson" "$out"
