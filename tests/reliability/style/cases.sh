#!/usr/bin/env bash
# cases.sh CASE BUILD: one case of the style tests. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

skip() { echo "skipped: $*"; exit 77; }
report() { # WHAT: fails when there are lines on stdin
  local found
  found=$(cat)
  [ -z "$found" ] || { echo "$found"; echo "FAILED: $*"; exit 1; }
}
cxx_files() { find src_plugin tools tests -name '*.h' -o -name '*.cpp' | LC_ALL=C sort; }
matching() { grep -E "$@" || true; }
without() { grep -vE "$@" || true; }
includes() { grep -nE '^ *# *include' -r "$@" --include='*.h' --include='*.cpp'; }

physics_is_self_contained() {
  # Standard headers have neither a dot nor a slash in their name; input and output are not physics.
  includes src_plugin/physics | without '#include (<[a-z_]+>|"[a-z0-9_]+\.h")' |
    report "physics may include standard headers and its own, nothing else" || exit 1
  includes src_plugin/physics | matching '<(iostream|fstream|cstdio|filesystem|thread|mutex|random)>' |
    report "physics does no input, output or hidden randomness" || exit 1
  local name
  includes src_plugin/physics | sed -n 's/.*"\(.*\)".*/\1/p' | sort -u |
    while read -r name; do [ -f "src_plugin/physics/$name" ] || echo "$name"; done |
    report "headers that are not in src_plugin/physics"
  for name in src_plugin/physics/*.h; do # each compiles by itself
    "${CXX:-g++}" -std=c++17 -Wall -Wextra -Werror -fsyntax-only -x c++ "$name" ||
      { echo "FAILED: $name does not compile by itself"; exit 1; }
  done
}
includes_point_one_way() { # physics <- laws <- liggghts, tools/calendem; tests on top
  includes src_plugin/laws | without '#include (<[a-z_]+>|"(physics|laws)/[a-z0-9_]+\.h")' |
    report "laws may include standard headers, physics and its own"
  includes src_plugin | matching '"[^"]*(calendem|tools|tests|gtest)[^"]*"' |
    report "src_plugin must not include tools or tests" || exit 1
  # A folder of tools/calendem knows itself, those before it in this list, and its CMake library links no other.
  local folder known=physics\|laws
  for folder in effects base inference electrode/structure electrode/pack electrode/slurry electrode simulate bank measure report press \
    compare commands films predict diagnose film_commands .; do
    known="$known|$folder"
    find "tools/calendem/$folder" -maxdepth 1 -name '*.h' -o -maxdepth 1 -name '*.cpp' | LC_ALL=C sort |
      xargs grep -nE '^ *# *include *"' /dev/null | without "include \"($known)/[a-z0-9_]+\.h\"" |
      report "tools/calendem/$folder may include ${known//|/, } and nothing else of the project" || exit 1
  done
  cxx_files | matching '^tools/calendem/' | cut -d/ -f3- | sed 's:/*[^/]*$::' | sort -u |
    without "^($known)?$" | report "folders of tools/calendem that have no place in the order of includes" || exit 1
  includes tools/calendem | matching '<(gtest|gmock|benchmark)/' | report "tools/calendem must not include tests"
}
named_files_exist() { # those that heads of laws name, and pages (.md) that any comment names; or a program writes them
  local file name folder found
  { grep -nE '^//' src_plugin/physics/*.h src_plugin/laws/*.h | grep -oE '^[^:]+:[0-9]+|[A-Za-z0-9_/.]+\.(h|cpp|md|sh)\b'
    cxx_files | xargs grep -nE '//.*\.md\b' | grep -oE '^[^:]+:[0-9]+|[A-Za-z0-9_/.]+\.md\b'; } |
    while read -r name; do
      case $name in *:[0-9]*) file=$name; continue ;; esac
      found=0
      for folder in . src_plugin "$(dirname "${file%:*}")"; do [ ! -f "$folder/$name" ] || found=1; done
      [ $found -eq 1 ] || grep -qrF "$name\"" tools/calendem --include='*.cpp' || echo "$file names $name"
    done | sort -u | report "files that a comment names and that do not exist"
}
pi_has_one_place() { # physics/pi.h
  cxx_files | without '/physics/pi\.h$' | { xargs grep -nE '3\.14159|6\.28318|M_PI|acos\(-1' /dev/null || true; } |
    report "include physics/pi.h and say kPi"
}
rooms_of_the_plugin() { # a room knows those before it; no unit (a header and its source) reaches itself
  local rooms=(base bonds pairs walls ledger output) room later known="" name
  local -A room_of
  for room in "${rooms[@]}"; do
    while read -r name; do room_of[$name]=$room; done < <(find "src_plugin/liggghts/$room" -name '*.h' -printf '%f\n')
  done
  find src_plugin/liggghts -mindepth 1 -maxdepth 1 -printf '%f\n' | without "^($(IFS='|'; echo "${rooms[*]}"))$" |
    report "src_plugin/liggghts has no other rooms than ${rooms[*]}" || exit 1
  for room in "${rooms[@]}"; do
    known="$known $room"
    includes "src_plugin/liggghts/$room" | sed -n 's/:.*"\([a-z_0-9]*\.h\)".*/ \1/p' | while read -r file name; do
      later=${room_of[$name]:-}
      [ -z "$later" ] || [[ " $known " = *" $later "* ]] || echo "$file includes $later/$name"
    done | report "the room $room may include${known} and the host" || exit 1
  done
  includes src_plugin/liggghts | sed -n 's|.*/\([a-z_0-9]*\)\.[a-z]*:.*"\([a-z_0-9]*\)\.h".*|\1 \2|p' | awk '$1 != $2' |
    LC_ALL=C sort -u | tsort 2>&1 >/dev/null | report "units of src_plugin/liggghts that include each other in a circle"
}
states_are_claimed() { # a restart's states that no fix takes are lost: fix time/bpm has to know their styles
  grep -l 'write_restart(FILE' src_plugin/liggghts/*/*.h | without fix_time_bpm | xargs sed -n 's/^FixStyle(\(.*\), .*/\1/p' |
    while read -r style; do grep -qF "\"$style\"" src_plugin/liggghts/base/fix_time_bpm.cpp || echo "$style"; done |
    report "fixes with a state that kStylesWithState of base/fix_time_bpm.cpp does not name"
}
header_options=(-std=c++17 -Wall -Wextra -I src_plugin -I tools/calendem -isystem /usr/include/eigen3 -x c++)
all_headers() { # of physics, laws and tools/calendem as one translation unit
  { find src_plugin/physics src_plugin/laws -name '*.h' -printf '%P %H\n' | sed 's|\(.*\) src_plugin/\(.*\)|\2/\1|'
    find tools/calendem -name '*.h' -printf '%P\n'; } | LC_ALL=C sort | sed 's/.*/#include "&"/'
}
headers_agree() { # no two definitions of one name
  all_headers | "${CXX:-g++}" "${header_options[@]}" -Werror -fsyntax-only - ||
    { echo "FAILED: a name is defined in two headers"; exit 1; }
}
no_large_files() { # in the repository, or in the tree where there is no git
  { git ls-files -z 2>/dev/null || find . -path ./build -prune -o -type f -print0; } |
    xargs -0 -I{} find {} -maxdepth 0 -size +1024k |
    report "files of more than 1 MB do not belong into the repository"
}
no_merge_markers() { # of a merge whose conflicts nobody has decided
  { git ls-files -z 2>/dev/null || find . -path ./build -prune -o -type f -print0; } |
    { xargs -0 grep -nIE '^(<{7}|>{7}|\|{7}) ' /dev/null || true; } | report "both sides of a merge are in the file"
}
formatted() {
  command -v clang-format >/dev/null || skip "no clang-format; tools/install-dependencies --test brings it"
  local version
  version=$(clang-format --version | grep -oE 'version [0-9]+' | grep -oE '[0-9]+')
  [ "$version" -eq 14 ] || skip "clang-format $version; the tree is formatted with 14, others differ in detail"
  cxx_files | xargs clang-format --dry-run 2>&1 | matching 'warning:' | cut -d: -f1 | sort | uniq -c |
    report "not as .clang-format says (number of places, file); clang-format -i FILE mends it"
}
bodies_are_short() { # but for those of long_bodies.txt, a list that may only get shorter
  cxx_files | xargs awk -f tests/reliability/style/long_bodies.awk | sed 's/:[0-9]*: / /' | LC_ALL=C sort |
    LC_ALL=C comm -3 - tests/reliability/style/long_bodies.txt |
    report "left: bodies of more than 40 lines; right: what long_bodies.txt says and is so no more: strike it, or lower it"
}
comments_are_sentences() {
  { cxx_files; find tools tests input_scripts .ci -name '*.sh' -o -name CMakeLists.txt -o -name '*.js' -o -name 'in.*' -o -name '*.in'
    find tools -maxdepth 1 -type f; } | LC_ALL=C sort -u | xargs awk -f tests/reliability/style/comment_beginnings.awk |
    report "comments that begin with Of, That, Those, And, Then or The same"
}
# compile_commands.json of BUILD, with each source of a file that CMake made of several (UNITY_BUILD) by itself, and
# without precompiled headers, which only the compiler that made them can read.
write_commands_of_sources() { # BUILD FOLDER
  mkdir -p "$2"
  awk '
    /^  "command"/ { sub(/ -include [^ ]*cmake_pch\.hxx/, ""); command = $0 }
    /^  "file": ".*\/unity_[0-9]+_cxx\.cxx"/ {
      split($0, part, "\""); unity = part[4]; n = 0
      while ((getline line < unity) > 0)
        if (split(line, include, "\"") == 3) {
          by_itself = command
          sub(" -c .*", " -c " include[2] "\",", by_itself)
          entries[++n] = by_itself "\n  \"file\": \"" include[2] "\""
        }
      for (k = 1; k < n; ++k) printf "%s\n},\n{\n%s", entries[k], directory
      print entries[n]; next }
    /^  "directory"/ { directory = $0 "\n"; printf "%s", directory; next }
    /^  "command"/ { next }
    /^  "file"/ { print command }
    { print }' "$1/compile_commands.json" >"$2/compile_commands.json"
}
# clang-tidy on all headers and, as a source takes it some seconds, on six of the sources that the last commit
# or the work since has changed; with CALENDEM_HEAVY=1 on all that CMake builds: some ten minutes on two idle cores. The
# adapters, which are built in the host's tree, keep the host's manner: NULL, no override.
tidy() { # BUILD: where compile_commands.json is
  command -v clang-tidy >/dev/null || skip "no clang-tidy; tools/install-dependencies --test brings it"
  clang-tidy --version | grep -q 'version 14' || skip "clang-tidy is not version 14; others find other things"
  local run=(clang-tidy --quiet --config-file=.clang-tidy) each=(xargs -r -n 1 -P "$(nproc)") headers=$1/all_headers.cpp
  local sources failed=0
  all_headers >"$headers"
  write_commands_of_sources "$1" "$1/tidy"
  "${run[@]}" "$headers" -- "${header_options[@]}" || { echo "FAILED: clang-tidy on the headers"; exit 1; }
  if [ "${CALENDEM_HEAVY:-0}" = 1 ]; then sources=$(cxx_files | matching '\.cpp$')
  else sources=$(git diff --name-only --diff-filter=d HEAD~1 -- '*.cpp' 2>/dev/null | head -n 6 || true); fi
  without '^src_plugin/liggghts/|^tests/reliability/fuzz/' <<<"$sources" | "${each[@]}" "${run[@]}" -p "$1/tidy" || failed=1
  sed -n "s|^src_plugin/liggghts/[a-z]*/|$1/host/src/|p" <<<"$sources" |
    "${each[@]}" "${run[@]}" -p "$1/tidy" '--checks=-modernize-*' || failed=1
  [ $failed -eq 0 ] || { echo "FAILED: the files named above; see .clang-tidy"; exit 1; }
}
shell_is_clean() {
  command -v shellcheck >/dev/null || skip "no shellcheck; tools/install-dependencies --test brings it"
  local files
  mapfile -t files < <(grep -lE -r --exclude-dir=build '^#!.*(bash|/sh)' .ci tools patches src_plugin tests input_scripts)
  shellcheck "${files[@]}"
}
# A fault that its sed does not put in, because the line has changed, would be caught by nothing.
mutants_change_something() {
  while IFS='|' read -r name file expression _; do
    name=${name// /} file=${file// /}
    case $name in "" | "#"*) continue ;; esac
    case $file in tools/* | tests/*) ;; *) file=src_plugin/$file ;; esac
    expression=$(sed 's/^ *//; s/ *$//' <<<"$expression")
    if [ ! -f "$file" ]; then
      echo "$name: no $file"
    elif ! sed "$expression" "$file" >/dev/null 2>&1; then
      echo "$name: no sed expression: $expression"
    elif sed "$expression" "$file" | cmp -s - "$file"; then
      echo "$name"
    fi
  done <tests/reliability/mutants/mutants.txt | report "mutants.txt: changes nothing"
}
case ${1:-} in
  "" | *[!a-z_]*) echo "usage: cases.sh CASE BUILD" >&2; exit 1 ;;
  *) "$@" ;;
esac
