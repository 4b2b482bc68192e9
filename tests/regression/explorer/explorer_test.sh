#!/usr/bin/env bash
# explorer_test.sh BIN RUN WORK: opens the report of RUN in headless Chromium at one body and compares the bonds
# drawn with bodies.csv. Needs chromium (Debian's package; with software OpenGL).
set -euo pipefail
bin=$1 run=$2 work=$3
fail() { echo "FAILED: $*" >&2; exit 1; }
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "skipped: no chromium"; exit 77; }
mkdir -p "$work"
"$bin/calendem" report "$run" -o "$work/report.html"
# the most broken body
row=$(tail -n +2 "$run/bodies.csv" | sort -t, -k4,4nr | head -n 1)
body=$(cut -d, -f1 <<<"$row") bonds=$(cut -d, -f3 <<<"$row") broken=$(cut -d, -f4 <<<"$row")
[ "$broken" -gt 0 ] || fail "no body of this run has a broken bond"
"$browser" --headless --no-sandbox --use-gl=swiftshader --enable-unsafe-swiftshader --ignore-gpu-blocklist \
  --user-data-dir="$work/profile" --virtual-time-budget=10000 --dump-dom \
  "file://$work/report.html#moment=2&body=$body" >"$work/dom.html" 2>"$work/browser.log"
view=$(grep -o '<div class="panel view"[^>]*>' "$work/dom.html") || fail "the page has no view"
echo "$view; bodies.csv: $row"
for word in "data-body=\"$body\"" 'data-moment="2"' "data-bonds=\"$bonds\"" "data-broken=\"$broken\""; do
  grep -qF -- "$word" <<<"$view" || fail "the view lacks $word"
done
