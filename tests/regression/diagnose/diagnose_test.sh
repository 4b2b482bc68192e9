#!/usr/bin/env bash
# diagnose_test.sh BIN WORK: gap.json and gap.html of a small experiment; the same bytes twice; mistakes are reported; base
# model, named effect and runner-up run again for a held-out sample.
set -euo pipefail
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
rm -rf "$work"
mkdir -p "$work/regression"
cp -r "$here" "$here/../calendering" "$work/regression"
cd "$work/regression/diagnose"
diagnose() { "$bin/calendem" diagnose "$@"; }

diagnose experiment.toml -o one --bank bank.toml >one.log || fail "exit status $?"
diagnose experiment.toml -o two --bank bank.toml --table bank.csv >/dev/null
for file in gap.json gap.html; do
  cmp one/$file two/$file || fail "the same input gave another $file"
done

claim=$(sed -n 's/^  "claim": "\(.*\)",/\1/p' one/gap.json)
headline=$(sed -n 's/^  "headline": "\(.*\)",/\1/p' one/gap.json)
[ -n "$claim" ] || fail "no claim in gap.json"
[ -n "$headline" ] || fail "no headline in gap.json"
echo "$claim: $headline"
grep -q "^claim: $claim\$" one.log || fail "the terminal says another claim"
grep -qF "<h2 id=\"claim\">$headline</h2>" one/gap.html || fail "the page lacks the claim"
for field in where which threshold conflicts conflict_matrix stages confounding parameters fitted_effects \
  predictions emulators experiment said not_said provenance; do
  grep -q "^ \"$field\": " one/gap.json || fail "gap.json has no '$field'"
done
for words in '"what": "share of cracked particles in a cross-section: p30, p40"' '"cost": 10.0' '"unit": "%"' \
  '"what": "X-ray tomogram before and after"' "p40: the bank's runs do not dwell" \
  'p30: not every run of the bank has its displacement at 15 MPa, displacement at 22 MPa; left out'; do
  grep -qF -- "$words" one/gap.json || fail "gap.json lacks $words"
done
sed '/<script type="application.json" id="data">/,$d' one/gap.html |
  grep '{{\|https\?:\| src=\|<link rel="stylesheet' >/dev/null && fail "the page is not whole or not by itself"

# Where two explanations are left, further measurements are simulated (20 runs).
diagnose experiment.toml -o one_left --bank bank.toml --no-rerun --simulate-next 2 | grep "fewer than two explanations" >/dev/null ||
  fail "it is not said that nothing is left to tell apart"
if [ -n "${CALENDEM_HEAVY:-}" ]; then
  cat >few.toml <<'END'
[experiment]
name = "one porosity"
electrode = "../calendering/electrode.toml"
sample_diameter_mm = 11
[[condition]]
id = "p30"
control = "pressure"
max_pressure_MPa = { value = 30, sd_relative = 0.05 }
porosity_after_percent = { value = 45.2, sd = 1 }
END
  diagnose few.toml -o few --bank bank.toml --no-rerun --simulate-next 2 --jobs 2 >few.log || fail "exit status $? of --simulate-next"
  # Friction keeps a film from becoming denser at 60 MPa: by more than the bank's range at 50 MPa leaves open.
  awk '/^  60 instead of 30 MPa/ { on = 1 } on && /friction and none:/ { exit !($4 > 3) }' few.log ||
    fail "$(cat few.log)"
  grep -q "Distinguishes" few/gap.html || fail "the page does not show what was simulated"
fi

refuses() { # WORDS ARGUMENTS...
  local words=$1 status=0
  shift
  diagnose -o bad "$@" >bad.log 2>&1 || status=$?
  [ $status = 2 ] || fail "exit status $status for: $*"
  grep -qF -- "$words" bad.log || { cat bad.log; fail "'$words' is not said for: $*"; }
  [ ! -e bad ] || fail "something was written for: $*"
}
refuses "Did you mean 'friction'" experiment.toml --bank bank.toml --without frction
refuses "no such file" experiment.toml --bank bank.toml --table other.csv
cut -d, -f1-9 bank.csv >short.csv
refuses "column 'porosity_initial' is missing" experiment.toml --bank bank.toml --table short.csv
sed '5s/,[^,]*$//' bank.csv >cut.csv
refuses "cut.csv:5: the row has another number of cells" experiment.toml --bank bank.toml --table cut.csv
sed 's/^sample_diameter_mm.*//' experiment.toml >no_size.toml
refuses "or --cells" no_size.toml --bank bank.toml
sed 's/value = [345]0, sd_relative/value = 90, sd_relative/' experiment.toml >beyond.toml
refuses "nothing that was measured can be compared" beyond.toml --bank bank.toml
sed 's/^am_weight_percent.*/am_weight_percent = 90/; s/^carbon_weight_percent.*/carbon_weight_percent = 8/' \
  ../calendering/electrode.toml >other_electrode.toml
grep -q '= 90' other_electrode.toml || printf '\n[composition]\nam_weight_percent = 90\ncarbon_weight_percent = 8\n' >>other_electrode.toml
sed 's|^electrode = .*|electrode = "other_electrode.toml"|' experiment.toml >other.toml
refuses "not the bank's electrode; composition.am_weight_percent: 90 instead of 96" other.toml --bank bank.toml
diagnose other.toml -o other --bank bank.toml --other-electrode --no-rerun >other.log || fail "exit status $?"
grep -q "^note: the sample is not the bank's electrode" other.log || fail "another electrode is not reported"

# Points are chosen for the experiment; with CALENDEM_HEAVY made, and learnt from (four runs).
"$bin/calendem" bank bank.toml -o choice --choose 2 --experiment experiment.toml >choice.log || { cat choice.log; fail "exit status $? of --choose"; }
[ "$(grep -c '^friction,[678],0' choice/chosen.csv)" = 2 ] || { cat choice/chosen.csv; fail "two points of friction, beside others than it has"; }
sed "s|^effects = .*|&\nchosen_points = \"choice/chosen.csv\"|" bank.toml >more.toml
cp bank.csv more.csv
bank_refuses() { # WORDS ARGUMENTS...
  if "$bin/calendem" bank "${@:2}" >refused.log 2>&1; then fail "bank took ${*:2}"; fi
  grep -qF -- "$1" refused.log || { cat refused.log; fail "'$1' is not said"; }
}
bank_refuses "has no runs in the table yet" more.toml -o again --choose 1 --experiment experiment.toml
bank_refuses "is a file of the bank itself" more.toml -o choice --choose 1 --experiment experiment.toml
bank_refuses "not the bank's electrode" bank.toml -o again --choose 1 --experiment other.toml
bank_refuses "excludes" bank.toml -o again --choose 1 --experiment experiment.toml --table
sed 's/^low = 150/low = 160/' bank.toml >another.toml
bank_refuses "it is the table of another bank" another.toml -o again --from bank.csv
if [ -n "${CALENDEM_HEAVY:-}" ]; then
  "$bin/calendem" bank more.toml -o more --from bank.csv bank.csv --jobs 2 >more.log || { cat more.log; fail "runs of chosen points"; }
  grep -q "^study: 4 runs," more.log || { cat more.log; fail "runs that the table has were made again"; }
  cmp <(cut -d, -f1-12 bank.csv) <(head -n "$(wc -l <bank.csv)" more/bank.csv | cut -d, -f1-12) || fail "the table does not begin with that it was made from"
  diagnose experiment.toml -o with_more --bank more.toml --table more/bank.csv --no-rerun >with_more.log || fail "exit status $?"
  for runs in one:6 with_more:8; do
    grep -A1 '"effect": "friction",' "${runs%:*}/gap.json" | grep -q "\"runs\": ${runs#*:}" || fail "friction has not ${runs#*:} runs"
  done
fi

# A bank stands for another electrode after few runs of that (four).
{ cat bank.toml; printf '[full_cell]\nrecipe = "other_electrode.toml"\ncase = "case.toml"\npoints = 2\nother_electrode = "yes"\n'; } >moved.toml
if [ -n "${CALENDEM_HEAVY:-}" ]; then
  "$bin/calendem" bank moved.toml -o moved --from bank.csv --jobs 2 >moved.log || { cat moved.log; fail "bank --from"; }
  [ "$(wc -l <moved/bank.csv)" = "$(($(wc -l <bank.csv) + 4))" ] || fail "the table has not four rows more"
  diagnose other.toml -o moved_gap --bank moved.toml --table moved/bank.csv --no-rerun >moved.log || { cat moved.log; fail "diagnose with it"; }
  grep -q "of another electrode: shifted by what 2 runs of this one" moved.log || fail "the shift is not reported"
  refuses "not the bank's electrode" experiment.toml --bank moved.toml --table moved/bank.csv
fi
sed 's/^id = "p50"/&\nporosity_before_percent = { value = 45.5, sd = 0.5 }/' experiment.toml >denser.toml
diagnose denser.toml -o denser --bank bank.toml --no-rerun >denser.log || fail "exit status $?"
grep -q "^note: p50: its porosity before calendering is 45.5 ± 0.5 %" denser.log || fail "another coating is not reported"
grep -qE "^ *p50 +total porosity before +before .* beyond noise" denser.log || fail "another coating is not seen where it is"
sed 's/^id = "p50"/&\nporosity_before_percent = { value = 47.2, sd = 0.5 }/' experiment.toml >as_recipe.toml
diagnose as_recipe.toml -o as_recipe --bank bank.toml >as_recipe.log || fail "a sample as its recipe says is refused"
grep -q "its porosity before calendering" as_recipe.log && fail "a sample as its recipe says is reported as another"
grep -qE "^ *p50 +total porosity before" as_recipe.log || fail "the porosity before calendering is not compared"
sed 's/^hours = 5/hours = -5/' bank.toml >price.toml
refuses "hours is -5" experiment.toml --bank price.toml --table bank.csv

# The bank that ships, and the paper's electrode, whose film is thicker.
diagnose "$here/../../../input_scripts/cases/paper/experiment.toml" -o table_1 --no-rerun >table_1.log ||
  fail "the shipped bank cannot diagnose Table 1"
grep -q "shifted by 100 % of what 3 runs of 17.46 mg/cm2 differ by" table_1.log || fail "the film's thickness is not reported"
grep -q "beyond noise" table_1.log && grep -q "^Nothing that" table_1.log && fail "what is seen in Table 1 is called nothing"
grep -qF '"numerics: cell": 2.0' table_1/gap.json || fail "the budget lacks the numerics"

# With a porosity after 300 MPa, which parts its explanations, nothing is left out, if the bank was run that far.
shipped="$here/../../../input_scripts/cases/bank/bank.csv"
furthest=$(awk -F, '$1 == "" && $9 + 0 > most { most = $9 + 0 } END { print most }' "$shipped")
if [ "$furthest" -ge 300 ]; then
  cp -r "$here/../../../input_scripts/cases/paper" paper
  { cat paper/experiment.toml; printf '\n[[condition]]\nid = "p300"\ncontrol = "pressure"\n'
    printf 'max_pressure_MPa = { value = 300, sd_relative = 0.1 }\nporosity_after_percent = { value = 24.7, sd = 0.5 }\n'; } >paper/three.toml
  diagnose paper/three.toml -o three --no-rerun >three.log || { cat three.log; fail "exit status $?"; }
  grep -q "^ *p300 *total porosity" three.log || fail "300 MPa are not compared"
  grep -E "^- p300: .*left out" three.log && fail "300 MPa are left out"
else
  echo "not tested: a sample after 300 MPa, because the bank's runs end at $furthest MPa"
fi

# Friction is what the table's experiment was made with; samples at 30 and 40 MPa train, 50 MPa is held out.
sed 's/^sample_diameter_mm.*/&\nsplit = { train = ["p30", "p40"], test = ["p50"] }/' experiment.toml >split.toml
diagnose split.toml -o far --bank bank.toml --packings 2 --jobs 2 >far.log || { cat far.log; fail "exit status $?"; }
for field in before after fraction interval90 noise_floor runner_up unexplained models observables curves; do
  grep -q "^  \"$field\": " far/gap.json || fail "shrink has no '$field'"
done
for role in before after runner-up; do
  grep -q "^  $role " far.log || fail "$role is not reported"
  grep -qF "\"role\": \"$role\"" far/gap.json || fail "gap.json lacks the model $role"
done
runs=$(find far/rerun/runs -name summary.json | wc -l)
[ "$runs" -eq 6 ] || fail "$runs runs for three models on two packings"
diagnose split.toml -o far --bank bank.toml --packings 2 >again.log
grep -q "6 runs, 6 of them done already" again.log || fail "a second diagnosis made its runs again"
cp far/gap.json before.json
diagnose split.toml -o far --bank bank.toml --packings 2 >/dev/null
cmp before.json far/gap.json || fail "the same runs gave another gap.json"

# A held-out film that is pressed again: the bank makes such runs, the models are run again so (51 runs).
if [ -n "${CALENDEM_HEAVY:-}" ]; then
  { cat bank.toml; printf '[[pressing]]\nname = "again"\nwhat = "pressed twice"\nsettings = { "platen.presses" = 2 }\n'
    printf 'pressures_MPa = [50]\nbase_points = 9\neffect_points = 6\n'; } >again.toml
  "$bin/calendem" bank again.toml -o again --jobs 2 >again.log || { cat again.log; fail "a bank of films pressed again"; }
  [ "$(awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "pressing") c = k } $c == "again"' again/bank.csv | wc -l)" = 15 ] ||
    fail "the table has not 15 runs pressed again"
  sed 's/^id = "p50"/&\npressing = "again"/' split.toml >split_again.toml
  diagnose split_again.toml -o far_again --bank again.toml --table again/bank.csv --packings 2 --jobs 2 >again.log ||
    { cat again.log; fail "exit status $?"; }
  mapfile -t pressed < <(awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "case.platen.presses") c = k } NR > 1 { print $c }' far_again/rerun/study.csv)
  [ "${pressed[*]}" = "2 2 2 2 2 2" ] || fail "the models were pressed ${pressed[*]} times"
fi

# A label image of the held-out sample, here a frame of the base model's first packing, beside the models that are run
# again: as calendem compare finds it, and off by as many deviations of image and mean.
mapfile -t ids < <(awk -F, '$2 == "done" { print $3 }' far/rerun/study.csv)
"$bin/calendem" run "far/rerun/runs/${ids[0]}.toml" -o framed --ranks 1 >/dev/null
"$bin/calendem" measure framed -o images --without-tortuosity --voxel-um 0.3 --images >/dev/null
sed 's/^id = "p50"/&\nlabels_after = "images\/after.mha"/; s/^electrode = .*/&\nlabels_cbd = -1/' split.toml >seen.toml
diagnose seen.toml -o seen --bank bank.toml --packings 2 --jobs 2 >seen.log || { cat seen.log; fail "exit status $?"; }
"$bin/calendem" compare seen.toml "seen/rerun/runs/${ids[0]}" "seen/rerun/runs/${ids[1]}" -o seen_gap >/dev/null
of_compare() { # NAME FIELD
  awk -v name="\"observable\": \"$1\"" -v field="\"$2\": " '/^  \{/ { value = found = "" } index($0, field) { value = $2 }
    index($0, name) { found = 1 } /^  \}/ && found { sub(",", "", value); print value; exit }' seen_gap/gap.json
}
of_images() { # NAME: mean, off of the base model, measured, sd, sd of the mean
  awk -v OFMT=%.12g -v name="\"name\": \"$1\"" '/^  "images"/ { inside = 1 } inside && index($0, name) { found = 1 }
    found && /"measured"/ { measured = $2 + 0 } found && /^     "sd"/ { sd = $2 + 0 }
    found && /"before"/ { before = 1 } before && /"mean"/ { mean = $2 + 0 } before && /^      "sd"/ { of_mean = $2 + 0 }
    before && /"off"/ { print mean, $2 + 0, measured, sd, of_mean; exit }' seen/gap.json
}
for name in "macro porosity, image after" "AM, upper minus lower third, image after"; do
  read -r mean off measured sd of_mean < <(of_images "$name") || fail "gap.json has no '$name' for the base model"
  compared=$(of_compare "$name" simulated)
  awk "BEGIN { d = $mean - ($compared); exit !(d < 1e-6 && d > -1e-6) }" || fail "$name: $mean, compare finds $compared"
done
awk "BEGIN { z = ($mean - ($measured)) / sqrt($sd ^ 2 + $of_mean ^ 2) - ($off); exit !(z < 1e-6 && z > -1e-6) }" ||
  fail "off by $off: mean $mean, image $measured within $sd, packings $of_mean"
grep -q "Label images of what was held out" seen/gap.html || fail "the page does not show the image"
grep -q "^  p50 *macro porosity, image after, %" seen.log || fail "the terminal does not show the image"
rm -r seen/rerun/runs/"${ids[1]}"/vtk
diagnose seen.toml -o seen --bank bank.toml --packings 2 >seen.log || fail "exit status $?"
grep -q "^- p50: the runs have no value for macro porosity, image after.*${ids[1]}" seen.log || fail "lost frames are not reported"
