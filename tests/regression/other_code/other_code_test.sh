#!/usr/bin/env bash
# other_code_test.sh BIN WORK: cases of input_scripts/cases/other_code give the claims of its results.csv; all of them
# with CALENDEM_HEAVY=1, ten minutes, else two. What the page counts is what the file holds.
set -euo pipefail
bin=$1 work=$2
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
cases=$top/input_scripts/cases/other_code
page=$top/docs/validation/other_code.md
fail() { echo "FAILED: $*" >&2; exit 1; }
some=(case_01 case_36)
[ "${CALENDEM_HEAVY:-0}" = 1 ] && some=()
rm -rf "$work"
mkdir -p "$work"
bash "$cases/diagnose_cases.sh" "$bin/calendem" "$work" "${some[@]}"
while IFS=, read -r name cause amount claim answer; do
  grep -qx "$name,$cause,$amount,$claim,$answer" "$cases/results.csv" || fail "$name: $claim ($answer) is not what results.csv says"
done < <(tail -n +2 "$work/results.csv")
count() { grep -c "$1" "$cases/results.csv" || true; }
[ "$(count '^case_')" -eq "$(($(wc -l <"$cases/cases.csv") - 2))" ] || fail "results.csv lacks cases"
for cause in $(tail -n +3 "$cases/cases.csv" | cut -d, -f2 | sort -u); do
  all=$(count "^case_[0-9]*,$cause,")
  named=$(count "^case_[0-9]*,$cause,[^,]*,$cause,")
  grep -q "^| \`$cause\` .*| $all | $named |" "$page" || fail "the page has not: $cause: $all cases, $named named"
done
