#!/usr/bin/env bash
#SBATCH --job-name=calendering
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=32
#SBATCH --time=12:00:00
#SBATCH --output=calendering-%j.log
# One compression and relaxation on several nodes, over as many jobs as the wall-time limit makes
# necessary: each job first puts its successor into the queue, then goes on from the last restart file.
#   mkdir -p OUT && sbatch input_scripts/cluster/slurm.sh ELECTRODE OUT [-var NAME VALUE]...
# ELECTRODE: folder made by `calendem pack`. OUT: output folder on a file system that all nodes see.
# Submit from the folder of the repository; it was built on the login node with
#   tools/build --no-install-dependencies --source LIGGGHTS [--portable]
# Adapt the #SBATCH lines and the module line; the successors know only these, not sbatch's command line.
# mpirun takes ranks and nodes from the job; CALENDEM_LAUNCH="srun --mpi=pmix" takes Slurm's own launcher, where it
# was built for this MPI (a plain srun often is not). The chain ends when OUT/final.restart is there, after
# CALENDEM_MAX_JOBS jobs (default 20), or when a job made no progress (no new restart file). The relaxation
# always begins at OUT/compressed.restart: one job must be long enough for it.
set -euo pipefail
if [ "${1:-}" = --help ]; then sed -n '7,18s/^# \{0,1\}//p' "$0"; exit 0; fi
if [ $# -lt 2 ]; then sed -n '7,18s/^# \{0,1\}//p' "$0" >&2; exit 1; fi
electrode=$1 out=$2
shift 2
# module load openmpi vtk

[ -f "$electrode/electrode.data" ] || { echo "slurm: no electrode.data in '$electrode'" >&2; exit 2; }
[ -d "$out" ] || { echo "slurm: output folder '$out' does not exist" >&2; exit 2; }
[ -x build/bin/liggghts ] || { echo "slurm: no build/bin/liggghts in '$PWD'; submit from the repository" >&2; exit 2; }
[ ! -f "$out/final.restart" ] || { echo "slurm: '$out' is finished"; exit 0; }

read -ra launch <<<"${CALENDEM_LAUNCH:-mpirun}"
job=${CALENDEM_JOB:-1}
[ "$job" -le "${CALENDEM_MAX_JOBS:-20}" ] || { echo "slurm: $((job - 1)) jobs were not enough; submit again" >&2; exit 3; }
progress=$(cat "$out"/running.restart "$out"/compressed.restart 2>/dev/null | cksum || true)
[ "$progress" != "${CALENDEM_PROGRESS:-}" ] || {
  echo "slurm: the last job wrote no new restart file; see its log and -var restart_every_us" >&2
  exit 3
}
successor=$(CALENDEM_JOB=$((job + 1)) CALENDEM_PROGRESS=$progress sbatch --parsable --export=ALL \
  --dependency="afterany:$SLURM_JOB_ID" input_scripts/cluster/slurm.sh "$electrode" "$out" "$@")
echo "slurm: job $job of the chain is $SLURM_JOB_ID, its successor is $successor"

liggghts() { # SCRIPT [-var NAME VALUE]...
  local script=$1 status=0
  shift
  "${launch[@]}" build/bin/liggghts -in "input_scripts/$script" -var scripts input_scripts -log "$out/log.$script.$job" \
    -var electrode "$electrode" -var out "$out" "$@" || status=$?
  [ $status -eq 0 ] || { echo "slurm: $script ended with status $status; the successor goes on" >&2; exit 3; }
}
if [ ! -f "$out/compressed.restart" ]; then
  if [ -f "$out/running.restart" ]; then liggghts in.compression -var resuming 1 "$@"
  else liggghts in.compression "$@"; fi
fi
liggghts in.relaxation "$@"
scancel "$successor"
echo "slurm: done, $out/final.restart is written"
