#!/usr/bin/env bash
# mutants.sh WORK [NAME...]: puts each fault of mutants.txt into a copy of the tree, builds what it concerns and
# asks that the named tests fail; writes WORK/mutants.csv. Runs with CALENDEM_HEAVY=1; about an hour.
set -euo pipefail
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: mutants run with tools/test --all"; exit 77; }
work=$1
shift
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../../.." && pwd)
tree=$work/tree
trim() { sed 's/^ *//; s/ *$//' <<<"$1"; }

mkdir -p "$tree"
(cd "$top" && git ls-files -z --cached --others --exclude-standard | tar --null -cf - -T -) | tar -xf - -C "$tree"
"$tree/tools/build" --test --no-install-dependencies >"$work/build.log" 2>&1 ||
  { tail "$work/build.log"; echo "FAILED: the copy of the tree cannot be built" >&2; exit 1; }
echo "name,caught" >"$work/mutants.csv"
missed=0 all=0
while IFS='|' read -r name file expression tests <&3; do
  name=$(trim "$name") file=$(trim "$file") expression=$(trim "$expression") tests=$(trim "$tests")
  case $name in "" | "#"*) continue ;; esac
  [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
  case $file in tools/* | tests/*) file=$tree/$file ;; *) file=$tree/src_plugin/$file ;; esac
  cp "$file" "$work/original"
  sed -i "$expression" "$file"
  if cmp -s "$file" "$work/original"; then echo "FAILED: $name changes nothing" >&2; missed=$((missed + 1)); continue; fi
  target=liggghts unit=${tests%%.*}
  [ ! -d "$tree/tests/unit/$unit" ] || target=${unit}_test
  caught=no
  if ! cmake --build "$tree/build" --target "$target" >"$work/build.log" 2>&1; then caught="does not compile"
  elif ! ctest --test-dir "$tree/build" -R "^${tests//./\\.}" --no-tests=error --stop-on-failure \
      --output-on-failure >"$work/$name.log" 2>&1; then
    caught=yes
    ! grep -q '\*\*\*Timeout' "$work/$name.log" || caught="out of time: is the machine busy?"
  fi
  cp "$work/original" "$file"
  all=$((all + 1))
  [ "$caught" = yes ] || missed=$((missed + 1))
  echo "$name,$caught" | tee -a "$work/mutants.csv"
done 3<"$here/mutants.txt"
echo "$((all - missed)) of $all mutants caught"
[ $missed -eq 0 ]
