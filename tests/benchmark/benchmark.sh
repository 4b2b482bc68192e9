#!/usr/bin/env bash
# One benchmark: benchmark.sh lattice|ranks|memory BIN WORK [REPEATS]; writes WORK/CASE.csv.
# lattice: cost of contact and bond over the host's contact alone.  ranks: 2 ranks over 1 on the demo
# cell.  memory: resident size early and late in 1e5 steps.  The last two run with CALENDEM_HEAVY=1.
set -euo pipefail
case=$1 bin=$2 work=$3 repeats=${4:-$((${CALENDEM_HEAVY:-0} == 1 ? 5 : 2))}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scripts=$(cd "$here/../../input_scripts" && pwd)
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
fail() { echo "FAILED: $*" >&2; exit 1; }
loop_time() { sed -n 's/^Loop time of \([0-9.e+-]*\) on.*/\1/p' "$1" | tail -n 1; }
heavy() { [ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: benchmark.$case runs with tools/test --all"; exit 77; }; }
electrode() { "$bin/calendem" pack "$scripts/cases/studies/electrode.toml" -o "$work/electrode" --force >"$work/pack.log"; }
press() { # RANKS LOG VAR...: the demo's electrode, compressed from the packing for some steps
  local ranks=$1 log=$2
  shift 2
  (cd "$work" && mpirun -np "$ranks" "$bin/liggghts" -in "$here/in.steps" -log "$log" -screen none \
    -var scripts "$scripts" -var electrode "$work/electrode" -var out "$work" "$@")
}

bin=$(cd "$bin" && pwd)
mkdir -p "$work"
work=$(cd "$work" && pwd)
case $case in
  lattice)
    seq -f '%.0f 1' 10648 >"$work/bodies.map"
    echo "repeat,stock_s,bonded_s,ratio,ns_per_bond_step" >"$work/lattice.csv"
    for repeat in $(seq "$repeats"); do
      for bonded in 0 1; do
        (cd "$here/lattice" && mpirun -np 1 "$bin/liggghts" -in in.lattice -screen none \
          -log "$work/lattice_$bonded.log" -var bonded $bonded -var map "$work/bodies.map")
      done
      made=$(sed -n 's/^bonds made and intact: //p' "$work/lattice_1.log")
      [ "$made" = "30492 30492" ] || fail "bonds made and intact: '$made', 3 x 22 x 22 x 21 = 30492 expected"
      awk -v r="$repeat" -v a="$(loop_time "$work/lattice_0.log")" -v b="$(loop_time "$work/lattice_1.log")" \
        'BEGIN { printf "%d,%g,%g,%.3f,%.1f\n", r, a, b, b / a, (b - a) / 800 / 30492 * 1e9 }' |
        tee -a "$work/lattice.csv"
    done
    awk -F, 'NR > 1 { if (!a || $2 < a) a = $2; if (!b || $3 < b) b = $3; if ($4 > most) most = $4
        if (!least || $4 < least) least = $4 }
      END { printf "contact and bond / contact alone: %.2f (shortest of %d; single ratios %.2f to %.2f), %.1f ns per bond-step\n",
        b / a, NR - 1, least, most, (b - a) / 800 / 30492 * 1e9 }' "$work/lattice.csv"
    echo "load of the machine: $(cut -d' ' -f1-3 /proc/loadavg) on $(nproc) processors" ;;
  ranks)
    heavy
    electrode
    echo "repeat,one_rank_s,two_ranks_s,speed_up" >"$work/ranks.csv"
    for repeat in $(seq "$repeats"); do
      press 1 ranks_1.log -var steps 4000
      press 2 ranks_2.log -var steps 4000
      awk -v r="$repeat" -v a="$(loop_time "$work/ranks_1.log")" -v b="$(loop_time "$work/ranks_2.log")" \
        'BEGIN { printf "%d,%g,%g,%.3f\n", r, a, b, a / b }' | tee -a "$work/ranks.csv"
    done ;;
  memory)
    heavy
    electrode
    press 1 memory.log -var steps 100000 &
    run=$!
    sleep 1
    pid=$(pgrep -f "$bin/liggghts .*-log memory.log" | tail -n 1)
    echo "seconds,resident_kB" >"$work/memory.csv"
    begin=$SECONDS
    while resident=$(sed -n 's/^VmRSS:[^0-9]*\([0-9]*\) kB/\1/p' "/proc/$pid/status" 2>/dev/null) &&
      [ -n "$resident" ]; do
      echo "$((SECONDS - begin)),$resident" >>"$work/memory.csv"
      sleep 1
    done
    wait $run
    # From a fifth of the run on nothing may grow: one neighbour page is 1 % of the whole.
    awk -F, 'NR > 1 { kB[++n] = $2 } END { early = kB[int(n / 5) + 1]; late = kB[n - 1];
      printf "resident: %d kB after a fifth of 1e5 steps, %d kB at the end (%+.2f %%)\n", early, late, 100 * (late / early - 1);
      exit !(late <= 1.01 * early) }' "$work/memory.csv" || fail "memory grows" ;;
esac
