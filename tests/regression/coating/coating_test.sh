#!/usr/bin/env bash
# One case of the coating as it came from the dryer, on small cells: coating_test.sh CASE BIN WORK
set -euo pipefail
case=$1 bin=$2 work=$3
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
number() { sed -n "s/^ *\"$1\": \([-+0-9.e]*\),*$/\1/p" "$2"; } # of a summary
holds() { awk "BEGIN { exit !($1) }" || fail "$2"; }
recipe() { # FILE LOADING SIDE [LINE...]
  printf '%s\n' 'name = "coating"' "seed = 3" "[coating]" "loading_mg_cm2 = $2" "[cell]" "x_um = $3" "y_um = $3" "${@:4}" >"$1"
}

mkdir -p "$work"
case $case in
  gradient) # the film that LIGGGHTS densified: the content is the gradient's times that of the film without one
    for asked in 0 -0.8 0.8; do
      recipe "$work/gradient.toml" 5 10 "[effects.cbd_gradient]" "slope = $asked"
      "$bin/calendem" validate "$work/gradient.toml"
      rm -rf "$work/gradient_$asked"
      "$bin/calendem" pack "$work/gradient.toml" -o "$work/gradient_$asked" --ranks 1
    done
    height=$(number thickness_um "$work/gradient_0/electrode.json")
    for asked in -0.8 0.8; do
      slope=$(number slope "$work/gradient_$asked/electrode.json") scatter=$(number slope_scatter "$work/gradient_$asked/electrode.json")
      due=$(awk -v g="$asked" -v height="$height" 'rows && $2 == 2 { z = ($7 - $3 / 2) / (height - $3); w = 1 + g * (2 * z - 1); all += w; sum += w * z }
        /^Atoms/ { rows = 1 } END { print 3 * (2 * sum / all - 1) }' "$work/gradient_0/electrode.data")
      echo "slope $slope, due $due, scatter of a draw $scatter"
      holds "($slope - ($due))^2 <= 2 * (3 * $scatter)^2" "slope $slope instead of $due, both draws with scatter $scatter"
    done ;;
  uneven) # two cells under one plate: the sample bears the mean of what they bear at the same gap
    recipe "$work/uneven.toml" 4 6
    printf '%s\n' 'electrode = "any"' "[platen]" 'control = "thickness"' "thickness_um = 12.5" "speed_m_s = 2" \
      "touch_speed_m_s = 2" "release_speed_m_s = 2" >"$work/case.toml"
    printf '%s\n' "[study]" 'recipe = "uneven.toml"' 'case = "case.toml"' 'keep = "tables"' "[[vary]]" \
      'keys = ["recipe.coating.loading_mg_cm2"]' "normal = { mean = 4, sd = 0.2, cells = 2 }" >"$work/study.toml"
    rm -rf "$work/study" "$work/sample" "$work/alone"
    "$bin/calendem" study "$work/study.toml" -o "$work/study"
    mapfile -t runs < <(awk -F, -v at="$work/study/runs/" 'NR > 1 { print at $3 }' "$work/study/study.csv")
    "$bin/calendem" sample "${runs[@]}" --one gap -o "$work/sample"
    at_gap() { # RUN GAP: pressure there on the way down, linear between rows and the summary's maximum; 0 before the first
      awk -F, -v gap="$2" -v least="$(number thickness_at_max_um "$1/summary.json")" -v most="$(number max_pressure_MPa "$1/summary.json")" '
        function between(height, pressure) { printf "%.9g\n", last ? q + (pressure - q) * (last - gap) / (last - height) : 0; exit }
        NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
        $at["stage"] != "compression" { between(least, most) }
        $at["thickness_um"] <= gap { between($at["thickness_um"], $at["pressure_MPa"]) }
        { last = $at["thickness_um"]; q = $at["pressure_MPa"] }' "$1/curve.csv"
    }
    most=$(number thickness_at_max_um "$work/sample/summary.json")
    for gap in "$most" 13 13.5 14 15; do
      sample=$(at_gap "$work/sample" "$gap") mean="($(at_gap "${runs[0]}" "$gap") + $(at_gap "${runs[1]}" "$gap")) / 2"
      echo "at $gap um $sample MPa"
      holds "($sample - $mean)^2 < (1e-5 * $sample)^2 + 1e-12" "$sample MPa at $gap um is not the cells' mean $mean" # six digits
    done
    "$bin/calendem" sample "${runs[0]}" "${runs[0]}" --one gap -o "$work/alone" # alike: a cell is the sample
    for key in max_pressure_MPa thickness_after_relaxation_um porosity_initial; do
      holds "($(number $key "$work/alone/summary.json") / $(number $key "${runs[0]}/summary.json") - 1)^2 < 1e-6" "$key of a sample of one"
    done
    ! "$bin/calendem" sample "${runs[@]}" --one pressure -o "$work/none" 2>"$work/said" || fail "cells of other pressures were taken"
    grep -q "turn within" "$work/said" || { cat "$work/said"; fail "it is not said why"; } ;;
esac
