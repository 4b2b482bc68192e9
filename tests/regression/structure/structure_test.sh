#!/usr/bin/env bash
# One case of measured shapes and existing structures on a small cell: structure_test.sh CASE BIN WORK
set -euo pipefail
case=$1 bin=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }

mkdir -p "$work"
cp "$here"/*.toml "$here"/*.data "$work/"
has() { # FOLDER TEXT...: all in its electrode.json
  local text
  for text in "${@:2}"; do
    grep -qF -- "$text" "$work/$1/electrode.json" || fail "no '$text' in $1/electrode.json"
  done
}
case $case in
  image_to_electrode) # tomogram -> shapes -> electrode; the library alone gives the same electrode
    "$bin/calendem" tomogram "$work/tomogram.toml" -o "$work/image.mhd"
    "$bin/calendem" validate "$work/electrode.toml"
    rm -rf "$work/from_image" "$work/from_library"
    "$bin/calendem" pack "$work/electrode.toml" -o "$work/from_image" --ranks 1
    sed 's|^image = .*|library = "from_image/shapes"|' "$work/electrode.toml" >"$work/library.toml"
    "$bin/calendem" pack "$work/library.toml" -o "$work/from_library" --ranks 1
    cmp "$work/from_image/electrode.data" "$work/from_library/electrode.data" ||
      fail "image and library gave different electrodes"
    grep -q '"D50"' "$work/from_image/electrode.json" || fail "no measured sizes in electrode.json" ;;
  image_as_electrode) # the image's particles in their places -> pressed
    "$bin/calendem" tomogram "$work/tomogram.toml" -o "$work/image.mhd"
    rm -rf "$work/in_place" "$work/pressed"
    "$bin/calendem" validate "$work/in_place.toml"
    "$bin/calendem" pack "$work/in_place.toml" -o "$work/in_place" --ranks 1
    has in_place '"each_am_particle_once": true' '"cbd": "of the recipe, at random places in pores"'
    number() { grep -o "\"$2\": [0-9.e-]*" "$work/$1" | head -n 1 | cut -d ' ' -f 2; }
    # bodies keep a particle's volume to half a primary; 1 point is five of them in this cell of 576 um3
    awk -v image="$(number in_place/electrode.json am_fraction_image)" -v is="$(number in_place/electrode.json am_fraction)" \
      -v kept="$(number in_place/electrode.json am_in_place)" 'BEGIN {
        print "active material: image " image ", electrode " is "; in place: " kept
        exit !(is > image - 0.03 && is < image + 0.03 && kept > image + 0.1) }' || fail "not the image's particles in their places"
    "$bin/calendem" run "$work/pressed.toml" -o "$work/pressed" --ranks 1
    awk -v before="$(number in_place/electrode.json porosity_total)" \
      -v after="$(number pressed/summary.json porosity_after_relaxation)" 'BEGIN {
        print "porosity before " before ", after " after; exit !(after > 0.1 && after < before - 0.02) }' ||
      fail "pressing left it as porous as it was" ;;
  structure_to_electrode) # LAMMPS' film -> electrode; that as given clusters -> the same bodies; a cut file -> nothing
    rm -rf "$work/from_film" "$work/from_clusters" "$work/from_cut"
    "$bin/calendem" validate "$work/film.toml"
    "$bin/calendem" pack "$work/film.toml" -o "$work/from_film" --ranks 1
    has from_film '"bodies": 18,' '"am_particles_in": 18' '"am_particles_out": 18' '"cbd_in": 45' '"cbd_out": 45' \
      '"each_am_particle_once": true'
    [ "$(wc -l <"$work/from_film/structure.csv")" -eq 64 ] || fail "structure.csv has not a row for each of 63 particles"
    "$bin/calendem" pack "$work/clusters.toml" -o "$work/from_clusters" --ranks 1
    for key in bonds primaries cbd bodies loading_mg_cm2; do
      has from_clusters "$(grep -m 1 "^  \"$key\"" "$work/from_film/electrode.json")"
    done
    head -n 30 "$work/film.data" >"$work/cut.data"
    sed 's|film.data|cut.data|' "$work/film.toml" >"$work/cut.toml"
    status=0
    "$bin/calendem" pack "$work/cut.toml" -o "$work/from_cut" 2>"$work/said" || status=$?
    cat "$work/said"
    [ $status -eq 2 ] || fail "exit status $status for a file that is cut"
    grep -q 'announces 63 atoms, the section Atoms has 19 rows' "$work/said" || fail "the truncation was not reported"
    [ ! -e "$work/from_cut" ] || fail "a folder was made for nothing" ;;
esac
