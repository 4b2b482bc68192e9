#!/usr/bin/env bash
# fuzz.sh TARGET WORK [SECONDS]: libFuzzer with address and undefined-behaviour sanitizers on one reader (recipe,
# case_, experiment, csv, structure, label_image), from the corpus kept here; what it finds is left in WORK. Runs with
# CALENDEM_HEAVY=1. label_image goes on into VTK, whose own code is not instrumented: only what ends the process shows.
set -euo pipefail
target=$1 work=$2 seconds=${3:-60}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
core=$here/../../../tools/calendem
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: fuzz.$target runs with tools/test --all"; exit 77; }
command -v clang++ >/dev/null || { echo "skipped: no clang++ (Debian: clang, libclang-rt-14-dev)"; exit 77; }
# -fno-sanitize=unreachable: toml++ states what it assumes with __builtin_unreachable, which UBSan takes for a fault.
mkdir -p "$work/corpus"
cp "$here/corpus/${target%_}"/* "$work/corpus/"
options=(-std=c++17 -g -O1 -DNDEBUG "-fsanitize=fuzzer,address,undefined" -fno-sanitize=unreachable
  -fno-sanitize-recover=undefined -DFUZZ_TARGET="$target" -DCALENDEM_VERSION='"fuzz"' -DCALENDEM_SOURCE_DIR='"."'
  -I "$core" -I "$core/../../src_plugin" -I /usr/include/eigen3)
if [ "$target" = label_image ]; then
  vtk=$(find /usr/include -maxdepth 1 -name 'vtk-9*' | head -n 1) # the Debian package; its suffix is that of the libraries
  [ -n "$vtk" ] || { echo "skipped: no headers of VTK in /usr/include"; exit 77; }
  suffix=${vtk##*/vtk}
  clang++ "${options[@]}" -isystem "$vtk" "$here/fuzz_image.cpp" \
    "$core"/structure/{atom_rows,data_header,image_files,image_header,label_image,packed_data,raw_image_header}.cpp \
    "$core"/structure/{tiff_header,vti_header}.cpp "$core"/spec/{messages,provenance}.cpp -lfmt -lz \
    -lvtk{IOImage,IOXML,CommonExecutionModel,CommonDataModel,CommonCore,sys}"$suffix" -o "$work/$target"
else
  clang++ "${options[@]}" "$here/fuzz_target.cpp" \
    "$core"/structure/{atom_rows,data_header,data_plausible,given_structure,particle_data}.cpp \
    "$core"/spec/*.cpp -lfmt -o "$work/$target"
fi
cd "$work"
"./$target" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 corpus \
  >"$target.log" 2>&1 ||
  { tail -n 40 "$target.log"; echo "FAILED: the input that did it is in $work" >&2; exit 1; }
grep -E 'number_of_executed_units|new_units_added' "$target.log"
