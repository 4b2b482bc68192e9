#!/usr/bin/env bash
# chain_test.sh CASE BIN WORK: shapes, slurry, drying, electrode, calendering by one command.
#   light: a thin film; steps are resumed, no particle is lost, a missed target is reported.
#   full:  the case of input_scripts/cases/chain, with CALENDEM_HEAVY=1.
set -euo pipefail
case=$1 bin=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
chain=$(cd "$here/../../../input_scripts/cases/chain" && pwd)/run.sh
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
figure() { sed -n "s/^ *\"$2\": \([-0-9.e]*\),\{0,1\}$/\1/p" "$1" | head -n 1; }
nothing_lost() { # every AM and CBD sphere of the slurry is in film and electrode, once
  local am cbd
  am=$(figure film/film.json am) cbd=$(figure film/film.json cbd)
  [ "$(($(wc -l <film/film.csv) - 1))" -eq $((am + cbd)) ] || fail "film.csv has not a row for each of $am + $cbd particles"
  [ "$(tail -n +2 film/film.csv | cut -d, -f1 | sort -u | wc -l)" -eq $((am + cbd)) ] || fail "an id is there twice"
  [ "$(figure electrode/electrode.json bodies)" = "$am" ] || fail "$am AM spheres became other than $am bodies"
  [ "$(figure electrode/electrode.json cbd)" = "$cbd" ] || fail "$cbd CBD spheres are not $cbd in the electrode"
  grep -q '"each_am_particle_once": true' electrode/electrode.json || fail "pack did not take each particle once"
}
meets_recipe() { # loading 1 %, electrode 0.5 point, film one CBD diameter of thickness
  awk -v a="$(figure film/film.json loading_mg_cm2)" -v b="$(figure film/film.json loading_recipe_mg_cm2)" \
    -v p="$(figure electrode/electrode.json porosity_total)" -v q="$(figure film/film.json porosity_recipe)" \
    -v h="$(figure film/film.json thickness_um)" -v k="$(figure film/film.json thickness_recipe_um)" 'BEGIN {
      if (!(a > 0.99 * b && a < 1.01 * b)) { print "loading", a, "for", b; exit 1 }
      if (!(p > q - 0.005 && p < q + 0.005)) { print "porosity", p, "for", q; exit 1 }
      if (!(h > k - 1.316 && h < k + 1.316)) { print "thickness", h, "for", k; exit 1 } }' || fail "the recipe is not met"
}

mkdir -p "$work"
case $case in
  light)
    rm -rf "$work/light"
    "$chain" -o "$work/light" --recipes "$here" --ranks 1 --bin "$bin" | tee "$work/light.said"
    cd "$work/light"
    nothing_lost
    meets_recipe
    [ -s report.html ] || fail "no report"
    # once more: nothing is made again; drying alone when only the film is gone
    rm film/film.json
    "$chain" -o "$work/light" --recipes "$here" --ranks 1 --bin "$bin" >"$work/again.said"
    for text in 'nmc.mhd is there already' 'their slurry is there already' 'electrode already holds this electrode' \
      'run already holds this run'; do
      grep -qF "$text" "$work/again.said" || fail "not resumed: no '$text'"
    done
    # left to the capillary pressure the film does not end at the recipe's thickness: reported, status 4
    { cat film.toml; printf '\n[drying]\ncapillary_pressure_MPa = 1e-3\nporosity_tolerance_points = 0.01\n'; } >hindered.toml
    cp -r film hindered
    status=0
    "$bin/calendem" dry hindered.toml -o hindered >hindered.said 2>&1 || status=$?
    cat hindered.said
    [ $status -eq 4 ] || fail "exit status $status for a film that misses its porosity"
    grep -q 'points, at most 0.01 are allowed' hindered.said || fail "the difference was not reported"
    { [ -e hindered/film.rejected.json ] && [ ! -e hindered/film.json ]; } || fail "a film that misses counts as made" ;;
  full)
    [ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: chain.full runs with tools/test --all"; exit 77; }
    "$chain" -o "$work/full" --bin "$bin"
    cd "$work/full"
    nothing_lost
    meets_recipe
    awk -v p="$(figure run/summary.json max_pressure_MPa)" 'BEGIN { exit !(p > 49 && p < 51) }' ||
      fail "the film was not pressed to 50 MPa" ;;
  *) echo "usage: chain_test.sh light|full BIN WORK" >&2; exit 1 ;;
esac
