#!/usr/bin/env bash
# A Slurm of one node on this machine, for the tests that source this file: munged, slurmctld and slurmd
# with a key, ports and a folder of their own, ended with the script.
cluster=
cluster_daemons=()

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }
free_port() { # a port of this machine that nobody listens to
  local port
  for _ in $(seq 50); do
    port=$((20000 + RANDOM % 10000))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}
daemon() { # NAME WORDS...: ends when this script does, even if that is killed
  local name=$1
  shift
  setpriv --pdeathsig TERM "$@" >"$cluster/$name.log" 2>&1 </dev/null &
  cluster_daemons+=($!)
}
write_cluster_files() {
  local user host
  user=$(id -un) host=$(hostname -s)
  head -c 64 /dev/urandom >"$cluster/munge.key"
  chmod 600 "$cluster/munge.key"
  mkdir "$cluster/state" "$cluster/spool" "$cluster/cgroup"
  # proctrack and task need no rights; cgroups, which slurmd wants to find, are an empty folder
  printf '%s\n' CgroupPlugin=cgroup/v1 "CgroupMountpoint=$cluster/cgroup" >"$cluster/cgroup.conf"
  cat >"$cluster/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthInfo=socket=$cluster/munge.socket
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=10
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=60 State=UP
END
  export SLURM_CONF=$cluster/slurm.conf
}
start_cluster() {
  local program
  PATH=$PATH:/usr/sbin:/sbin
  for program in munged slurmctld slurmd sbatch setpriv; do
    command -v $program >/dev/null || skip "no $program; tools/install-dependencies --test brings Slurm"
  done
  cluster=$(mktemp -d /tmp/calendem-slurm.XXXXXX) # short: a socket's path may have 107 characters
  chmod 755 "$cluster"
  trap stop_cluster EXIT
  write_cluster_files
  daemon munged munged --foreground --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" \
    --pid-file="$cluster/munged.pid" --seed-file="$cluster/munge.seed" --log-file="$cluster/munge.log"
  daemon slurmctld slurmctld -D -i
  daemon slurmd slurmd -D
  for _ in $(seq 120); do
    [ "$(sinfo -h -o %T 2>/dev/null)" != idle ] || return 0
    sleep 0.25
  done
  tail -n 5 "$cluster"/*.log
  skip "Slurm's daemons do not start here (their last words are above)"
}
stop_cluster() { # what they ran ends with them
  local id
  [ -n "$cluster" ] || return 0
  scancel --user="$(id -un)" 2>/dev/null || true
  for _ in $(seq 60); do
    [ -n "$(squeue -h 2>/dev/null)" ] || break
    sleep 0.25
  done
  for id in "${cluster_daemons[@]}"; do kill "$id" 2>/dev/null || true; done
  wait "${cluster_daemons[@]}" 2>/dev/null || true
  rm -rf "$cluster"
}
