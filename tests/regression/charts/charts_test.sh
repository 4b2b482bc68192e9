#!/usr/bin/env bash
# charts_test.sh BIN MAKE_RUN WORK: a report of two made-up runs in headless Chromium, worked on by use.js, which checks
# what it sees. Needs chromium (Debian's package).
set -euo pipefail
bin=$1 make_run=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "skipped: no chromium"; exit 77; }
rm -rf "$work"
mkdir -p "$work"
"$make_run" "$work/one"
"$make_run" "$work/other" strong
"$bin/calendem" report "$work/one" "$work/other" -o "$work/report.html" >"$work/report.log"
# The first value of each series is taken away: a gap.
{
  sed -E '/id="data"/s/"y":\[[^],]+/"y":[null/g; s/<\/html>$//' "$work/report.html"
  echo "<script>"
  cat "$here/use.js"
  echo "</script></html>"
} >"$work/used.html"
for width in 1200 500; do
  "$browser" --headless --no-sandbox --disable-3d-apis --user-data-dir="$work/profile" --window-size="$width,900" \
    --virtual-time-budget=20000 --dump-dom "file://$work/used.html" >"$work/dom.html" 2>"$work/browser.log"
  sed -n '/^<pre id="result">/,/<\/pre>/p' "$work/dom.html"
  grep -q '^charts: as they should be' "$work/dom.html" ||
    { echo "FAILED at a width of $width: see $work/dom.html" >&2; exit 1; }
done
