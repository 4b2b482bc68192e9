#!/usr/bin/env bash
# sealed_test.sh BIN WORK: four truths, one of them a change between two experiments, are made, answered where none
# of them can be read, and scored. Runs with CALENDEM_HEAVY=1; on made-up tables the same is tested in unit/sealed.
set -euo pipefail
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: sealed.small runs with tools/test --all"; exit 77; }
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
names() { find "$1" -mindepth 1 -maxdepth 1 ! -name .lock -printf '%f\n' | LC_ALL=C sort | paste -sd,; } # FOLDER
refused() { # STATUS TEXT COMMAND...: that exit status and these words
  local status=0 want=$1 text=$2
  shift 2
  "$@" 2>"$work/said" || status=$?
  cat "$work/said"
  [ $status -eq "$want" ] || fail "exit status $status, expected $want: $*"
  grep -qF "$text" "$work/said" || fail "no '$text' in the message"
}
answer() { "$bin/sealed" answer "$1" -o "$2" --bank "$here/bank.toml" --rerun 2; }

rm -rf "$work"
mkdir -p "$work"
cat >"$work/round.toml" <<T
[round]
name = "four truths"
bank = "$here/bank.toml"
null_packings = 1
null_draws = 2
amplitudes = 0
samples = 2
paired_runs = "yes"
open = ["displacement_scale"]
faults = ["friction + noise"]
interventions = ["friction"]
T
cases=001,002,003,004,005
# A seed: a truth drawn at random may be one that no platen can press to its pressure, and is left out then.
make_round() { "$bin/sealed" make "$work/round.toml" -o "$work/round" --seed 1; }
make_round
[ "$(names "$work/round/handed_out")" = $cases,commitment.json ] || fail "not the cases of the round"
changed=$(cd "$work/round/handed_out" && echo */after)
changed=${changed%/after} # the case in which something changed
[ "$(names "$work/round/handed_out/$changed")" = after,before ] || fail "not one pair of experiments"
# Before the change other packings are pressed, without the friction that comes with it.
friction_on() { # SEEDS: how many runs have which friction on these packings of that case
  awk -F, -v list="\"$1\": [" '
    FNR == NR { if (/"block"/) mine = /intervention/
                if (/]/) on = 0
                if (on) { gsub(/[ ,]/, ""); seed[$0] }
                if (mine && index($0, list)) on = 1
                next }
    FNR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
    $at["recipe.seed"] in seed { ++runs[$at["case.material.am.friction"]] }
    END { for (value in runs) print runs[value] " of " value }' "$work/round/sealed/truth.json" "$work/round/sealed/study/study.csv"
}
drawn=$(sed -n '/"block": "intervention"/,/"packing_seeds"/s/^ *"friction": //p' "$work/round/sealed/truth.json")
[ "$(friction_on packing_seeds_before)" = "4 of 0.001" ] || fail "before the change: $(friction_on packing_seeds_before)"
[ "$(friction_on packing_seeds)" = "4 of $drawn" ] || fail "with a friction of $drawn: $(friction_on packing_seeds)"

# What is handed out reveals nothing: no name, seed, salt or hash of the truth, and of the runs.
{ "$bin/calendem" effects | awk '/^[a-z]/ { print $1 }'
  printf '%s\n' displacement_scale unknown noise null fault '"open"' intervention sealed
  grep -oE '"(salt|handed_out_sha256)": "?[0-9a-f]+' "$work/round/sealed/truth.json" | grep -oE '[0-9a-f]+$'
  sed -n '/"packing_seeds[^]]*$/,/]/p' "$work/round/sealed/truth.json" | grep -oE '[0-9]{4,}'
  cat "$work/round/sealed/secret" && echo
  find "$work/round/sealed/study" -maxdepth 2 -type d -printf '%f\n' | grep -E '^[0-9a-f]{16}$'
} | sort -u >"$work/words"
[ "$(wc -l <"$work/words")" -gt 30 ] || fail "the list of what must stay secret is short"
if grep -rnFf "$work/words" "$work/round/handed_out"; then fail "what is handed out reveals the truth"; fi
if find "$work/round/handed_out" -printf '%P\n' | grep -Ff "$work/words"; then fail "a name reveals the truth"; fi

refused 2 "truths lie within reach" answer "$work/round/handed_out" "$work/answers"
mkdir "$work/given"
cp -r "$work/round/handed_out" "$work/given/copy"
mv "$work/round" "$work/away" # the truths are out of reach
answer "$work/given/copy" "$work/answers" | tee "$work/answer.log"
[ "$(names "$work/answers")" = $cases,answers.json ] || fail "not every case was answered"
mv "$work/away" "$work/round"
"$bin/sealed" answer "$work/given/copy" -o "$work/again" --bank "$here/bank.toml" >/dev/null
diff -r -x shrink.json -x rerun -x answers.json "$work/answers" "$work/again" || fail "the same data got another answer"
list() { grep -v shrink.json "$1/answers.json" | tr -d ,; }
diff <(list "$work/answers") <(list "$work/again") || fail "the same answers got another list of hashes"
grep -q "\"change_from\": \"case $changed, before\"" "$work/answers/$changed/gap.json" || fail "case $changed is not answered as a change"
for k in ${cases//,/ }; do # models are run again where an effect is claimed, and are sealed with the answers
  [ -e "$work/answers/$k/shrink.json" ] && again=yes || again=no
  grep -m 1 '"claim"' "$work/answers/$k/gap.json" | grep -qE '"(none|noise|unknown|undecided)"' && effect=no || effect=yes
  [ "$k" != "$changed" ] || effect=no # not of a change
  [ "$again" = "$effect" ] || { [ "$effect" = yes ] && grep -q "case $k could not be run again" "$work/answer.log"; } ||
    fail "case $k names an effect: $effect, was run again: $again"
  [ "$again" = no ] || grep -q "\"$k/shrink.json\"" "$work/answers/answers.json" || fail "no hash of $k/shrink.json"
done

score() { "$bin/sealed" score "$work/round" "$work/answers" -o "$work/scores" --bank "$here/bank.toml"; }
score
grep -q '"paired": true' "$work/scores/scores.json" || fail "the keeper's paired runs were not used"
for file in scores.json scores.md scores.html; do [ -s "$work/scores/$file" ] || fail "no $file"; done
grep -q "false claims on nulls | .* | 2 | 1 | ≤ 0.03" "$work/scores/scores.md" || fail "two draws of one null packing are not counted as one truth"
grep -qF "| intervention: the 95 % set holds the truth | 1.000 |" "$work/scores/scores.md" || fail "the change is not among what may have changed"

pair=$(find "$work/round/sealed/without_cause" -name experiment.toml | head -n 1)
cp "$pair" "$work/pair"
sed -i 's/porosity/prosity/' "$pair"
refused 4 "without its cause is not what its hash says" score
cp "$work/pair" "$pair"
cp "$work/round/handed_out/$changed/before/p30.csv" "$work/before.csv"
sed -i '$d' "$work/round/handed_out/$changed/before/p30.csv"
refused 4 "what was handed out of case $changed is not what its hash says" score
cp "$work/before.csv" "$work/round/handed_out/$changed/before/p30.csv"

# Called again, the command makes nothing, and hands out the same.
make_round >"$work/again.log"
grep -q "24 runs, 24 of them done already" "$work/again.log" || fail "runs were made twice"
diff -r "$work/round/handed_out" "$work/given/copy" || fail "another round was handed out"

sed -i 's/"claim": "[a-z]*/&!/' "$work/answers/002/gap.json"
refused 4 "the answer 002/gap.json is not what its hash says" score
