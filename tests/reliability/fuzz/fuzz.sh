#!/usr/bin/env bash
# fuzz.sh TARGET WORK [SECONDS]: libFuzzer with address and undefined-behaviour sanitizers on one reader
# (recipe, case_, experiment, csv), from the corpus kept here; what it finds is left in WORK. Runs with CALENDEM_HEAVY=1.
set -euo pipefail
target=$1 work=$2 seconds=${3:-60}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
core=$here/../../../tools/calendem
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: fuzz.$target runs with tools/test --all"; exit 77; }
command -v clang++ >/dev/null || { echo "skipped: no clang++ (Debian: clang, libclang-rt-14-dev)"; exit 77; }
# -fno-sanitize=unreachable: toml++ states what it assumes with __builtin_unreachable, which UBSan takes for a fault.
mkdir -p "$work/corpus"
cp "$here/corpus/${target%_}"/* "$work/corpus/"
clang++ -std=c++17 -g -O1 -DNDEBUG -fsanitize=fuzzer,address,undefined -fno-sanitize=unreachable \
  -fno-sanitize-recover=undefined -DFUZZ_TARGET="$target" \
  -DCALENDEM_VERSION='"fuzz"' -DCALENDEM_SOURCE_DIR='"."' -I "$core" -I "$core/../../src_plugin" \
  "$here/fuzz_target.cpp" "$core/report/csv_table.cpp" \
  "$core"/spec/{toml_file,toml_reader,key,recipe,case,experiment,messages,provenance}.cpp -lfmt -o "$work/$target"
cd "$work"
"./$target" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 corpus \
  >"$target.log" 2>&1 ||
  { tail -n 40 "$target.log"; echo "FAILED: the input that did it is in $work" >&2; exit 1; }
grep -E 'number_of_executed_units|new_units_added' "$target.log"
