#!/usr/bin/env bash
# slurm_test.sh BIN WORK: calendem study --slurm on a Slurm of its own: three runs on two packings. Its client is
# killed, a run's LIGGGHTS is killed; in the end the table is that of local processes.
set -euo pipefail
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=/dev/null
. "$here/cluster.sh"
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
export OMPI_MCA_mpi_yield_when_idle=1

says() { # TEXT...: all in what was said
  local text
  for text in "$@"; do grep -qF -- "$text" "$work/said" || fail "no '$text' in: $(cat "$work/said")"; done
}
expect() { # STATUS COMMAND...
  local want=$1 status=0
  shift
  "$@" >"$work/said" 2>&1 </dev/null || status=$?
  cat "$work/said"
  [ $status -eq "$want" ] || fail "exit status $status, expected $want: $*"
}
column() { # NAME: its cells in the table of the study
  awk -F, -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k } NR > 1 { print $c }' "$work/out/study.csv"
}
wait_for() { # WHAT COMMAND...: until it holds, a minute at most
  local what=$1
  shift
  for _ in $(seq 600); do
    if "$@"; then return; fi
    sleep 0.1
  done
  fail "no $what: $(cat "$work"/out/slurm/*.log) $(squeue)"
}
queued() { [ -n "$(squeue -h --name="$job-runs" 2>/dev/null)" ]; }
# not that of another copy of the repository mounted at the same place
liggghts_of() { pgrep --ns $$ --nslist mnt -f "^[^ ]*/liggghts .*-var out $work/out/runs/$1 "; }
its_liggghts_runs() { liggghts_of "$1" >/dev/null && [ -s "$work/out/runs/$1/running.restart" ]; }

rm -rf "$work"
mkdir -p "$work"
cp "$here/../calendering/electrode.toml" "$work/"
printf '%s\n' 'electrode = "electrode"' '[platen]' max_pressure_MPa=5 speed_m_s=4 touch_speed_m_s=4 \
  release_speed_m_s=4 '[output]' restart_every_us=0.05 >"$work/case.toml"
cat >"$work/study.toml" <<'T'
[study]
name = "two packings"
recipe = "electrode.toml"
case = "case.toml"
at_pressure_MPa = [3]
keep = "tables"
[[vary]]
keys = ["recipe.seed", "case.platen.max_pressure_MPa"]
values = [[1, 4], [1, 5], [2, 4]]
T
cat >"$work/bank.toml" <<'T'
[bank]
name = "six points"
recipe = "electrode.toml"
case = "case.toml"
points = 6
packings = 2
[[input]]
name = "E"
keys = ["case.material.am.youngs_modulus_GPa"]
low = 100
high = 300
T
study=("$bin/calendem" study "$work/study.toml" -o "$work/out" --slurm)
slurm=("${study[@]}" --jobs 2 --slurm-every 1 --sbatch "--time=10 --comment='two words'")

expect 2 env PATH=/nowhere "${slurm[@]}"
says "cannot start sbatch" "login node" "--slurm-dry-run"
expect 1 "${study[@]}" --sbatch all
says "--sbatch takes options of sbatch"
expect 0 env PATH=/nowhere "${slurm[@]}" --slurm-dry-run
says "packings.sh is written, tasks 1,3; nothing is submitted" "runs.sh is written, tasks 1-3"
expect 0 bash "$work/out/slurm/packings.sh" 1 # as another scheduler would
expect 3 bash "$work/out/slurm/runs.sh" 3
says "its packing does not exist"
expect 0 "$bin/calendem" bank "$work/bank.toml" -o "$work/bank" --slurm-dry-run
says "runs.sh is written, tasks 1-6"
expect 3 bash "$work/bank/slurm/runs.sh" 6 # the bank's own verb makes its tasks
says "run 6: failed, its packing does not exist"

start_cluster
job=calendem-$(sed -n 's/^#SBATCH --job-name=calendem-\([0-9a-f]*\)-runs$/\1/p' "$work/out/slurm/runs.sh")
"${slurm[@]}" >"$work/killed.log" 2>&1 &
client=$!
wait_for "job in the queue" queued
kill -9 $client
wait $client || true
cat "$work/killed.log"
[ "$(find "$work/out/packings" -name electrode.json | wc -l)" = 1 ] || fail "no packing was left for Slurm to make"

"${slurm[@]}" >"$work/said" 2>&1 &
client=$!
wait_for "client that waits" grep -q waiting "$work/said"
kill -TERM $client
status=0
wait $client || status=$?
[ $status -eq 3 ] || fail "exit status $status of a client that was stopped, expected 3"
says "Its jobs stay in Slurm's queue" "the same command waits for them again" "scancel --name=$job-packings,$job-runs"

"${slurm[@]}" >"$work/said" 2>&1 &
client=$!
mapfile -t runs < <(column run)
wait_for "second run" its_liggghts_runs "${runs[1]}"
liggghts_of "${runs[1]}" | xargs kill -9
status=0
wait $client || status=$?
cat "$work/said"
[ $status -eq 3 ] || fail "exit status $status after a run that failed, expected 3"
says "3 runs in the queue already" "2 of 3 runs done" "run 2: failed, task" "ended as FAILED" \
  "slurm/runs.2.log; see $work/out/runs/${runs[1]}.log"
if grep -q submitted "$work/said"; then fail "what was in the queue was submitted again"; fi
grep -q "exited on signal 9" "$work/out/runs/${runs[1]}.log" || fail "the log does not say why"

expect 0 "${slurm[@]}"
says "runs.sh submitted as job" "tasks 2" "3 of 3 runs done"
grep -q "^#SBATCH --array=2%2$" "$work/out/slurm/runs.sh" || fail "runs that were done were submitted"
[ ! -e "$work/out/runs/${runs[1]}/vtk" ] || fail "frames were kept"
expect 0 "${slurm[@]}"
says "3 runs, 3 of them done already"
if grep -q submitted "$work/said"; then fail "a second call submitted something"; fi
[ -z "$(squeue -h)" ] || fail "something is left in the queue: $(squeue)"

mkdir "$work/local"
cp -r "$work/out/packings" "$work/local/"
expect 0 "$bin/calendem" study "$work/study.toml" -o "$work/local" --jobs 2
results() { # FOLDER: its table without what the clock says
  awk -F, -v OFS=, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "wall_clock_s") c = k } { $c = ""; print }' "$1/study.csv"
}
[ "$(results "$work/out")" = "$(results "$work/local")" ] || fail "Slurm's table differs from that of local processes"
