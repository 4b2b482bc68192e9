#!/usr/bin/env bash
# cases.sh CASE BIN WORK: one fault through the real programs. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
case=$1 bin=$2 shared=$3
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../../input_scripts" && pwd)
electrode=$shared/electrode work=$shared/$case
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_rmaps_base_oversubscribe=1

fail() { echo "FAILED: $*"; exit 1; }
skip() { echo "skipped: $*"; exit 77; }
calendem() { "$bin/calendem" "$@"; }
# STATUS COMMAND...: the exit status; what the command said is in $work/said
expect() {
  local want=$1 status=0
  shift
  "$@" >"$work/said" 2>&1 </dev/null || status=$?
  cat "$work/said"
  [ $status -eq "$want" ] || fail "exit status $status, expected $want: $*"
}
says() { # TEXT...: all in what was said
  local text
  for text in "$@"; do grep -qF -- "$text" "$work/said" || fail "no '$text' in the message"; done
}
file() { cat >"$work/$1"; } # NAME <text
refused() { # FILE TEXT...: validate refuses the file, with these words
  expect 2 calendem validate "$work/$1"
  shift
  says "$@"
}
a_case() { # LINES: a case that is quick: soft start, low pressure
  printf '%s\n' "electrode = \"$1\"" "${@:2}" >"$work/case.toml"
}
quick=('[platen]' max_pressure_MPa=5 speed_m_s=4 touch_speed_m_s=4 release_speed_m_s=4 '[output]'
  restart_every_us=0.05 vtk_every_us=0.5)
run() { calendem run "$work/case.toml" -o "$work/run" --ranks 1 "$@"; }
copy_of_electrode() { # a copy to be spoilt
  rm -rf "$work/electrode"
  cp -r "$electrode" "$work/electrode"
  a_case "$work/electrode"
}
until_file() { # FILE PID: waits for the file, written by PID, and some rows of the curve
  for _ in $(seq 600); do
    [ ! -s "$1" ] || [ "$(wc -l <"$work/run/curve_raw.csv")" -lt 4 ] || return 0
    kill -0 "$2" 2>/dev/null || fail "the run ended before it wrote $1: $(cat "$work/run.log")"
    sleep 0.05
  done
  fail "no $1"
}
ranks_of_run() { pgrep -f "^[^ ]*/liggghts .*-var out $work/run " || true; }
nothing_runs_below() { # FOLDER
  ! pgrep -af "^[^ ]*/(liggghts|calendem) .*$1/" || fail "that goes on, nobody waits for it"
}
begin() { # OPTION...: a run in the background; its id is in $running
  "$bin/calendem" run "$work/case.toml" -o "$work/run" "$@" >"$work/run.log" 2>&1 </dev/null &
  running=$!
}
at_terminal() { # COMMAND...: begins it on a terminal of its own (bash ignores SIGINT in what it begins by &)
  mkfifo "$work/keys"
  SHELL=/bin/bash command script -qec "exec env --default-signal=INT $(printf '%q ' "$@")" "$work/run.log" <"$work/keys" >/dev/null 2>&1 &
  running=$!
  exec 3>"$work/keys"
  trap '' PIPE
}
ctrl_c() { printf '\003' >&3; }
ended_with() { # STATUS: of the run in the background; its messages count as said
  local status=0
  wait "$running" || status=$?
  cp "$work/run.log" "$work/said"
  cat "$work/said"
  [ $status -eq "$1" ] || fail "exit status $status, expected $1"
}
is_kept() { # what a run that was stopped had computed
  [ -s "$work/run/curve.csv" ] || fail "no curve.csv"
  grep -q '"finished": false' "$work/run/summary.json" || fail "summary.json is not marked"
  grep -q '"stopped_because"' "$work/run/summary.json" || fail "summary.json does not say why"
}
script() { # WORDS...: in.calendering itself, with these words on its command line
  "$bin/liggghts" -in "$scripts/in.calendering" -log none -var scripts "$scripts" \
    -var electrode "${script_electrode:-$electrode}" -var out "$work" "$@"
}
full_disk() { # MB: a file system of that size at $work/disk
  mkdir -p "$work/disk"
  # A mount of its own, seen by this process and its children only.
  if [ -z "${CALENDEM_TEST_DISK:-}" ]; then
    unshare -m true 2>/dev/null || skip "making a small disk needs the right to mount"
    CALENDEM_TEST_DISK=1 exec unshare -m bash "${BASH_SOURCE[0]}" "$case" "$bin" "$shared"
  fi
  mount -t tmpfs -o "size=$1m" none "$work/disk"
}

# ---- files
file_missing() {
  expect 2 calendem run "$work/no.toml" -o "$work/run"
  says "$work/no.toml: no such file" "Give the path"
  expect 2 calendem pack "$work/no.toml" -o "$work/run"
  [ ! -e "$work/run" ] || fail "a folder was made for nothing"
}
file_is_folder() {
  expect 2 calendem pack "$work" -o "$work/run"
  says "is a folder"
}
file_empty() {
  printf '\n \n' | file empty.toml
  expect 2 calendem run "$work/empty.toml" -o "$work/run"
  says "the file is empty"
  refused empty.toml "the file is empty"
}
toml_broken() { # two broken lines, and a mistake in a good one: all at once
  printf '%s\n' '[coating]' 'loading_mg_cm2 = = 3' 'porosity_total_percent = 999' '[cell]' 'x_um = 15 15' |
    file broken.toml
  refused broken.toml "broken.toml:2: not valid TOML" "loading_mg_cm2 = = 3" \
    "broken.toml:3: coating.porosity_total_percent is 999" "broken.toml:5: not valid TOML"
}
key_unknown() {
  printf '%s\n' '[platen]' 'max_presure_MPa = 100' '[bond]' 'sigma_c_MPa = 200' | file case.toml
  refused case.toml "case.toml:2: unknown key 'platen.max_presure_MPa'. Did you mean 'platen.max_pressure_MPa'" \
    "case.toml:4: unknown key 'bond.sigma_c_MPa'. Did you mean 'bond.tensile_strength_MPa'" \
    "key 'electrode' is missing"
}
table_unknown() { # its keys are checked all the same
  printf '%s\n' 'electrode = "e"' '[platten]' 'max_pressure_MPa = -1' '[weather]' 'rain = 1' | file case.toml
  refused case.toml "case.toml:2: unknown table [platten]. Did you mean [platen]?" \
    "case.toml:3: platen.max_pressure_MPa is -1" "case.toml:4: unknown table [weather]; known are"
}
type_wrong() {
  printf '%s\n' 'electrode = 3' '[platen]' 'max_pressure_MPa = "150"' 'control = true' \
    'speed_m_s = { value = 1 }' '[bond]' 'seed = [1, 2]' | file case.toml
  refused case.toml 'case.toml:1: electrode must be a text in quotes' 'not 3' \
    ':3: platen.max_pressure_MPa must be a number without quotes' 'not "150"' \
    ':4: platen.control must be a text' 'not true' ':5: platen.speed_m_s must be a number' 'not a table' \
    ':7: bond.seed must be a number' 'not a list'
}
number_negative() {
  printf '%s\n' 'electrode = "e"' '[bond]' 'tensile_strength_MPa = -200' | file case.toml
  refused case.toml "case.toml:3: bond.tensile_strength_MPa is -200; allowed is 0.1 to 100000 MPa"
}
number_not_finite() {
  printf '%s\n' '[coating]' 'loading_mg_cm2 = nan' '[cell]' 'x_um = inf' 'y_um = -inf' | file recipe.toml
  refused recipe.toml "recipe.toml:2: coating.loading_mg_cm2 is nan; it must be a finite number" \
    ":4: cell.x_um is inf" ":5: cell.y_um is -inf"
}
number_not_whole() {
  printf '%s\n' 'seed = 1.5' | file recipe.toml
  refused recipe.toml "recipe.toml:1: seed is 1.5; it must be a whole number"
}
modulus_in_pa() {
  printf '%s\n' 'electrode = "e"' '[material.am]' 'youngs_modulus_GPa = 200e9' | file case.toml
  refused case.toml ":3: material.am.youngs_modulus_GPa is 2e+11" "looks like a value in Pa" "200 GPa"
}
loading_in_g_m2() {
  printf '%s\n' '[coating]' 'loading_mg_cm2 = 174.6' | file recipe.toml
  refused recipe.toml ":2: coating.loading_mg_cm2 is 174.6" "looks like a value in g/m2" "17.46 mg/cm2"
}
pressure_in_pa() {
  printf '%s\n' 'electrode = "e"' '[platen]' 'max_pressure_MPa = 150e6' | file case.toml
  refused case.toml ":3: platen.max_pressure_MPa is 150000000" "looks like a value in Pa" "150 MPa"
}
fraction_for_percent() {
  printf '%s\n' '[coating]' 'porosity_total_percent = 0.48' '[composition]' 'am_weight_percent = 0.96' \
    '[cbd]' 'nanoporosity_percent = 0.5' | file recipe.toml
  refused recipe.toml ":2: coating.porosity_total_percent is 0.48" "looks like a value in a fraction" "48 %" \
    ":4: composition.am_weight_percent is 0.96" ":6: cbd.nanoporosity_percent is 0.5"
}
weights_not_100() {
  printf '%s\n' '[composition]' 'am_weight_percent = 90' | file recipe.toml
  refused recipe.toml "recipe.toml:2: [composition] adds up to 94 %" "must be 100 %"
  printf '%s\n' '[composition]' 'am_weight_percent = 96' 'carbon_weight_percent = 0.02' \
    'binder_weight_percent = 0.02' | file recipe.toml
  refused recipe.toml "adds up to 96.04 %" "look like fractions"
}
cell_below_two_cut_offs() {
  printf '%s\n' '[cell]' 'x_um = 3' | file recipe.toml
  expect 2 calendem pack "$work/recipe.toml" -o "$work/run"
  says "recipe.toml:2: cell.x_um is 3; allowed is 5 to 1000 um"
  printf '%s\n' '[cell]' 'x_um = 6' '[particles]' 'primary_diameter_um = 4' 'lattice_um = 3.2' | file recipe.toml
  refused recipe.toml "recipe.toml:2: a periodic side of 6 um is shorter than two cut-offs (9.30 um)"
}
yield_below_cohesion() {
  printf '%s\n' 'electrode = "e"' '[effects.nmc_plasticity]' 'yield_pressure_GPa = 1' | file case.toml
  refused case.toml "case.toml:3: effects.nmc_plasticity.yield_pressure_GPa is 1 GPa" \
    "cannot carry their own cohesion" "at least 1.5 GPa"
}
pores_open() {
  printf '%s\n' 'electrode = "e"' '[effects.cbd_collapse]' 'initial_nanoporosity = 0.4' 'floor_nanoporosity = 0.45' |
    file case.toml
  refused case.toml "case.toml:4: effects.cbd_collapse.floor_nanoporosity is 0.45" "pores would open"
}
imposed_and_by_law() {
  printf '%s\n' 'electrode = "e"' '[effects.cbd_collapse]' 'yield_pressure_MPa = 20' '[imposed]' \
    'cbd_nanoporosity_until_MPa = 150' | file case.toml
  refused case.toml "case.toml:5: imposed.cbd_nanoporosity_until_MPa is 150" "Set one of them to 0"
}
relaxes_into_cohesion() {
  printf '%s\n' 'electrode = "e"' '[effects.cbd_viscoelasticity]' 'relaxed_fraction = 0.9' | file case.toml
  refused case.toml "case.toml:3: effects.cbd_viscoelasticity.relaxed_fraction is 0.9" "am and cbd spheres" \
    "more than 0.3 of their radius" "0 (off) or at most 0."
}
averaged_over_too_much() {
  printf '%s\n' 'electrode = "e"' '[platen]' 'release_speed_m_s = 8' '[numerics]' 'average_us = 0.25' | file case.toml
  refused case.toml "case.toml:5: numerics.average_us is 0.25: in that time the platen moves 2 um at" \
    "platen.release_speed_m_s = 8 m/s, at most 0.1 um is allowed" "Give at most 0.0125 us, or 0"
}
cohesion_collapses() {
  printf '%s\n' 'electrode = "e"' '[material.cbd]' 'ced_J_m3 = 7e8' | file case.toml
  refused case.toml "case.toml:3: cohesion would collapse the packing: it pulls cbd spheres" \
    "by 3.14 of their radius, at most 0.1 is allowed" "(CED/E)^2" "700000000"
}
every_mistake_at_once() { # of two files, each line with a mistake is named
  printf '%s\n' 'name = 3' '[coating]' 'loading_mg_cm2 = -1' 'porosity = 40' '[composition]' \
    'am_weight_percent = 90' '[cell]' 'x_um = "15"' 'y_um = 2' | file recipe.toml
  printf '%s\n' '[platen]' 'control = "presure"' 'dwell_us = nan' '[material.cbd]' 'ced_J_m3 = 7e8' | file case.toml
  expect 2 calendem validate "$work/recipe.toml" "$work/case.toml"
  says recipe.toml:1: recipe.toml:3: recipe.toml:4: recipe.toml:6: recipe.toml:8: recipe.toml:9: \
    case.toml:2: 'The closest is "pressure"' case.toml:3: case.toml:5: "key 'electrode' is missing"
}
film_mistakes() { # of a slurry: a fraction, spheres that jam, an unknown end, another table
  printf '%s\n' '[slurry]' 'solid_content_percent = 0.69' 'sphere_fraction = 0.7' '[drying]' 'stop = "dry"' | file film.toml
  refused film.toml film.toml:2: film.toml:3: film.toml:5: 'thickness'
  printf '%s\n' '[slurry]' 'sphere_fraction = 0.3' | file film.toml
  refused film.toml 'dry spheres fill 0.376' 'Give a value between'
  printf '%s\n' '[slurry]' 'solid_content_percent = 69' '[drying]' 'stop = "pressure"' '[structure]' 'file = "x"' | file film.toml
  refused film.toml film.toml:5: structure
}
film_cell_too_small() { # spheres would touch two images of another; no folder is made for nothing
  printf '%s\n' '[cell]' 'x_um = 10' 'y_um = 10' '[slurry]' 'solid_content_percent = 69' | file film.toml
  expect 2 calendem dry "$work/film.toml" -o "$work/film"
  says 'the largest sphere of the slurry is' 'at most 4.70 um' 'particles.max_um'
  [ ! -e "$work/film" ] || fail "a folder was made"
}
of_other_kind() { # "VERB" FILE TEXT...: the verb refuses the case's file in one line
  local verb=$1 given=$2
  shift 2
  # shellcheck disable=SC2086 # a verb may be two words
  expect 2 calendem $verb "$scripts/cases/$given" -o "$work/run"
  says "$@"
  [ "$(wc -l <"$work/said")" -eq 1 ] || fail "more than one line"
}
kind_wrong() {
  of_other_kind run demo/electrode.toml "this is an electrode's recipe (it has 'cell', 'coating')" \
    "a case is expected here. Give this file to calendem pack"
  of_other_kind pack demo/case.toml "this is a case" "Give this file to calendem run"
  of_other_kind dry demo/case.toml "this is a case" "the recipe of a film is expected here"
  of_other_kind pack chain/film.toml "this is the recipe of a film" "Give this file to calendem dry"
  of_other_kind tomogram demo/electrode.toml "the description of a tomogram is expected here"
  of_other_kind study bank/bank.toml "this is a bank" "a study is expected here"
  of_other_kind bank studies/cells.toml "this is a study" "Give this file to calendem study"
  of_other_kind diagnose demo/case.toml "this is a case" "an experiment is expected here"
  of_other_kind "withheld make" paper/experiment.toml "this is an experiment" "compare, diagnose or calibrate"
  local status=0 # of a message that cannot be written
  calendem validate "$work/none.toml" 2>/dev/full || status=$?
  [ $status -eq 2 ] || fail "exit status $status, expected 2, with a full disk for the message"
}
kinds_of_file() {
  expect 0 calendem validate "$scripts"/cases/{demo,paper,real/*}/*.toml "$scripts"/cases/image/tomogram.toml
  says "demo/electrode.toml: a valid recipe" "demo/case.toml: a valid case" \
    "paper/experiment.toml: a valid experiment of 2 conditions" "image/tomogram.toml: a valid tomogram"
}
experiment_mistakes() {
  cp "$scripts/cases/paper/electrode.toml" "$work/"
  echo "displacement,pressure_MPa" >"$work/curve.csv"
  file experiment.toml <<'END'
[experiment]
name = "x"
electrode = "electrod.toml"
split = { train = ["a"], test = ["b", "a"] }
sampel_diameter_mm = 11
[[condition]]
id = "a"
control = "presure"
max_pressure_MPa = { value = 150e6, sd = 1 }
porosity_after_percent = { value = 0.25, sd_relative = 5 }
thickness_after_um = { value = 75, sd = 1, sd_relative = 0.1, includes_foil = 1 }
[[condition]]
id = "a"
control = "thickness"
mass_mg = 22.3
curve = "curve.csv"
labels_after = "after.mhd"
cracked_bodies_fraction = 30
dwell_s = -1
[[crushed_particle]]
diameter_um = -5
load_mN = { value = 5.2, sd = 1, n = 80 }
[[crushed_particle]]
diameter_um = 5
END
  refused experiment.toml ":3: electrode = \"electrod.toml\": there is no file" \
    ":4: split.test names \"b\", which is no [[condition]]" ":4: \"a\" is in both train and test" \
    ":5: unknown key 'experiment.sampel_diameter_mm'. Did you mean 'sample_diameter_mm'" \
    ":8: control is \"presure\"" ":9: max_pressure_MPa is 150000000" "looks like a value in Pa" \
    ":10: porosity_after_percent is 0.25" ":10: porosity_after_percent.sd_relative is 5" \
    ":11: thickness_after_um has both 'sd' and 'sd_relative'" ":11: thickness_after_um.includes_foil must be" \
    "the id \"a\" is taken" "control = \"thickness\" but no thickness_at_max_um" \
    "[experiment] must have sample_diameter_mm, foil_thickness_um, foil_density_g_cm3" \
    "has no column 'displacement_um'" ":17: labels_after = \"after.mhd\": there is no file" \
    ":18: cracked_bodies_fraction is 30" ":19: dwell_s is -1" ":21: diameter_um is -5" "unknown key 'load_mN.n'" \
    ":23: a crushed particle has no load_mN"
}

curve_in_other_units() { # of an experiment: mm, Pa, another separator, stages that are wrong
  cp "$scripts/cases/paper/electrode.toml" "$work/"
  printf '%s\n' '[experiment]' 'name = "x"' 'electrode = "electrode.toml"' '[[condition]]' 'id = "a"' \
    'control = "pressure"' 'max_pressure_MPa = 150' 'curve = "curve.csv"' 'curve_sd_um = 0.1' | file experiment.toml
  curve() { printf '%b' "$1" >"$work/curve.csv"; }
  curve 'displacement_um,pressure_MPa\n0,0\n0.02,150\n'
  refused experiment.toml ":8: '" "displacement_um goes to 0.02; the film of the recipe is 76.6 um thick"
  curve 'displacement_um,pressure_MPa\n0,0\n20000,150\n'
  refused experiment.toml ":8: '" "displacement_um goes to 20000; the film of the recipe is 76.6 um thick, allowed is 0.383 to 766.2"
  curve 'displacement_um,pressure_MPa\n0,0\n100,150\n' # a press that gives way
  expect 0 calendem validate "$work/experiment.toml"
  curve 'displacement_um,pressure_MPa\n0,0\n20,1.5e8\n'
  refused experiment.toml ":8: '" "pressure_MPa goes to 1.5e+08, max_pressure_MPa is 150"
  sed -i -e 's/"pressure"/"displacement"/' -e '/^max_pressure/d' "$work/experiment.toml"
  local pressures
  for pressures in '0\n20,40000' '0\n20,0' '0\n20,-40'; do
    curve "displacement_um,pressure_MPa\n0,$pressures\n"
    refused experiment.toml ":7: '" "0.1 to 2000 MPa are those of a press"
  done
  sed -i -e 's/"displacement"/"pressure"/' -e '/^curve =/i max_pressure_MPa = 150' "$work/experiment.toml"
  curve 'displacement_um;pressure_MPa\n0;0\n20,1;150\n'
  refused experiment.toml "Columns are separated by commas, decimals by points"
  curve 'displacement_um,pressure_MPa,stage\n20,150,unloading\n19,10,unloading\n0,0,loading\n20,150,loading\n'
  refused experiment.toml "its first row has the stage unloading. Rows go in the order of time"
  curve 'displacement_um,pressure_MPa,stage\n0,0,up\n20,150,up\n'
  refused experiment.toml "stage of row 1 is 'up'; allowed are loading"
  curve 'displacement_um,pressure_MPa,stage\n0,0.3,loading\n0,0.1,unloading\n20,150,unloading\n'
  refused experiment.toml "rows of the stage loading reach 0.3 MPa, the curve 150"
  curve 'displacement_um,pressure_MPa,pressure_MPa\n0,0,0\n20,150,90\n'
  refused experiment.toml "has two columns 'pressure_MPa'" "Rename or remove one"
  curve '\xef\xbb\xbfdisplacement_um,pressure_MPa\n0,0\n20,150\n' # as spreadsheets write it
  expect 0 calendem validate "$work/experiment.toml"
}
specimen_impossible() { # values that are allowed one by one, of a film that cannot be
  cp "$scripts/cases/paper/electrode.toml" "$work/"
  specimen() { # LINES of the condition
    printf '%s\n' '[experiment]' 'name = "x"' 'electrode = "electrode.toml"' 'sample_diameter_mm = 11' \
      'foil_thickness_um = 15' 'foil_density_g_cm3 = 2.7' '[[condition]]' 'id = "a"' 'control = "pressure"' \
      'max_pressure_MPa = 150' "$@" | file experiment.toml
  }
  local value
  for value in 0 -3 nan inf; do
    specimen "mass_mg = $value" "loading_mg_cm2 = $value" "thickness_after_um = $value" "thickness_at_max_um = $value"
    refused experiment.toml ":11: mass_mg is $value" ":12: loading_mg_cm2 is $value" \
      ":13: thickness_after_um is $value" ":14: thickness_at_max_um is $value"
  done
  specimen 'mass_mg = 3'
  refused experiment.toml "mass_mg = 3 is less than that of the foil"
  specimen 'mass_mg = 4'
  refused experiment.toml "mass_mg = 4 is a loading of 0.159 mg/cm2; allowed is 0.5 to 100" "sample_diameter_mm"
  specimen 'mass_mg = 22300' # in ug
  refused experiment.toml "mass_mg = 22300 is a loading of 2.35e+04 mg/cm2; allowed is 0.5 to 100"
  specimen 'thickness_at_max_um = 10' 'thickness_after_um = { value = 25, includes_foil = true }'
  refused experiment.toml "thickness_at_max_um is 10 um of coating, its solid alone fills 39.86" \
    "thickness_after_um is 10 um of coating" "Correct the thickness, the loading"
  specimen 'thickness_after_um = 700'
  refused experiment.toml "thickness_after_um is 700 um of coating, of which the solid fills 39.86: 94.3 % would be pores" \
    "at most 90 %"
  specimen 'mass_mg = 20.44' 'thickness_after_um = { value = 52, sd = 1 }' 'thickness_at_max_um = 50'
  expect 0 calendem validate "$work/experiment.toml"
}
slices_missing() { # of an image that an experiment gives by a pattern
  printf '%s\n' '[coating]' 'loading_mg_cm2 = 4' | file recipe.toml
  printf '%s\n' '[experiment]' 'name = "x"' 'electrode = "recipe.toml"' '[[condition]]' 'id = "a"' \
    'control = "pressure"' 'max_pressure_MPa = 100' 'labels_after = "s_%03d.tif"' | file experiment.toml
  refused experiment.toml ":8: labels_after" "s_%03d.tif: no file has such a name" "s_000.tif or s_001.tif"
  touch "$work"/s_00{2,4}.tif
  refused experiment.toml ":8: labels_after" "s_%03d.tif: slice 3 is missing (s_003.tif); there are 2 to 4"
  expect 2 calendem measure "$work/s_%03d.tif" -o "$work/out"
  says "slice 3 is missing (s_003.tif)"
  [ ! -e "$work/out" ] || fail "a folder was made for nothing"
}
image_on_full_disk() { # a limit on the length of a file stands for the disk
  printf '%s\n' '[image]' x_um=6 y_um=6 z_um=6 '[particles]' median_um=2.5 min_um=2 max_um=3 | file tomogram.toml
  local ending
  for ending in mha mhd vti; do
    expect 2 bash -c 'trap "" XFSZ; ulimit -f 2; "$@"' - "$bin/calendem" tomogram "$work/tomogram.toml" -o "$work/a.$ending"
    says "$work/a.$ending: cannot be written"
    [ "$(ls "$work")" = $'said\ntomogram.toml' ] || fail "part of an image is left: $(ls "$work")"
    echo "kept" >"$work/a.$ending"
    expect 2 bash -c 'trap "" XFSZ; ulimit -f 2; "$@"' - "$bin/calendem" tomogram "$work/tomogram.toml" -o "$work/a.$ending"
    [ "$(cat "$work/a.$ending")" = kept ] || fail "what was there is lost"
    expect 0 calendem tomogram "$work/tomogram.toml" -o "$work/a.$ending"
    expect 0 calendem measure "$work/a.$ending" -o "$work/out" --without-tortuosity
    rm -r "$work"/a.* "$work/out"
  done
}

# ---- command line and machine
ranks_not_a_number() {
  touch "$work/case.toml"
  local n
  for n in 0 -1 two 1.5 100000 ""; do
    expect 1 calendem run "$work/case.toml" -o "$work/run" --ranks "$n"
    says "--ranks"
  done
  expect 1 calendem run "$work/case.toml"
  says "--output is required"
  expect 1 calendem pak
  says "there is no verb 'pak'. Did you mean 'pack'?" "calendem --help"
  expect 1 calendem
  says "Usage:" "Many runs" "diagnose"
}
too_many_ranks() {
  a_case "$electrode"
  expect 2 calendem run "$work/case.toml" -o "$work/run" --ranks 4000
  says "--ranks 4000: a cell of 6 x 6 um can be shared by at most 9 ranks"
}
keys_that_do_not_act() {
  printf '%s\n' 'electrode = "e"' '[platen]' 'thickness_um = 14' | file case.toml
  refused case.toml "platen.thickness_um is 14 but platen.control is \"pressure\"" "Give control = \"thickness\""
  printf '%s\n' 'electrode = "e"' '[bond]' 'weibull_modulus = 0.5' '[numerics]' 'timestep_us = 1e-9' | file case.toml
  refused case.toml "bond.weibull_modulus is 0.5; give 0 or at least 1" "numerics.timestep_us is 1e-09; give 0 or at least 1e-06"
  printf '%s\n' '[cell]' 'x_um = 1000' 'y_um = 1000' | file recipe.toml
  expect 2 calendem pack "$work/recipe.toml" -o "$work/out"
  says "spheres" "Make the cell smaller"
}
curve_out_of_order() {
  printf '%s\n' '[coating]' 'loading_mg_cm2 = 4' | file recipe.toml
  experiment() { # LINES of the condition
    printf '%s\n' '[experiment]' 'name = "x"' 'electrode = "recipe.toml"' '[[condition]]' 'id = "a"' \
      'control = "pressure"' 'max_pressure_MPa = 100' "$@" | file experiment.toml
  }
  experiment 'curve = "newest_first.csv"'
  { echo displacement_um,pressure_MPa; for k in $(seq 100 -1 0); do echo "$(awk "BEGIN{print 0.04*$k}"),$k"; done; } | file newest_first.csv
  refused experiment.toml "begins at 100 MPa, its highest pressure is 100" "in the order of time"
  experiment 'porosity_after_percent = { value = 70, sd = 1 }'
  refused experiment.toml "porosity_after_percent is 70, the film has 47.97 before"
  experiment 'cracked_bodies_fraction = 0'
  refused experiment.toml "cracked_bodies_fraction is 0 without an sd"
}
confirming_fails() { # what the emulators say is there
  printf '%s\n' '[coating]' 'porosity_total_percent = 44' | file recipe.toml
  expect 0 calendem calibrate "$scripts/cases/paper/experiment.toml" -o "$work/model"
  expect 3 calendem design "$work/model/model.json" "$work/recipe.toml" --porosity 30 --within 2 --confirm 4 \
    --liggghts /bin/false -o "$work/design"
  says "meets the target" "The rest is written."
  [ -s "$work/design/design.html" ] || fail "no page"
}
option_not_a_number() {
  expect 1 calendem design model.json recipe.toml --porosity nan -o "$work/d"
  says "nan is not a number in [1 - 79]"
  expect 1 calendem measure "$work" -o "$work/m" --voxel-um nan
  says "nan is not a number in"
}
output_is_a_file() {
  printf '%s\n' '[cell]' 'x_um = 6' 'y_um = 6' | file recipe.toml
  touch "$work/out"
  expect 2 calendem pack "$work/recipe.toml" -o "$work/out"
  says "$work/out" "with -o"
  expect 2 calendem pack "$work/recipe.toml" -o "$work/out/below"
  [ -f "$work/out" ] || fail "the user's file is gone"
}
output_read_only() { # nobody can make a folder there, not even root
  printf '%s\n' '[cell]' 'x_um = 6' 'y_um = 6' | file recipe.toml
  expect 2 calendem pack "$work/recipe.toml" -o /proc/calendem
  says "/proc/calendem" "with -o"
}
nothing_to_measure() {
  mkdir "$work/empty"
  expect 2 calendem measure "$work/empty"
  says "$work/empty/curve.csv: missing" "calendem run"
  expect 2 calendem measure "$work/empty" -o "$work/out"
  [ ! -e "$work/out" ] || fail "a folder was made for nothing"
  expect 2 calendem measure "$work/no.mhd" -o "$work/out"
  says "$work/no.mhd: no such file"
  echo "not an image" >"$work/image.txt"
  expect 2 calendem measure "$work/image.txt" -o "$work/out"
  says "label images with the ending '.txt' are not read; allowed are" ".mhd"
  printf '%s\n' "ObjectType = Image" "NDims = 3" "DimSize = 4 4 4" "ElementSpacing = 0.3 0.3 0.3" \
    "ElementType = MET_UCHAR" "ElementDataFile = image.raw" >"$work/image.mhd"
  head -c 40 /dev/zero >"$work/image.raw"
  expect 2 calendem measure "$work/image.mhd" -o "$work/out"
  says "announces 64 bytes of voxels, 40 are there"
  [ ! -e "$work/out" ] || fail "a folder was made for nothing"
  expect 1 calendem measure "$work/image.mhd"
  says "--output is required"
  expect 1 calendem measure "$work/image.mhd" -o "$work/out" --voxel-um 0
  says "--voxel-um"
  head -c 64 /dev/zero >"$work/image.raw"
  expect 2 calendem measure "$work/image.mhd" -o /proc/calendem
  says "/proc/calendem" "with -o"
  expect 0 calendem measure "$work/image.mhd" -o "$work/out" # an empty image is one
  expect 2 calendem measure "$work/image.mhd" -o "$work/out" --cbd-label 5
  says "no voxel is left for --cbd-label = 5"
  expect 2 calendem measure "$work/image.mhd" -o "$work/out" --background 3
  says "no voxel is left for --background = 3"
  expect 2 calendem measure "$work/misspelt"
  says "misspelt: no such file or folder"
}
no_mpirun() {
  a_case "$electrode"
  expect 2 env PATH=/nowhere "$bin/calendem" run "$work/case.toml" -o "$work/run" --ranks 1
  says "cannot start mpirun" "Install OpenMPI"
}
no_liggghts() {
  a_case "$electrode"
  expect 2 run --liggghts "$work/liggghts"
  says "no program '$work/liggghts'. Build it with tools/build"
  echo "not a program" >"$work/liggghts"
  expect 2 run --liggghts "$work/liggghts"
  says "is not a program that can be started"
  [ ! -e "$work/run" ] || fail "a folder was made for nothing"
}

# ---- electrode
restitution_too_low() { # the host demands more than 0.05: what validate lets pass must run
  local phases=(am cbd collector platen) least
  a_case "$electrode" '[material]' "${phases[@]/%/.restitution=0.05}"
  refused case.toml "material.am.restitution is 0.05" "material.platen.restitution is 0.05"
  least=$(sed -n 's/.*allowed is \([0-9.]*\) to.*/\1/p' "$work/said" | head -n 1)
  a_case "$electrode" '[material]' "${phases[@]/%/.restitution=$least}"
  expect 0 calendem validate "$work/case.toml"
  expect 0 script -var e_am "$least" -var e_cbd "$least" -var e_col "$least" -var e_plt "$least" \
    -var p_max_MPa 1 -var speed_m_s 20 -var touch_speed_m_s 20 -var release_speed_m_s 20
}
electrode_missing() {
  a_case nowhere
  expect 2 run
  says "$work/nowhere: there is no such folder" "calendem pack"
}
electrode_data_cut() { # in the middle of the last row, so that its number of columns is still right
  copy_of_electrode
  truncate -s -3 "$work/electrode/electrode.data"
  expect 2 run
  says "electrode.data: announces 195 atoms and holds 194 complete rows: it is cut" "calendem pack"
  truncate -s -3000 "$work/electrode/electrode.data"
  expect 2 run
  says "electrode.data"
}
body_map_missing() {
  copy_of_electrode
  rm "$work/electrode/bodies.map"
  expect 2 run
  says "'bodies.map' is missing" "calendem pack"
}
body_map_short() { # whole rows are missing
  copy_of_electrode
  sed -i '$d' "$work/electrode/bodies.map"
  expect 2 run
  says "bodies.map: holds 141 primaries, electrode.json says 142"
  echo "900 1" >>"$work/electrode/bodies.map"
  expect 2 run
  says "'900 1' is not a row 'tag body'"
}
electrode_json_missing() {
  copy_of_electrode
  rm "$work/electrode/electrode.json"
  expect 2 run
  says "'electrode.json' is missing" "calendem pack"
  touch "$work/electrode/electrode.rejected.json"
  expect 2 run
  says "missed its targets"
}
electrode_json_cut() {
  copy_of_electrode
  truncate -s 500 "$work/electrode/electrode.json"
  expect 2 run
  says "electrode.json: cannot be used" "Make the electrode again"
}

# ---- targets
thickness_below_solid() {
  a_case "$electrode" '[platen]' 'control = "thickness"' 'thickness_um = 9'
  expect 2 run
  says "platen.thickness_um = 9 sends the platen to 9.00 um, but the solid alone fills 9.3" "thickness above that"
}
displacement_of_nothing() {
  a_case "$electrode" '[platen]' 'control = "displacement"'
  expect 2 run
  says "case.toml:3: platen.control is \"displacement\" but platen.displacement_um is 0; give a value > 0 um"
  a_case "$electrode" '[platen]' 'control = "thickness"' 'thickness_um = 40'
  expect 2 run
  says "nothing would be compressed"
}
pressure_not_reached() {
  a_case "$electrode" '[material.am]' youngs_modulus_GPa=0.2 ced_J_m3=0 '[material.cbd]' \
    youngs_modulus_GPa=0.05 ced_J_m3=0 '[bond]' youngs_modulus_GPa=0.2 '[platen]' max_pressure_MPa=2000 \
    speed_m_s=4 touch_speed_m_s=4 release_speed_m_s=4
  expect 4 run
  says "stopped at its lowest position" "did not reach platen.max_pressure_MPa = 2000" "Ask for less"
  [ -s "$work/run/curve.csv" ] || fail "no curve.csv"
  grep -q '"failed_checks"' "$work/run/summary.json" || fail "summary.json is not marked"
  expect 4 run # the same again: not computed again, not hidden either
  says "did not reach"
}

# ---- a run that is interrupted
liggghts_error_is_shown() {
  copy_of_electrode
  sed -i 's/^4 atom types/1 atom types/' "$work/electrode/electrode.data"
  expect 3 run
  says "LIGGGHTS failed (exit status 1)" "ERROR" "$work/run/screen.txt"
}
rank_killed() { # kill -9 of one of two ranks; then --resume
  a_case "$electrode" "${quick[@]}"
  begin --ranks 2
  until_file "$work/run/running.restart" "$running"
  kill -9 "$(ranks_of_run | tail -n 1)"
  ended_with 3
  says "exited on signal 9" "What was computed is kept" "--resume"
  is_kept
  local rows
  rows=$(wc -l <"$work/run/curve.csv")
  expect 0 run --resume
  [ "$(wc -l <"$work/run/curve.csv")" -gt "$rows" ] || fail "--resume did not go on"
  grep -q '"finished": true' "$work/run/summary.json" || fail "not finished after --resume"
}
stopped_by_signal() {
  a_case "$electrode" "${quick[@]}"
  begin --ranks 1
  until_file "$work/run/running.restart" "$running"
  kill -TERM "$running"
  ended_with 3
  says "stopped on request (signal 15)" "What was computed is kept" "--resume"
  is_kept
  [ -z "$(ranks_of_run)" ] || fail "LIGGGHTS goes on: $(ranks_of_run)"
  expect 0 run --resume
}
ctrl_c_at_terminal() { # of a user in a hurry: several times
  a_case "$electrode" "${quick[@]}"
  at_terminal "$bin/calendem" run "$work/case.toml" -o "$work/run" --ranks 1
  until_file "$work/run/running.restart" "$running"
  for _ in 1 2 3; do
    ctrl_c || true # it may have ended
    sleep 0.1
  done
  ended_with 3
  says "stopped on request (signal 2)" "What was computed is kept" "--resume"
  is_kept
  nothing_runs_below "$work"
  expect 0 run --resume
}
ctrl_c_of_study() { # two runs at once, of the electrode that is there
  printf '%s\n' '[study]' 'name = "stopped"' 'recipe = "../packing/recipe.toml"' 'case = "case.toml"' \
    'at_pressure_MPa = [3]' '[[vary]]' 'keys = ["case.platen.max_pressure_MPa"]' 'values = [4, 5]' | file study.toml
  a_case "$electrode" "${quick[@]}"
  local study=("$bin/calendem" study "$work/study.toml" -o "$work/out" --jobs 2) run runs
  expect 0 "${study[@]}" --table
  mapfile -t runs < <(awk -F, 'NR > 1 { print $3 }' "$work/out/study.csv")
  cp -r "$electrode" "$work/out/packings/$(awk -F, 'NR == 2 { print $4 }' "$work/out/study.csv")"
  at_terminal "${study[@]}"
  for run in "${runs[@]}"; do
    ln -sfn "$work/out/runs/$run" "$work/run"
    until_file "$work/run/running.restart" "$running"
  done
  ctrl_c
  ended_with 3
  says "stopped on request" "What was computed is kept" "the same command continues it"
  nothing_runs_below "$work"
  for run in "${runs[@]}"; do
    ln -sfn "$work/out/runs/$run" "$work/run"
    is_kept
  done
  expect 0 "${study[@]}"
  says "2 of 2 runs done"
}
stopped_run() { # a run that was stopped after two restart files
  a_case "$electrode" "${quick[@]}"
  begin --ranks 1
  until_file "$work/run/running.previous" "$running"
  kill -TERM "$running"
  ended_with 3
}
restart_cut() { # the one before it is taken; without it nothing is lost
  stopped_run
  truncate -s -1000 "$work/run/running.restart"
  cp -r "$work/run" "$work/kept"
  expect 0 run --resume
  says "is cut; going on from the one before it"
  rm -r "$work/run"
  cp -r "$work/kept" "$work/run"
  rm "$work/run/running.previous"
  expect 2 run --resume
  says "running.restart' is cut or damaged" "What was computed is kept" "--force"
  is_kept
}
restart_damaged() { # no restart file at all, of the right length
  stopped_run
  rm "$work/run/running.previous"
  head -c "$(stat -c %s "$work/run/running.restart")" /dev/zero >"$work/zeros"
  cp "$work/zeros" "$work/run/running.restart"
  expect 2 run --resume
  says "running.restart' is cut or damaged"
}
unfinished_run_is_kept() { # neither overwritten nor mixed with other settings
  stopped_run
  expect 2 run
  says "holds an unfinished run: stopped on request" "--resume" "--force"
  is_kept
  sed -i 's/^max_pressure_MPa.*/max_pressure_MPa = 7/' "$work/case.toml"
  expect 2 run --resume
  says "holds a run of another case" "platen.max_pressure_MPa: then 5, now 7"
  is_kept
}
two_runs_in_one_folder() {
  a_case "$electrode" "${quick[@]}"
  begin --ranks 1
  until_file "$work/run/curve_raw.csv" "$running"
  expect 2 run --force
  says "another run is writing into '$work/run'"
  kill -TERM "$running"
  ended_with 3
}
files_of_others() { # nothing is replaced that the command did not write
  a_case "$electrode" "${quick[@]}"
  expect 2 calendem run "$work/case.toml" -o "$electrode"
  says "the folder of the electrode"
  expect 2 calendem run "$work/case.toml" -o "$work"
  says "case.toml' was not written by this command"
  expect 0 run
  mv "$work/run/summary.json" "$work/kept.json"
  expect 2 run
  says "holds 'curve_raw.csv' but no summary.json" "--force"
  [ -s "$work/run/curve_raw.csv" ] || fail "the run was removed"
  mv "$work/kept.json" "$work/run/summary.json"
  printf '%s\n' '[cell]' 'x_um = 6' 'y_um = 6' | file recipe.toml
  expect 2 calendem pack "$work/recipe.toml" -o "$work/run"
  says "holds a run, whose bodies.csv would be replaced"
  expect 2 calendem sample "$work/run" "$work/run" --one gap -o "$work/run"
  says "the folder of a run of the sample"
  mkdir -p "$work/x;y"
  expect 2 calendem run "$work/case.toml" -o "$work/x;y"
  says "LIGGGHTS cannot take a path with"
}
report_in_place_of_results() {
  a_case "$electrode" "${quick[@]}"
  expect 0 run
  expect 2 calendem report "$work/run" -o "$work/nowhere/page.html"
  says "there is no folder '$work/nowhere'"
  for name in summary.html curve.csv electrode.html; do
    expect 2 calendem report "$work/run" -o "$work/run/$name"
    says "ends in .html and is none of design, electrode, gap"
  done
  printf '{' >"$work/run/electrode.json"
  expect 2 calendem report "$work/run"
  says "$work/run/electrode.json: cut or damaged"
}
another_case_in_folder() {
  a_case "$electrode" "${quick[@]}"
  expect 0 run
  expect 0 run
  says "already holds this run"
  a_case "$electrode" "${quick[@]}" '[bond]' tensile_strength_MPa=300
  expect 2 run
  says "holds a run of another case" "bond.tensile_strength_MPa: then 500, now 300"
  grep -q '"finished": true' "$work/run/summary.json" || fail "the finished run was touched"
}
another_recipe_in_folder() {
  cp -r "$electrode" "$work/packed"
  sed 's/^seed = 3$/seed = 4/' "$shared/packing/recipe.toml" >"$work/recipe.toml"
  expect 2 calendem pack "$work/recipe.toml" -o "$work/packed" --ranks 1
  says "'$work/packed' holds an electrode of another recipe" "seed: then 3, now 4" "--force"
  diff -r "$electrode" "$work/packed" || fail "the electrode was touched"
  expect 0 calendem pack "$shared/packing/recipe.toml" -o "$work/packed" --ranks 1
  says "already holds this electrode"
  cp "$bin/liggghts" "$work/another" # the same recipe by another program is packed again, as ever
  echo >>"$work/another"
  expect 0 calendem pack "$shared/packing/recipe.toml" -o "$work/packed" --ranks 1 --liggghts "$work/another"
  says "densifying"
  expect 0 calendem pack "$work/recipe.toml" -o "$work/packed" --ranks 1 --force
  grep -q '"seed": "4"' "$work/packed/electrode.json" || fail "--force did not pack"
  expect 0 calendem pack "$work/recipe.toml" -o "$work/packed" --ranks 1 --force
  says "already holds this electrode"
}
collected_again() { # a run's folder: what its summary knows is kept; a frame that is cut is named
  a_case "$electrode" "${quick[@]}" '[effects.thickness_zero]' offset_um=1
  expect 0 run
  cp -r "$work/run" "$work/kept"
  sed -i 's/$/\r/' "$work/run/settings.txt" # copied by way of Windows
  expect 0 calendem collect "$work/run"
  cmp "$work/run/curve.csv" "$work/kept/curve.csv" || fail "the curve is another"
  diff <(grep -v case_toml "$work/run/summary.json") <(grep -v case_toml "$work/kept/summary.json") || fail "the summary is another"
  expect 0 run # still the same run
  says "already holds this run"
  local frame
  frame=$(find "$work/run/vtk" -name 'particles_[0-9]*.vtp' -printf '%f\n' | sort -t_ -k2n | tail -n 1)
  truncate -s -100 "$work/run/vtk/$frame"
  expect 0 calendem collect "$work/run"
  says "warning: '$work/run/vtk/$frame' is cut and left out"
  sed -i 's/^variable sigma_c_MPa.*/variable sigma_c_MPa index 300/' "$work/run/settings.txt" # by plain scripts, of another case
  expect 0 calendem collect "$work/run"
  grep -q '"case_hash": ""' "$work/run/summary.json" || fail "another case has the hash of the run before it"
}
images_of_a_moment() {
  a_case "$electrode" "${quick[@]}"
  expect 0 run
  expect 0 calendem measure "$work/run" -o "$work/out" --images --moment max --voxel-um 0.3 --without-tortuosity
  [ -s "$work/out/max.mha" ] || fail "no image of the moment"
  [ "$(find "$work/out" -name '*.mha' | wc -l)" -eq 1 ] || fail "images of other moments too"
}
disk_full_at_start() {
  full_disk 2
  a_case "$electrode" "${quick[@]}"
  expect 2 calendem run "$work/case.toml" -o "$work/disk/run" --ranks 1
  says "the disk of '$work/disk/run' has" "needs at least" "Make room"
}
disk_fills_in_mid_run() { # to the last byte, while LIGGGHTS writes; with room again --resume goes on
  full_disk 16
  a_case "$electrode" "${quick[@]}"
  ln -sfn "$work/disk" "$work/run"
  begin --ranks 1
  until_file "$work/run/running.previous" "$running"
  cat /dev/zero >"$work/disk/ballast" 2>/dev/null || true
  ended_with 3
  says "almost full" "Make room" "What was computed is kept"
  rm "$work/disk/ballast"
  expect 0 run --resume
  [ -s "$work/run/curve.csv" ] || fail "no curve.csv"
}

# ---- plain input scripts: the plugin's own checks
script_strength() {
  expect 1 script -var sigma_c_MPa -5
  says "ERROR: Fix bond/bpm" "'tensile' is '-5000'; it must be a finite number > 0"
  expect 1 script -var sigma_c_MPa nan
  says "ERROR"
}
script_criterion() {
  expect 1 script -var criterion singed
  says "ERROR: Fix bond/bpm" "'criterion singed'" "criterion signed|unsigned|as_printed"
}
script_modulus_in_pa() {
  expect 1 script -var E_am_GPa 2e11 # of bonds too
  says "ERROR: Fix bond/bpm" "'youngs_modulus' is 2e+17 kPa = 2e+11 GPa" "Is it given in Pa?"
  expect 1 script -var E_am_GPa 2e11 -var E_bond_GPa 200
  says "ERROR: Fix bond/bpm" "youngsModulus of atom type 1 is 2e+17 kPa = 2e+11 GPa" "Is it given in Pa?"
  expect 1 script -var p_max_MPa 150e6
  says "ERROR: Fix wall/gran/platen" "'pressure' is" "Is it given in Pa?"
}
script_effects() {
  expect 1 script -var nmc_yield_GPa 1
  says "ERROR: model hertz_effects: contactYieldPressure of atom types 1 and 1 is 1e+06" "Give at least 1.5e+06"
  expect 1 script -var cbd_relaxed_fraction 0.5 -var cbd_relaxation_us 0
  says "ERROR: model hertz_effects: contactRelaxationTime of atom types 1 and 2 is 0" "must be a finite number > 0"
  expect 1 script -var cbd_relaxed_fraction 0.2 -var cbd_contact_yield_GPa 1
  says "ERROR: model hertz_effects: contactRelaxedFraction of atom types 1 and 2 is 0.2" "a contact follows one law" \
    "contactYieldPressure to 0"
  expect 1 script -var cbd_contact_yield_GPa 1 -var cbd_contact_hardening_GPa 0.5
  says "ERROR: model hertz_effects: contactHardening of atom types 1 and 2 is 500000 kPa" "0.159 of the effective modulus"
  expect 1 script -var cbd_yield_MPa 5 -var cbd_floor_phi 0.6
  says "ERROR: Fix cbd/collapse" "'floor' must not lie above 'initial'"
  expect 1 script -var cbd_yield_MPa 5 -var cbd_imposed_MPa 150
  says "ERROR: Fix cbd/collapse" "'yield' and 'imposed' exclude each other"
  expect 1 script -var collector_yield_GPa 0.1 -var ced_am_J_m3 0 -var speed_m_s 4 -var touch_speed_m_s 4
  says "ERROR on proc 0: model hertz_effects: a sphere of type 1 has sunk" "into the wall of type 3" "larger cell"
}
script_collapse() {
  expect 1 script -var ced_cbd_J_m3 7e9
  says "ERROR: Fix bond/bpm" "cohesionEnergyDensity of atom types 1 and 2" "of their radius" "collapses"
  expect 1 script -var mu_am -1
  says "coefficientFriction of atom types 1 and 1 is -1" "must be >= 0"
}
script_disk_full_at_restart() { # to the last byte, between two restart files of plain LIGGGHTS
  full_disk 4
  printf '%s\n' "units si" "atom_style sphere" "atom_modify sort 0 0" "boundary p p p" "communicate single vel yes" \
    "region box block 0 1 0 1 0 1 units box" "create_box 1 box" "lattice sc 0.05" "create_atoms 1 box" \
    "set group all diameter 0.01 density 1000" "neighbor 0.1 bin" \
    "write_restart/whole disk/running keep disk/previous" "shell cp disk/running first" \
    "shell cat /dev/zero >disk/ballast" "write_restart/whole disk/running keep disk/previous" \
    "shell rm disk/ballast" "write_restart/whole disk/running keep disk/previous" >"$work/in.restarts"
  expect 0 env -C "$work" "$bin/liggghts" -in in.restarts -log none
  says "the restart file could not be written whole (is the disk full?); the one before it is kept"
  cmp "$work/first" "$work/disk/previous" || fail "the restart file before the full disk is not kept"
  cmp "$work/first" "$work/disk/running" || fail "with room again the restart file is not whole"
  [ ! -e "$work/disk/running.part" ] || fail "half a file is left"
}
script_short_cell() { # the two spheres of this cell would touch their own images
  mkdir -p "$work/electrode"
  printf '%s\n' "two spheres" "" "2 atoms" "4 atom types" "" "0 3 xlo xhi" "0 3 ylo yhi" "0 9 zlo zhi" "" Atoms "" \
    "1 1 1.59 4.65 1 1 1" "2 1 1.59 4.65 2.28 1 1" >"$work/electrode/electrode.data"
  printf '%s\n' "# tag body, 2 rows" "1 1" "2 1" >"$work/electrode/bodies.map"
  printf 'variable %s\n' "thickness_um equal 6" "area_um2 equal 9" "solid_volume_um3 equal 4.2" \
    "primary_diameter_um equal 1.59" "lattice_um equal 1.28" "cbd_diameter_um equal 1.316" >"$work/electrode/electrode.in"
  script_electrode=$work/electrode expect 1 script
  says "ERROR" "periodic box side x is 3, shorter than two neighbour cut-offs" "Make the cell larger"
}
script_body_map_cut() {
  copy_of_electrode
  sed -i '$d' "$work/electrode/bodies.map"
  script_electrode=$work/electrode expect 1 script
  says "ERROR: Fix bond/bpm" "announces 142 rows and holds 141: it is cut"
  rm "$work/electrode/bodies.map"
  script_electrode=$work/electrode expect 1 script
  says "cannot open the body map" "No such file"
  cp "$electrode/bodies.map" "$work/electrode/"
  truncate -s 6000 "$work/electrode/electrode.data"
  script_electrode=$work/electrode expect 1 script
  says "ERROR" "Unexpected end of data file"
}
script_time_step() {
  expect 1 script -var dt_us 0.01
  says "ERROR: Fix check/timestep/bpm" "time step 0.01 us exceeds 1 of the smaller of the bonds' bound" "use at most"
}

electrode() { # what all cases press: 6 x 6 um, a fifth of the paper's loading
  printf '%s\n' 'name = "small"' 'seed = 3' '[coating]' 'loading_mg_cm2 = 4' '[cell]' 'x_um = 6' 'y_um = 6' | file recipe.toml
  expect 0 calendem pack "$work/recipe.toml" -o "$work.new" --ranks 1
  rm -rf "$electrode.old"
  rm -rf "$electrode"
  mv "$work.new" "$electrode"
}
case $case in
  "" | *[!a-z_0-9]*) echo "usage: cases.sh CASE BIN WORK" >&2; exit 1 ;;
esac
[ "$case" = electrode ] && work=$shared/packing
[ -n "${CALENDEM_TEST_DISK:-}" ] || rm -rf "$work"
mkdir -p "$work"
"$case"
