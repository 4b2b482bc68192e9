#!/usr/bin/env bash
# study_test.sh BIN WORK: two strengths on two packings; stopped, gone on with, split as an array of jobs would.
set -euo pipefail
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
column() { # NAME: its cells in the table
  awk -F, -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k } NR > 1 { print $c }' "$work/out/study.csv"
}

rm -rf "$work"
mkdir -p "$work"
cp "$here/../calendering/electrode.toml" "$work/"
sed 's/= 2$/= 4/' "$here/../calendering/case.toml" >"$work/case.toml" # twice as fast
cat >"$work/study.toml" <<'T'
[study]
name = "two strengths, two packings"
recipe = "electrode.toml"
case = "case.toml"
at_pressure_MPa = [10]
keep = "tables"
[[vary]]
keys = ["recipe.seed"]
values = [1, 2]
[[vary]]
keys = ["case.bond.tensile_strength_MPa", "case.bond.shear_strength_MPa"]
values = [150, [400, 400]]
T
study() { "$bin/calendem" study "$work/study.toml" -o "$work/out" "$@"; }

study --only 4 # the second strength on the second packing
[ "$(column status | paste -sd,)" = "not started,not started,not started,done" ] || fail "--only made others"
"$bin/calendem" study "$work/study.toml" -o "$work/out" --jobs 2 >"$work/stopped.log" 2>&1 &
job=$!
until [ -s "$work/out/packings/$(column packing | head -n 1)/electrode.json" ]; do sleep 0.05; done
kill -TERM $job
wait $job && fail "a study that was stopped must not end with exit status 0"
grep -q "continues it" "$work/stopped.log" || fail "the message does not say how to continue"
study --jobs 2
study >"$work/again.log"
grep -q "4 runs, 4 of them done already" "$work/again.log" || fail "a second call should find all runs done"

[ "$(column status | sort -u)" = "done" ] || fail "not all runs are done"
[ "$(column packing | sort -u | wc -l)" = 2 ] || fail "runs of one seed do not share their packing"
[ "$(column case.bond.shear_strength_MPa | paste -sd,)" = 150,400,150,400 ] || fail "settings are not those of the study"
mapfile -t broken < <(column broken_fraction_at_max)
awk "BEGIN { exit !(${broken[0]} > ${broken[1]} && ${broken[2]} > ${broken[3]}) }" || fail "weaker bonds did not break more"
first=$work/out/runs/$(column run | head -n 1)
[ ! -e "$first/vtk" ] || fail "frames were kept"
[ -z "$(find "$first" -name '*.restart')" ] || fail "restart files were kept"
awk -F, -v p="$(column thickness_um_at_10_MPa | head -n 1)" 'NR == 1 { for (k = 1; k <= NF; k++) { if ($k == "thickness_um") h = k; if ($k == "pressure_MPa") q = k } next }
  $q >= 10 { exit !(p >= $h && p <= before) } { before = $h }' "$first/curve.csv" || fail "thickness at 10 MPa is not between its rows"

# Two rows that ask for the same run, side by side: it is made once.
sed 's/^values = \[1, 2\]/values = [3, 3]/; s/^values = \[150, .*/values = [150]/' "$work/study.toml" >"$work/same.toml"
"$bin/calendem" study "$work/same.toml" -o "$work/same" --jobs 2 >"$work/same.log" 2>&1 || { cat "$work/same.log"; fail "one run asked for twice"; }
[ "$(awk -F, 'NR > 1 { print $2 }' "$work/same/study.csv" | paste -sd,)" = done,done ] || fail "one run asked for twice is not done"
[ "$(find "$work/same/runs" -mindepth 1 -maxdepth 1 -type d | wc -l)" = 1 ] || fail "it was made twice"

# A packing that failed is not tried again for the other run on it.
printf '#!/bin/sh\necho started >>"%s"\nexit 1\n' "$work/starts" >"$work/fails"
chmod +x "$work/fails"
sed 's/^values = \[1, 2\]/values = [5]/' "$work/study.toml" >"$work/unpacked.toml"
"$bin/calendem" study "$work/unpacked.toml" -o "$work/unpacked" --liggghts "$work/fails" >"$work/unpacked.log" 2>&1 && fail "a study without a packing is no success"
[ "$(wc -l <"$work/starts")" = 1 ] || fail "a packing that failed was tried $(wc -l <"$work/starts") times"

# Particles from a data file: the study writes their recipe anew, with what it varies and without what the file gives.
particle=$here/../../../input_scripts/cases/particle
sed "s|^recipe = .*|recipe = \"$particle/electrode.toml\"|; s|^case = .*|case = \"$particle/case.toml\"|
  s/^values = \[\[5, .*/values = [[5, 0.6], [6, 0.6]]/; s/^keys = .*bond.seed.*/keys = [\"recipe.seed\"]/; s/^values = \[\[1, .*/values = [1]/" "$particle/sizes.toml" >"$work/particle.toml"
"$bin/calendem" study "$work/particle.toml" -o "$work/particle" --jobs 2 >"$work/particle.log" 2>&1 || { cat "$work/particle.log"; fail "a study of particles from a file"; }
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
  { d = $at["recipe.structure.lj_length_um"]; h = $at["thickness_at_max_um"] / d; p = $at["porosity_initial"]
    # the film is packed to 89 % in a cell of 2 d: pi / 24 / 0.11 = 1.19 d thick
    if ($at["status"] != "done" || (p - 0.89) ^ 2 > 1e-6 || h > 1.2 || h < 1) exit 1 } END { exit NR != 3 }' "$work/particle/study.csv" ||
  { cat "$work/particle/study.csv"; fail "the particles of the file have other sizes"; }
# A value that is the default of its key is what the study says, not what the file gives.
sed 's/^keys = \["recipe.seed"\]/keys = ["recipe.coating.loading_mg_cm2"]/; s/^values = \[1\]/values = [17.46, 20]/' "$work/particle.toml" >"$work/default.toml"
"$bin/calendem" study "$work/default.toml" -o "$work/default" --liggghts "$(type -P false)" >"$work/default.log" 2>&1 && fail "a study without packings is no success"
[ "$(grep -lE '^loading_mg_cm2 = (17.46|20) ' "$work"/default/packings/*.toml | wc -l)" = 4 ] || fail "a loading of the study is not in the packing's recipe"

# A bank whose runs all fail says so, and keeps a row for each of its points.
cat >"$work/bank.toml" <<'T'
[bank]
name = "fails"
recipe = "electrode.toml"
case = "case.toml"
points = 4
packings = 2
[[input]]
name = "E"
keys = ["case.material.am.youngs_modulus_GPa"]
low = 100
high = 300
T
status=0
"$bin/calendem" bank "$work/bank.toml" -o "$work/bank" --liggghts "$(type -P false)" >"$work/bank.log" 2>&1 || status=$?
[ $status = 3 ] || { cat "$work/bank.log"; fail "exit status $status of a bank whose runs fail"; }

# Pressed again, more breaks and the film is denser: two compressions and two releases in one curve. The film that is pressed once
# is that run which was asked for twice.
sed 's/^keys = \["recipe.seed"\]/keys = ["case.platen.presses"]/; s/^values = \[150, .*/values = [150]/' "$work/study.toml" >"$work/again.toml"
"$bin/calendem" study "$work/again.toml" -o "$work/same" --jobs 2 >"$work/again.log" 2>&1 || { cat "$work/again.log"; fail "a film that is pressed again"; }
grep -q "2 runs, 1 of them done already" "$work/again.log" || { cat "$work/again.log"; fail "a run that another study made was made again"; }
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next } { broken[NR] = $at["broken_fraction_after"]; porosity[NR] = $at["porosity_after_relaxation"] }
  END { exit !(broken[3] > broken[2] && porosity[3] < porosity[2]) }' "$work/same/study.csv" || { cat "$work/same/study.csv"; fail "the second time did nothing"; }
for presses in 1 2; do
  run=$(awk -F, -v n=$presses 'NR == n + 1 { print $3 }' "$work/same/study.csv")
  turns=$(awk -F, 'NR > 2 && $2 == "relaxation" && was != $2 { n++ } { was = $2 } END { print n }' "$work/same/runs/$run/curve.csv")
  [ "$turns" = "$presses" ] || fail "$turns releases of $presses"
done
