#!/usr/bin/env bash
# The whole chain of the paper's Figure 2 on a small cell: shapes, slurry, drying, electrode, calendering, report.
#   input_scripts/cases/chain/run.sh [-o OUT] [--recipes DIR] [--ranks N] [--bin DIR]
# -o: everything goes there (default build/chain).  --recipes: folder with tomogram.toml, film.toml and case.toml
# (default: that of this script).  --ranks: of pack and run (default 2); slurry and drying take one.
# One to three minutes on 2 cores. A step that is done is not done again; after a stop, start it again.
# Exit status: 0 done, otherwise that of the step that failed (2 bad input, 3 simulation, 4 a target was missed).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../../.." && pwd)
out=$top/build/chain recipes=$here ranks=2 bin=$top/build/bin
while [ $# -gt 0 ]; do
  case $1 in
    --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -o | --recipes | --ranks | --bin)
      [ -n "${2:-}" ] || { echo "run.sh: $1 lacks its value (see --help)" >&2; exit 1; }
      case $1 in -o) out=$2 ;; --recipes) recipes=$2 ;; --ranks) ranks=$2 ;; --bin) bin=$2 ;; esac
      shift ;;
    *) echo "run.sh: unknown option '$1' (see --help)" >&2; exit 1 ;;
  esac
  shift
done
for file in tomogram film case; do
  [ -r "$recipes/$file.toml" ] || { echo "run.sh: $recipes/$file.toml is not there; --recipes names the folder" >&2; exit 2; }
done
[ -x "$bin/calendem" ] || { echo "run.sh: $bin/calendem is not there: build with tools/build, or name its folder with --bin" >&2; exit 2; }
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi

mkdir -p "$out"
for file in tomogram film case; do # a copy that did not change keeps its time
  cmp -s "$recipes/$file.toml" "$out/$file.toml" || cp "$recipes/$file.toml" "$out/$file.toml"
done
cd "$out"
times=() number=0
step() { # NAME COMMAND...
  local name=$1 begin=$SECONDS status=0
  shift
  number=$((number + 1))
  printf '\n== %d of 5: %s\n' $number "$name"
  "$@" || status=$?
  times+=("$(printf '  %-30s %4d s' "$name" $((SECONDS - begin)))")
  [ $status -eq 0 ] || { echo "run.sh: step '$name' failed (exit status $status); the lines above say why. Mend it and start again: what is done stays" >&2; exit $status; }
}
shapes() {
  if [ nmc.mhd.done -nt tomogram.toml ]; then echo "nmc.mhd is there already"; return; fi
  "$bin/calendem" tomogram tomogram.toml -o nmc.mhd && touch nmc.mhd.done
}
press() {
  local how=()
  [ ! -e run/case.toml ] || how=(--resume)
  "$bin/calendem" run case.toml -o run --ranks "$ranks" "${how[@]}"
}
"$bin/calendem" validate tomogram.toml case.toml
step "shapes (tomogram)" shapes
step "slurry and drying" "$bin/calendem" dry film.toml -o film
step "electrode of the film" "$bin/calendem" pack film/electrode.toml -o electrode --ranks "$ranks"
step "calendering" press
step "report" "$bin/calendem" report run -o report.html

figure() { sed -n "s/^ *\"$2\": \([-0-9.e]*\),\{0,1\}$/\1/p" "$1" | head -n 1; }
percent() { LC_ALL=C printf '%.2f' "$(figure "$1" "$2")e2"; }
printf '\n== done in %d s\n' $SECONDS
printf '%s\n' "${times[@]}"
printf '  total porosity, %%: recipe %s, dried film %s, electrode %s, after calendering %s\n' \
  "$(percent film/film.json porosity_recipe)" "$(percent film/film.json porosity_total)" \
  "$(percent electrode/electrode.json porosity_total)" "$(percent run/summary.json porosity_after_relaxation)"
printf '  particles: slurry %s AM and %s CBD spheres, electrode %s bodies and %s CBD spheres\n' \
  "$(figure film/film.json am)" "$(figure film/film.json cbd)" \
  "$(figure electrode/electrode.json bodies)" "$(figure electrode/electrode.json cbd)"
echo "  report   $out/report.html"
echo "  pictures $out/film/slurry.vtp and dried.vtp, $out/run/vtk (open with ParaView)"
