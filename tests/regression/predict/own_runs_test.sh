#!/usr/bin/env bash
# own_runs_test.sh BIN CASES WORK: a film that the bank has not, and what is proposed, are simulated; with
# CALENDEM_HEAVY=1 also a gap under a roll, and the films of a calibration.
samples=128
# shellcheck source=tests/regression/predict/calibrated.sh
source "$(dirname "${BASH_SOURCE[0]}")/calibrated.sh"

# A film of another kind is predicted by runs of its own, which are there the second time.
cat >other.toml <<'END'
name = "other"
[coating]
loading_mg_cm2 = 4
porosity_total_percent = 50
[particles]
sigma_ln = 0.3
[cell]
x_um = 6
y_um = 6
END
refuses "or predict it by runs of its own (--runs)" predict model/model.json other.toml
refuses "one by one" predict model/model.json other.toml --runs 4
{ echo 'material = "xu2023"'; cat other.toml; } >lattice.toml
refuses 'particles.grains is "lattice"' predict model/model.json lattice.toml --pressure 10,60 --runs 4
refuses "without --vary" predict model/model.json other.toml --runs 4 --pressure 10,30 --vary porosity_before_percent=40
refuses "two or more to --pressure" predict model/model.json other.toml --runs 4 --pressure 30 --press-percent 5
by_runs() { calendem predict model/model.json other.toml --pressure 10,60 --runs 4 --jobs 2 -o own; }
by_runs
cp own/prediction.csv first.csv
by_runs >again.log
grep -q "8 runs, 8 of them done already" again.log || fail "runs were made twice"
cmp first.csv own/prediction.csv || fail "the same runs gave another prediction"
grep -q '"runs": 4' own/prediction.json || fail "it is not said that runs predict"
grep -q "from 4 simulations at each pressure" own/prediction.html || fail "the page does not say that runs predict"
awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
  { p = $at["porosity_after_percent_median"]; if (!(p > 20 && p < 50) || (NR > 2 && p >= last)) exit 1; last = p }' \
  first.csv || fail "own/prediction.csv: more pressure leaves less, below 50 %"

# These runs choose between the pressures: each is proposed for the porosity that it leaves, within what four draws of
# the material differ by.
left() { awk -F, -v row="$1" 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next } NR == row + 1 { print $at["porosity_after_percent_median"] }' first.csv; }
calendem design model/model.json other.toml --porosity "$(left 1)" --within 4 --pressure 10,60 --runs 4 --jobs 2 -o own | tee own_design.log
grep -q "8 runs, 8 of them done already" own_design.log || fail "design made the runs again"
grep -q "^other: 10 MPa meets the target with" own_design.log || fail "not the pressure is proposed that leaves the porosity"
calendem design model/model.json other.toml --porosity "$(left 2)" --within 4 --pressure 10,60 --runs 4 -o own | grep "^other: 60 MPa meets the target with" ||
  fail "the larger pressure is not proposed for the smaller porosity"
sed '/<script type="application.json" id="data">/,$d' own/design.html | grep "From 4 simulations at each pressure" >/dev/null || fail "the page does not say that runs choose"
refuses "one by one" design model/model.json other.toml --porosity 38 --runs 4
refuses "not of the bank's kind" design model/model.json other.toml --porosity 38

# A proposal is run: it meets its target about as surely as was proposed, within the scatter of four runs of so small a cell.
sed 's/^sigma_ln.*/sigma_ln = 0.487/' other.toml >small.toml
calendem design model/model.json small.toml --porosity 38 --within 3 --pressure 20,25 --confirm 4 --jobs 2 -o confirmed | tee confirmed.log
grep -q "run 4 times, each with another draw of the material on another packing: it meets the target with" confirmed.log ||
  fail "the proposal was not run"
grep -q '"confirmed": \[' confirmed/design.json || fail "design.json does not hold what was run"
sed '/<script type="application.json" id="data">/,$d' confirmed/design.html | grep "4 runs: .* %, porosity" >/dev/null || fail "the page does not show what was run"
grep -q '"tortuosity_through_plane": {' own/prediction.json || fail "runs of their own are not measured"
refuses "--confirm runs recipes as they are" design model/model.json small.toml --porosity 38 --confirm 4 --vary porosity_before_percent=44
refuses "whole numbers from 1 to 20" design model/model.json small.toml --porosity 38 --gap 13 --confirm 4 --passes 1.5
refuses "values of --gap one by one" predict model/model.json small.toml --gap 12:14 --runs 4
[ "${CALENDEM_HEAVY:-0}" = 1 ] || exit 0

# So is a gap, under a roll in two passes. One packing of ten micrometres scatters by 0.75 points, of six by 1.25, the median of
# four by 0.7: three points are four standard deviations.
calendem design model/model.json small.toml --porosity 38 --within 3 --gap 13,14,15 --confirm 4 --passes 2 --jobs 2 -o by_gap | tee by_gap.log
grep -q "^other: 14.0 um meets the target with" by_gap.log || fail "not the gap is proposed that leaves 38 %"
awk '/porosity/ { for (k = 1; k < NF; ++k) if ($k == "porosity") p[++n] = $(k + 1) } END { exit !(n == 2 && (p[1] - p[2]) ^ 2 < 9) }' \
  by_gap.log || fail "the roll leaves another porosity"
grep -q "run 4 times in 2 passes under the roll" by_gap.log || fail "the gap was not run"
grep -q '"passes": 2' by_gap/design.json || fail "design.json does not hold the passes"
grep -q "Which gap gives" by_gap/design.html || fail "the page does not ask for a gap"
# These runs, which are there, make a prediction. No emulator: the bank has not this film.
calendem predict model/model.json small.toml --gap 14 --runs 4 --passes 2 --jobs 2 -o by_gap >gap_runs.log || { cat gap_runs.log; fail "predict --gap --runs"; }
grep -q "4 runs, 4 of them done already" gap_runs.log || fail "the roll's runs were made twice"
grep -q '"runs": 4' by_gap/gap.json || fail "it is not said that runs predict at a gap"
grep -q "from 4 simulations under a roll at each gap" by_gap/gap.html || fail "the page does not say that runs predict at a gap"

# A calibration runs its films again: simulated beside emulated.
cat >pressed.toml <<'END'
[experiment]
name = "pressed"
electrode = "small.toml"
[[condition]]
id = "p025"
control = "pressure"
max_pressure_MPa = { value = 25, sd_relative = 0.05 }
porosity_after_percent = { value = 38, sd = 0.5 }
END
calendem calibrate pressed.toml -o small --samples 512 --confirm 4 --jobs 2 --bank "$cases/films/bank.toml" | tee small.log
grep -q "pressed .* 25 MPa  measured 38.0, 4 runs .* emulators .*: off by .* ±" small.log || fail "the film was not run again"
grep -q '"emulated":' small/model.json || fail "model.json does not hold what was run"
grep -q "Run again" small/model.html || fail "the page does not show what was run"
