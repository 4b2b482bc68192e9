#!/usr/bin/env bash
# valgrind.sh WORK BIN: everything the plugin has, once (valgrind/in.memory), under valgrind's memcheck on one rank and
# on two, and the decks of some tests of BIN; fails when the program's own code reads or writes where it must not, or
# uses what was never set. Errors inside MPI's libraries alone do not count. Runs with CALENDEM_HEAVY=1; builds a
# program for it in WORK, because valgrind does not know every instruction of -march=native.
set -euo pipefail
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: builds.valgrind runs with tools/test --all"; exit 77; }
command -v valgrind >/dev/null || { echo "skipped: no valgrind; tools/install-dependencies --test brings it"; exit 77; }
mkdir -p "$1"
work=$(cd "$1" && pwd) here=$(cd "$(dirname "${BASH_SOURCE[0]}")/valgrind" && pwd)
top=$(cd "$here/../../../.." && pwd)
host=${CALENDEM_HOST_DIR:-$top/build/host}
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi

cmake -S "$top" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-g -O1" \
  -DCALENDEM_TUNE=OFF -DCALENDEM_HOST_DIR="$host" >"$work/configure.log"
cmake --build "$work/build" --target liggghts >"$work/build.log" || { tail "$work/build.log"; exit 1; }
check=(valgrind --track-origins=yes --num-callers=30)
for list in "$(ompi_info --path pkgdatadir --parsable 2>/dev/null | cut -d: -f3)/openmpi-valgrind.supp" \
  /usr/share/openmpi/openmpi-valgrind.supp; do
  if [ -f "$list" ]; then check+=("--suppressions=$list"); break; fi
done

# Paragraphs of valgrind's log with a frame in a source of the host or the plugin.
our_errors() { # LOG...
  sed 's/^==[0-9]*== \{0,1\}//' "$@" | awk -v RS= -v src="$host/src/" '
    function is_ours(file) { return !system("test -f " src file " -o -f " src "physics/" file) }
    /(^|\n) +(at|by) 0x/ {
      rest = $0; ours = 0
      while (!ours && match(rest, /\([a-z0-9_]+\.(cpp|h):[0-9]+\)/)) {
        split(substr(rest, RSTART + 1, RLENGTH - 2), place, ":")
        ours = is_ours(place[1])
        rest = substr(rest, RSTART + RLENGTH)
      }
      if (ours) print $0 "\n"
    }'
}
failed=0
for ranks in 1 2; do
  run=$work/$ranks
  rm -rf "$run"
  mkdir -p "$run"
  (cd "$run" && mpirun --oversubscribe -np $ranks "${check[@]}" --log-file=valgrind.%p.txt \
    "$work/build/bin/liggghts" -in "$here/in.memory" -var here "$here" >said.txt 2>&1) || true
  our_errors "$run"/valgrind.*.txt >"$run/errors.txt"
  echo "$ranks ranks: $(awk -v RS= 'END { print NR }' "$run/errors.txt") errors of the program's own; in all" \
    "$(grep -h 'ERROR SUMMARY' "$run"/valgrind.*.txt | sed 's/.*SUMMARY: //' | paste -sd';')"
  [ ! -s "$run/errors.txt" ] || { cat "$run/errors.txt"; failed=1; }
  grep -q '^END' "$run/said.txt" || { tail "$run/said.txt"; echo "FAILED: the run on $ranks ranks did not end"; exit 1; }
  [ "$(wc -l <"$run/breaks.csv")" -gt 5 ] || { echo "FAILED: too few breaks to show anything"; exit 1; }
done
# The decks of other tests: their programs start this in the place of liggghts.
decks=$work/decks
rm -rf "$decks"
mkdir -p "$decks"
printf '#!/bin/sh\nexec %s --log-file=%s/valgrind.%%p.txt %s "$@"\n' "${check[*]}" "$decks" "$work/build/bin/liggghts" \
  >"$work/liggghts"
chmod +x "$work/liggghts"
for test in host_styles between_runs lost_bonds same_physics verification; do
  case $test in
    same_physics) only='*.RestartInMidDamage*:*.RebuildingEveryStep*' ;;
    verification) only='VerificationTypes.*:VerificationUnits.*' ;;
    *) only='*' ;;
  esac
  CALENDEM_LIGGGHTS=$work/liggghts "$2/${test}_test" --gtest_filter="$only" >"$decks/$test.txt" 2>&1 ||
    { grep -E 'FAILED|Failure' "$decks/$test.txt"; failed=1; }
done
our_errors "$decks"/valgrind.*.txt >"$decks/errors.txt"
echo "decks: $(find "$decks" -name 'valgrind.*' | wc -l) processes," \
  "$(awk -v RS= 'END { print NR }' "$decks/errors.txt") errors of the program's own"
[ ! -s "$decks/errors.txt" ] || { cat "$decks/errors.txt"; failed=1; }
[ $failed -eq 0 ] || { echo "FAILED: see above"; exit 1; }
