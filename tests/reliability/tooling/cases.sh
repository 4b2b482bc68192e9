#!/usr/bin/env bash
# cases.sh CASE: one case of the tooling tests. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset CALENDEM_LIGGGHTS_SOURCE
name=liggghts_3.8.0+repack1.orig.tar.xz
tarball=${XDG_CACHE_HOME:-$HOME/.cache}/calendem/$name

fail() { echo "FAILED: $*"; exit 1; }
need_tarball() {
  [ -f "$tarball" ] || { echo "skipped: no $tarball (tools/get-liggghts keeps it there)"; exit 77; }
}
unpack() { # DIR: the tarball's src/ in DIR
  need_tarball
  mkdir -p "$1"
  tar -xf "$tarball" -C "$1" --strip-components=1 --wildcards '*/src/*'
}
# A tree small enough to be quick, which no patch of ours fits.
tiny_tree() { # DIR
  mkdir -p "$1/src"
  echo "// pair gran" >"$1/src/pair_gran.h"
}
expect() { # STATUS TEXT COMMAND...: the exit status, and a text that the output must contain
  local want=$1 text=$2 status=0
  shift 2
  "$@" >"$work/said" 2>&1 </dev/null || status=$?
  cat "$work/said"
  [ $status -eq "$want" ] || fail "exit status $status, expected $want: $*"
  grep -qF -- "$text" "$work/said" || fail "no '$text' in the output of: $*"
}
same() { diff -r "$1" "$2" || fail "$1 and $2 differ"; }

install_into_is_reversible() {
  unpack "$work/tree"
  echo "GRAN_MODEL(HOOKE, TANGENTIAL_OFF, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT)" \
    >"$work/tree/src/style_contact_model.whitelist"
  cp -r "$work/tree" "$work/before"
  expect 0 "files of the plugin are in" "$top/tools/install-into" "$work/tree"
  expect 0 "has the plugin as it is here" "$top/tools/install-into" "$work/tree" --check
  cp -r "$work/tree" "$work/once"
  expect 0 "files of the plugin are in" "$top/tools/install-into" "$work/tree"
  same "$work/once" "$work/tree"
  expect 0 "is as it was" "$top/tools/install-into" "$work/tree" --revert
  same "$work/before" "$work/tree"
  expect 4 "differs: " "$top/tools/install-into" "$work/tree" --check
}
install_into_keeps_edits() {
  unpack "$work/tree"
  expect 0 "" "$top/tools/install-into" "$work/tree"
  local file
  file=$(basename "$(find "$work/tree/src/physics" -name '*.h' -print -quit)")
  echo "// mine" >>"$work/tree/src/physics/$file"
  expect 0 "kept as src/physics/$file.edited" "$top/tools/install-into" "$work/tree"
  tail -n 1 "$work/tree/src/physics/$file.edited" | grep -qx "// mine" || fail "the edit is lost"
}
install_into_spares_host_files() {
  unpack "$work/tree"
  local file
  file=$(basename "$(find "$top/src_plugin/liggghts" -name '*.h' -print -quit)")
  echo "// the host's" >"$work/tree/src/$file"
  cp -r "$work/tree" "$work/before"
  expect 2 "belongs to the tree" "$top/tools/install-into" "$work/tree"
  same "$work/before" "$work/tree"
  expect 2 "is no LIGGGHTS tree" "$top/tools/install-into" "$work"
}
patches_round_trip() {
  unpack "$work/tree"
  cp -r "$work/tree" "$work/before"
  expect 4 ": applies" "$top/patches/apply" check "$work/tree"
  expect 0 " applied" "$top/patches/apply" apply "$work/tree"
  expect 0 ": in" "$top/patches/apply" check "$work/tree"
  expect 0 " is in" "$top/patches/apply" apply "$work/tree"
  expect 0 " reverted" "$top/patches/apply" revert "$work/tree"
  same "$work/before" "$work/tree"
  expect 0 "nothing to revert" "$top/patches/apply" revert "$work/tree"
}
patches_name_a_conflict() {
  tiny_tree "$work/tree"
  expect 2 "neither fits nor is in" "$top/patches/apply" apply "$work/tree"
}
get_liggghts_accepts_directory() {
  unpack "$work/given"
  cp -r "$work/given" "$work/before"
  expect 0 "source in" "$top/tools/get-liggghts" --source "$work/given" -o "$work/out-dir"
  same "$work/before" "$work/given"
  expect 0 "is up to date" "$top/tools/get-liggghts" --source "$work/given" -o "$work/out-dir"
  echo "// new" >>"$work/given/src/fix.cpp"
  touch "$work/mark"
  expect 0 "source in" "$top/tools/get-liggghts" --source "$work/given" -o "$work/out-dir"
  [ "$(find "$work/out-dir/src" -newer "$work/mark" -type f)" = "$work/out-dir/src/fix.cpp" ] ||
    fail "more was written than what had changed"
  expect 2 "is the output folder too" "$top/tools/get-liggghts" --source "$work/given" -o "$work/given"
}
get_liggghts_accepts_git() {
  unpack "$work/given"
  (cd "$work/given" && git init -q . && git add src &&
    git -c user.name=t -c user.email=t@localhost commit -q -m t)
  local sha
  sha=$(git -C "$work/given" rev-parse HEAD)
  expect 0 "commit $sha" "$top/tools/get-liggghts" --source "file://$work/given" -o "$work/out-dir"
  [ -f "$work/out-dir/src/fix.cpp" ] || fail "no source in the output"
  expect 2 "has no commit 'feed'" "$top/tools/get-liggghts" --source "$work/given" --commit feed \
    -o "$work/out-dir"
  expect 2 "cannot clone" "$top/tools/get-liggghts" --source "file://$work/nowhere" -o "$work/out-dir"
}
get_liggghts_refuses_wrong_checksum() {
  echo "not a tarball" >"$work/$name"
  expect 2 "expected c18721d9" "$top/tools/get-liggghts" --source "$work/$name" -o "$work/out-dir"
  [ ! -e "$work/out-dir" ] || fail "a folder was left behind"
}
get_liggghts_refuses_truncated_tarball() {
  need_tarball
  head -c 1000000 "$tarball" >"$work/short.tar.xz"
  expect 2 "cannot be unpacked" "$top/tools/get-liggghts" --source "$work/short.tar.xz" -o "$work/out-dir"
  [ ! -e "$work/out-dir" ] || fail "a folder was left behind"
}
get_liggghts_refuses_missing_source() {
  expect 2 "neither a directory" "$top/tools/get-liggghts" --source "$work/nowhere" -o "$work/out-dir"
  expect 2 "no src/pair_gran.h" "$top/tools/get-liggghts" --source "$work" -o "$work/out-dir"
  expect 1 "lacks its value" "$top/tools/get-liggghts" --source
  CALENDEM_LIGGGHTS_SOURCE=$work/nowhere expect 2 "neither a directory" \
    "$top/tools/get-liggghts" -o "$work/out-dir"
}
get_liggghts_spares_foreign_folder() {
  unpack "$work/given"
  mkdir "$work/mine"
  echo thesis >"$work/mine/thesis.txt"
  expect 2 "was not made by get-liggghts" "$top/tools/get-liggghts" --source "$work/given" -o "$work/mine"
  [ "$(cat "$work/mine/thesis.txt")" = thesis ] || fail "a file of the user is gone"
}
build_refuses_a_path() { # before it installs, fetches or compiles anything
  mkdir -p "$work/my clone/tools"
  cp "$top/tools/build" "$work/my clone/tools"
  expect 2 "cannot take a path with a blank" "$work/my clone/tools/build" --no-install-dependencies
  mv "$work/my clone" "$work/übung-1.0_a+b"
  expect 127 "get-liggghts" "$work/übung-1.0_a+b/tools/build" --no-install-dependencies
}
scripts_explain_themselves() {
  local script
  for script in "$top"/tools/* "$top/patches/apply"; do
    [ -f "$script" ] || continue
    expect 0 "$(basename "$script")" "$script" --help
    expect 1 "no-such-option" "$script" --no-such-option
  done
}
# A stand-in for Slurm: jobs are kept in a file; the first is killed by the wall-time limit.
batch_script_chains_jobs() {
  mkdir -p "$work/bin" "$work/repo/build/bin" "$work/electrode" "$work/out"
  touch "$work/electrode/electrode.data" "$work/repo/build/bin/liggghts"
  chmod +x "$work/repo/build/bin/liggghts"
  cat >"$work/bin/sbatch" <<'END'
#!/bin/sh
echo "$CALENDEM_JOB $CALENDEM_PROGRESS" >>"$WORK/queue"
echo "20$CALENDEM_JOB"
END
  cat >"$work/bin/mpirun" <<'END'
#!/bin/sh
echo "$*" >>"$WORK/runs"
case $(wc -l <"$WORK/runs") in
  1) echo half >"$WORK/out/running.restart"; exit 137 ;;
  2) echo all >"$WORK/out/compressed.restart" ;;
  *) echo end >"$WORK/out/final.restart" ;;
esac
END
  cat >"$work/bin/scancel" <<'END'
#!/bin/sh
echo "$1" >>"$WORK/cancelled"
END
  chmod +x "$work"/bin/*
  export PATH=$work/bin:$PATH WORK=$work SLURM_JOB_ID=200
  cd "$work/repo"
  local script=$top/input_scripts/cluster/slurm.sh
  expect 3 "the successor goes on" "$script" "$work/electrode" "$work/out"
  CALENDEM_JOB=2 expect 0 "final.restart is written" "$script" "$work/electrode" "$work/out"
  sed -n 2p "$work/runs" | grep -q "in.compression .*-var resuming 1" || fail "the second job did not resume"
  sed -n 3p "$work/runs" | grep -q "in.relaxation" || fail "no relaxation after the compression"
  [ "$(cat "$work/cancelled")" = 203 ] || fail "the successor of the last job was not cancelled"
  expect 0 "is finished" "$script" "$work/electrode" "$work/out"
  rm "$work"/out/*.restart
  CALENDEM_JOB=2 CALENDEM_PROGRESS="$(cksum </dev/null)" expect 3 "no new restart file" \
    "$script" "$work/electrode" "$work/out"
  expect 2 "no electrode.data" "$script" "$work" "$work/out"
}
case ${1:-} in
  "" | *[!a-z_]*) echo "usage: cases.sh CASE" >&2; exit 1 ;;
  *) "$1" ;;
esac
