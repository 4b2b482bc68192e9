#!/usr/bin/env bash
# hidden_causes_test.sh CALENDEM: the twenty cases can be read, their models have wrong what truths.csv says, and the
# score is that of the page; the truth gets all points, silence those of faultless models. The forty cases of another code
# can be read, their score is that of their page, and three are answered as stored. Exit status 0 passed, 1 failed.
set -euo pipefail
calendem=$1
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
cd "$top/input_scripts/cases/hidden_causes"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

"$calendem" validate case_*/experiment.toml case_*/model.toml || fail "a case cannot be read"
while IFS=, read -r case _ _ changes _; do
  for change in $(tr -d + <<<"${changes/no /no_}"); do
    if grep -q "# ${change#no_} acts" "$case/model.toml"; then found=no_${change#no_}; else found=${change#no_}; fi
    [ "$found" = "$change" ] || fail "the model of $case does not have $change wrong"
  done
done < <(sed 1d truths.csv)
[ "$(sed 1d truths.csv | cut -d, -f1)" = "$(ls -d case_*)" ] || fail "cases and truths differ"

points() { ./score truths.csv "$1" | awk 'NR > 1 && $(NF - 7) == "all" { print $NF }'; }
sed -n '/\.\/score /,/^```/p' "$top/docs/validation/hidden_causes.md" | sed '1d;$d' >"$work/stated"
./score truths.csv our_answers.csv | grep -E '^(method|diagnose)' | diff "$work/stated" - || fail "the page states another score"
sheet() { (echo case,method,answer,named; cat) >"$work/sheet.csv"; }
awk -F, 'NR > 1 { print $1 ",truth," ($4 == "" ? "nothing," : "explained," $4) }' truths.csv | sheet
[ "$(points "$work/sheet.csv")" = 20.00 ] || fail "the truth gets $(points "$work/sheet.csv") points"
echo case_01,silence,nothing, | sheet
[ "$(points "$work/sheet.csv")" = "$(grep -c ,none, truths.csv).00" ] || fail "silence gets $(points "$work/sheet.csv") points"
awk -F, 'NR > 1 { print $1 ",wrong,explained,noise" }' truths.csv | sheet
[ "$(points "$work/sheet.csv")" = -20.00 ] || fail "wrong claims get $(points "$work/sheet.csv") points"
refuses() { # ROW WORDS
  local status=0
  echo "$1" | sheet
  ./score truths.csv "$work/sheet.csv" >"$work/said" 2>&1 || status=$?
  [ $status -eq 2 ] || fail "'$1' ends with $status"
  grep -qF "$2" "$work/said" || fail "'$1' gives: $(cat "$work/said")"
}
refuses case_21,mine,nothing, 'no case "case_21"'
refuses case_01,mine,explain,friction 'the answer is "explain"'
refuses case_01,mine,nothing,friction "names belong to"
refuses case_01,mine,nothing "3 columns"
refuses $'case_01,mine,nothing,\ncase_01,mine,explained,friction' "answered twice"

cd "$top/input_scripts/cases/other_code"
"$calendem" validate ./*/experiment.toml model.toml || fail "a case of another code cannot be read"
[ "$(sed 1d truths.csv | cut -d, -f1)" = "$(ls -d case_*)" ] || fail "cases of another code and truths differ"
sed -n '/hidden_causes\/score /,/^```/p' "$top/docs/validation/other_code.md" | sed '1d;$d' >"$work/stated"
../hidden_causes/score truths.csv our_answers.csv unknown.csv | diff "$work/stated" - || fail "the page states another score"
mkdir "$work/three"
cp -r film.toml model.toml case_01 case_20 case_36 "$work/three" # no cause, friction, compliance of the press
../hidden_causes/answer "$calendem" "$work/three" "$work/answers" || fail "answer ends with $?"
grep -E '^case_(01|20|36),' our_answers.csv | diff - <(sed 1d "$work/answers/answers.csv") || fail "three cases are answered otherwise"
echo "score: as stated"
