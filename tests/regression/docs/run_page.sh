#!/usr/bin/env bash
# run_page.sh PAGE BIN WORK: the commands of a page of docs/, typed as they stand there, in a copy of the tree. Every
# block of shell must succeed, and print the lines of the block of text that follows it: a number stands for one that
# differs by a fifth or by one in its last digit at most (breakage is chaotic, and processors round differently), … for anything. A block that begins with "# takes" is long: it is run with CALENDEM_HEAVY only.
set -euo pipefail
page=$1 bin=$(cd "$2" && pwd) work=$3
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
fail() { echo "FAILED: $*" >&2; exit 1; }
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
export LC_ALL=C.UTF-8 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none

rm -rf "$work"
mkdir -p "$work/tree/build" "$work/blocks"
cp -r "$top"/{CMakeLists.txt,CMakePresets.json,src_plugin,tools,input_scripts,patches,docs,tests} "$work/tree"
mkdir -p "$work/tree/build/bin" "$work/tree/build/share/calendem"
ln -s ../../../input_scripts "$work/tree/build/share/calendem"
cp "$bin"/{liggghts,calendem,calendem-films} "$work/tree/build/bin" # a page may build its own
[ -z "${CALENDEM_HEAVY:-}" ] || cp -r "$bin/../host" "$work/tree/build"
awk -v to="$work/blocks/" '
  /^```/ && kind != "" { kind = ""; close(file); next }
  /^```sh$/ { kind = "sh"; file = sprintf("%s%02d.sh", to, ++n); printf "" >file; next }
  /^```text$/ && n { kind = "text"; file = sprintf("%s%02d.text", to, n); next }
  /^```/ { kind = "other"; next }
  kind == "sh" || kind == "text" { print >file }' "$top/docs/$page.md"

as_pattern() { # a line of the page, as a regular expression that captures its numbers
  sed -E 's/[][\.*^$+?(){}|]/\\&/g; s/[−-]?[0-9]+(\\\.[0-9]+)?(e(\\\+|[−-])?[0-9]+)?/([−+-]*[0-9.]+(e[-+]?[0-9]+)?)/g; s/…/.*/g; s/ +/ +/g'
}
is_printed() { # LINE OUTPUT: a line of the output has the words of the page's, and its numbers
  local pattern shown found numbers k
  pattern=$(as_pattern <<<"$1")
  mapfile -t shown < <(grep -oE '[−-]?[0-9]+(\.[0-9]+)?(e[−+-]?[0-9]+)?' <<<"$1")
  while IFS= read -r found; do
    [[ $found =~ $pattern ]] || continue
    numbers=""
    for k in "${!shown[@]}"; do numbers+="${shown[k]} ${BASH_REMATCH[2 * k + 1]}"$'\n'; done
    sed 's/−/-/g; /^$/d' <<<"$numbers" | awk '
      { a = $1; b = $2; unit = 1; if (match(a, /\.[0-9]+/) && a !~ /e/) unit = 10 ^ (1 - RLENGTH)
        d = a - b; m = a * a > b * b ? a * a : b * b
        if (d * d > 1.001 * unit * unit && d * d > 0.04 * m) exit bad = 1 }
      END { exit bad }' && return 0
    echo "  differs: $found" >&2
  done < <(grep -E -- "$pattern" "$2" || true)
  return 1
}
cd "$work/tree"
for block in "$work"/blocks/*.sh; do
  [ -f "$block" ] || fail "$page.md has no commands"
  if head -n 1 "$block" | grep -q '^# takes' && [ -z "${CALENDEM_HEAVY:-}" ]; then
    echo "== left out: $(head -n 1 "$block")"
    continue
  fi
  echo "== $(grep -v '^#' "$block" | head -n 1)"
  bash -euo pipefail "$block" >"$work/said" 2>&1 </dev/null || { cat "$work/said"; fail "$page.md: $(cat "$block")"; }
  cat "$work/said"
  [ ! -f "${block%.sh}.text" ] || while IFS= read -r line; do
    is_printed "$line" "$work/said" || fail "$page.md shows a line that was not printed: $line"
  done <"${block%.sh}.text"
done
