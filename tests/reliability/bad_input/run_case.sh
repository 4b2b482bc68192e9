#!/usr/bin/env bash
# run_case.sh CASE BIN WORK: plays one case of cases.txt, whose head explains the table, with the real programs.
# Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
name=$1 bin=$2 shared=$3
table=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/cases.txt
scripts=$(cd "$(dirname "$table")/../../../input_scripts" && pwd)
# shellcheck disable=SC2034 # read by rows of the table
electrode=$shared/electrode/packed cases=$scripts/cases work=$shared/$name
if [ "$(id -u)" -eq 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_rmaps_base_oversubscribe=1

fail() { echo "FAILED: $*"; exit 1; }
skip() { echo "skipped: $*"; exit 77; }

# ---- words of the table's commands
calendem() { "$bin/calendem" "$@"; }
run() { calendem run "$work/case.toml" -o "$work/run" --ranks 1 "$@"; }
script_of() { # FILE WORDS...: one of the scripts itself, with these words on its command line
  "$bin/liggghts" -in "$scripts/$1" -log none -var scripts "$scripts" -var out "$work" "${@:2}"
}
script() { script_of in.calendering -var electrode "${script_electrode:-$electrode}" "$@"; } # WORDS...
one_line() { awk '{ print } END { exit NR == 1 ? 0 : 99 }'; }
nothing_at() { [ ! -e "$1" ] || fail "there is a $1"; }
holds() { grep -qF -- "$2" "$1" || fail "no '$2' in $1"; } # FILE TEXT
copy_of_electrode() { # to be spoilt
  cp -r "$electrode" electrode
  echo 'electrode = "electrode"' >case.toml
}
short_files() { bash -c 'trap "" XFSZ; ulimit -f 2; exec "$@"' - "$@"; } # COMMAND...: it can write 1 kB to a file
full_disk() { # MB: a file system of that size at disk/, of a mount that only this process and its children see
  mkdir -p disk
  if [ -z "${CALENDEM_TEST_DISK:-}" ]; then
    unshare -m true 2>/dev/null || skip "making a small disk needs the right to mount"
    CALENDEM_TEST_DISK=1 exec unshare -m bash "$(dirname "$table")/run_case.sh" "$name" "$bin" "$shared"
  fi
  mount -t tmpfs -o "size=$1m" none disk
}
# ---- runs in the background; what they say is in run.log, the first process is $running
begin() { # OPTION...
  "$bin/calendem" run "$work/case.toml" -o "$work/run" "$@" >run.log 2>&1 </dev/null &
  running=$!
}
at_terminal() { # COMMAND...: on a terminal of its own (bash ignores SIGINT in what it begins by &)
  mkfifo keys
  SHELL=/bin/bash command script -qec "exec env --default-signal=INT $(printf '%q ' "$@")" run.log <keys >/dev/null 2>&1 &
  running=$!
  exec 3>keys
  trap '' PIPE
}
ctrl_c() { printf '\003' >&3 || true; } # it may have ended
until_file() { # FILE: waits for the file, and some rows of the curve beside it
  for _ in $(seq 600); do
    [ ! -s "$1" ] || [ "$(wc -l <"$(dirname "$1")/curve_raw.csv")" -lt 4 ] || return 0
    kill -0 "$running" 2>/dev/null || fail "the run ended before it wrote $1: $(cat run.log)"
    sleep 0.05
  done
  fail "no $1"
}
ranks_of_run() { pgrep -f "^[^ ]*/liggghts .*-var out $work/run " || true; }
ended() { # the exit status of the run in the background, what it said
  local status=0
  wait "$running" || status=$?
  cat run.log
  ! pgrep -af "^[^ ]*/(liggghts|calendem) .*$work/" || fail "that goes on, nobody waits for it"
  return $status
}
killed_within_5_s() { # by SIGKILL, and what it had begun ends by itself
  local status=0
  for _ in $(seq 50); do [ -z "$(ranks_of_run)" ] || sleep 0.1; done
  ended || status=$?
  [ $status -eq 137 ]
}
stopped_run() { # in run/: a run that was stopped after two restart files
  begin --ranks 1
  until_file run/running.previous
  kill -TERM "$running"
  expect 3 ended
}
is_kept() { # RUN: what a run that was stopped had computed
  [ -s "${1:-run}/curve.csv" ] || fail "no curve.csv"
  holds "${1:-run}/summary.json" '"finished": false'
  holds "${1:-run}/summary.json" '"stopped_because"'
  ! compgen -G "${1:-run}/restart_forced_*" || fail "files that nothing uses are left"
}

# ---- the table
declare -A texts # by their names, with @
filled() { # TEXT: with what its @NAMEs stand for
  local text=$1 key
  for key in "${!texts[@]}"; do text=${text//"$key"/"${texts[$key]}"}; done
  echo "$text"
}
write_file() { # FILE[+] LINES
  local text
  text=$(filled "$2")
  case $1 in *+) printf '%s\n' "${text// ; /$'\n'}" >>"${1%+}" ;; *) printf '%s\n' "${text// ; /$'\n'}" >"$1" ;; esac
}
expect() { # STATUS COMMAND: what it says is kept in said
  local status=0
  eval "${*:2}" >said 2>&1 </dev/null || status=$?
  cat said
  [ $status -eq "$1" ] || fail "exit status $status, expected $1: ${*:2}"
}
says() { # WORDS & WORDS
  local words
  while read -r words; do holds said "$words"; done <<<"${1// & /$'\n'}"
}
play() { # ROW
  local row=${1%% => *} file text
  case $row in
    "" | "#"* | "== "*) ;;
    "  "*) says "$row" ;;
    @*) texts[${row%%: *}]=$(filled "${row#*: }") ;;
    "$ "*) eval "${row#$ }" || fail "$row" ;;
    [0-9]" "*) expect "${row%% *}" "${row#* }" ;;
    *" | "*" | "*)
      IFS='|' read -r _ file text <<<"$row"
      write_file "${file// /}" "${text# }"
      expect 2 calendem validate "${file// /}" ;;
    *": "*) write_file "${row%%: *}" "${row#*: }" ;;
    *) fail "cases.txt: this is no row: $row" ;;
  esac
  [ "$row" = "$1" ] || says "${1#* => }"
}
# What all cases may use; the rows of a mistake in one file, or those of a case of several steps.
mapfile -t rows < <(awk -v name="$name" '/^== / { steps = 1 } /^== / || !steps && / \| / { on = $(1 + steps) == name }
                                         on || /^@/ && !steps' "$table")
head=$(printf '%s\n' "${rows[@]}" | awk '!/^@/ && !found { print; found = 1 }') # to its end: no broken pipe
[ -n "$head" ] || fail "cases.txt has no case '$name'"
[[ ! $head =~ ^==.*\ each=([^ ]*) ]] || values=${BASH_REMATCH[1]}
IFS=, read -ra values <<<"${values:-once}"
for value in "${values[@]}"; do
  [ -n "${CALENDEM_TEST_DISK:-}" ] || rm -rf "$work"
  mkdir -p "$work"
  cd "$work"
  for row in "${rows[@]}"; do play "${row//\{\}/$value}"; done
done
