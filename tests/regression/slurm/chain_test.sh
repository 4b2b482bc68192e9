#!/usr/bin/env bash
# chain_test.sh BIN WORK: input_scripts/cluster/slurm.sh on a Slurm of its own. The first job is ended as at its
# wall-time limit once a restart file is there; its successor ends the run, bit for bit as without an end.
set -euo pipefail
bin=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=/dev/null
. "$here/cluster.sh"
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
export OMPI_MCA_mpi_yield_when_idle=1
settings=(-var p_max_MPa 4 -var speed_m_s 4 -var touch_speed_m_s 4 -var release_speed_m_s 4
  -var restart_every_us 0.05)

start_cluster
rm -rf "$work"
mkdir -p "$work/repo/build" "$work/out" "$work/whole"
ln -s "$bin" "$work/repo/build/bin"
cp -r "$here/../../../input_scripts" "$work/repo/"
cd "$work/repo"
sed -i -e 's/^#SBATCH --nodes=.*/#SBATCH --nodes=1/' -e 's/^#SBATCH --ntasks-per-node=.*/#SBATCH --ntasks-per-node=1/' \
  -e 's/^#SBATCH --time=.*/#SBATCH --time=10/' input_scripts/cluster/slurm.sh
# the study's test leaves an electrode
electrode=$(find "$work/../slurm/out/packings" -name electrode.data -printf '%h\n' 2>/dev/null | sort | head -n 1)
if [ -z "$electrode" ]; then
  electrode=$work/electrode
  "$bin/calendem" pack "$here/../calendering/electrode.toml" -o "$electrode" --ranks 1
fi

job=$(sbatch --parsable input_scripts/cluster/slurm.sh "$electrode" "$work/out" "${settings[@]}")
for _ in $(seq 600); do
  [ ! -s "$work/out/running.restart" ] || break
  sleep 0.1
done
scancel "$job"
for _ in $(seq 1800); do
  [ -n "$(squeue -h)" ] || break
  sleep 0.1
done
cat calendering-*.log
[ -z "$(squeue -h)" ] || fail "the chain does not end: $(squeue)"
[ "$(find . -name 'calendering-*.log' | wc -l)" = 2 ] || fail "there should be a job and one successor that ran"
[ -s "$work/out/final.restart" ] || fail "no final.restart"
grep -q "done, $work/out/final.restart is written" calendering-*.log || fail "the end is not reported"

for part in compression relaxation; do # as the heads of the scripts say, from the folder of the repository
  "$bin/liggghts" -in input_scripts/in.$part -log none -var electrode "$electrode" -var out "$work/whole" \
    "${settings[@]}" >>"$work/whole.log" || fail "in.$part does not run by itself: $(tail -n 3 "$work/whole.log")"
done
# Each job begins with the header and writes what stands behind its restart file once more, the same.
rows() { sed -n '/^[0-9]/p' "$1/curve_raw.csv" | sort -t, -k1,1n | uniq; }
cmp <(rows "$work/whole") <(rows "$work/out") || fail "the chain's curve is another"
cmp "$work/whole/breaks.csv" "$work/out/breaks.csv" || fail "the chain's break log is another"
