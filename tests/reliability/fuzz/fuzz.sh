#!/usr/bin/env bash
# fuzz.sh TARGET WORK [SECONDS]: libFuzzer with address and undefined-behaviour sanitizers on one reader (see
# CMakeLists.txt), from the corpus kept here; what it finds is left in WORK/TARGET. fuzz.sh build WORK comes first: it
# makes WORK/readers, which has all readers but that of label images. That one goes on into VTK, whose own code is not
# instrumented: only what ends the process shows. Runs with CALENDEM_HEAVY=1.
set -euo pipefail
target=$1 seconds=${3:-60}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
core=$(cd "$here/../../../tools/calendem" && pwd)
[ "${CALENDEM_HEAVY:-0}" = 1 ] || { echo "skipped: fuzz.$target runs with tools/test --all"; exit 77; }
command -v clang++ >/dev/null || { echo "skipped: no clang++ (Debian: clang, libclang-rt-14-dev)"; exit 77; }
mkdir -p "$2"
work=$(cd "$2" && pwd)
# -fno-sanitize=unreachable: toml++ states what it assumes with __builtin_unreachable, which UBSan takes for a fault.
options=(-std=c++17 -g -O1 -DNDEBUG "-fsanitize=fuzzer,address,undefined" -fno-sanitize=unreachable
  -fno-sanitize-recover=undefined -DCALENDEM_VERSION='"fuzz"'
  -I "$core" -I "$core/../../src_plugin" -I /usr/include/eigen3)

build_readers() {
  local sources source objects=()
  cd "$core"
  sources=(base/*.cpp electrode/structure/{data_rows,existing_structure,particle_data}.cpp
    electrode/{pack/placement,slurry/film_recipe,tomogram_spec}.cpp simulate/study_file.cpp
    diagnose/bank/{bank_design,bank_spec,bank_table}.cpp diagnose/compare/simulated_run.cpp
    diagnose/inference/{bank,numerics,observable,prior}.cpp withheld/round_file.cpp "$here/fuzz_target.cpp")
  rm -rf "$work/objects"
  mkdir -p "$work/objects"
  for source in "${sources[@]}"; do
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n; done
    objects+=("$work/objects/${source//\//_}.o")
    clang++ "${options[@]}" -c "$source" -o "${objects[-1]}" &
  done
  wait
  clang++ "${options[@]}" "${objects[@]}" -lfmt -lcrypto -lnlopt -o "$work/readers"
}
build_label_image() {
  local vtk suffix
  vtk=$(find /usr/include -maxdepth 1 -name 'vtk-9*' | head -n 1) # the Debian package; its suffix is that of the libraries
  [ -n "$vtk" ] || { echo "skipped: no headers of VTK in /usr/include"; exit 77; }
  suffix=${vtk##*/vtk}
  clang++ "${options[@]}" -isystem "$vtk" "$here/fuzz_image.cpp" \
    "$core"/electrode/structure/{data_rows,image_header,label_image,tiff_image,vti_header}.cpp \
    "$core"/base/{messages,provenance}.cpp -lfmt -lz -ltiff \
    -lvtk{IOImage,IOXML,CommonExecutionModel,CommonDataModel,CommonCore,sys}"$suffix" -o "$work/label_image_reader"
}
program=$work/readers
case $target in
  build) build_readers; exit ;;
  label_image) build_label_image; program=$work/label_image_reader ;;
esac
mkdir -p "$work/$target/corpus"
cd "$work/$target"
cp "$here/corpus/${target%_}"/* corpus/
FUZZ_FOLDER=$(mktemp -d -p /dev/shm calendem_fuzz.XXXXXX)
export FUZZ_FOLDER FUZZ_TARGET=$target
trap 'rm -rf "$FUZZ_FOLDER"' EXIT
"$program" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 corpus \
  >"$target.log" 2>&1 ||
  { tail -n 40 "$target.log"; echo "FAILED: the input that did it is in $work/$target" >&2; exit 1; }
grep -E 'number_of_executed_units|new_units_added' "$target.log"
